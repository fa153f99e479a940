# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import mercurysim

if not isinstance(mercurysim.Recording, type):
    pytest.skip("this build reads no recordings", allow_module_level=True)


@pytest.fixture
def robots():
    return mercurysim.random_voxel(2, seed=1)


def test_a_recording_has_what_a_batch_goes_through(robots, recorded):
    recording = mercurysim.Recording(recorded)
    assert len(recording) == 5
    assert "2 robots, 5 frames" in repr(recording)
    assert recording.program.startswith("mercury ")
    assert recording.robots == robots
    batch = mercurysim.Batch(robots, device="cpu")
    assert np.array_equal(recording.offsets, batch.offsets)
    assert np.array_equal(recording.steps, [0, 50, 100, 150, 200])
    assert recording.times == pytest.approx(np.arange(5) * 0.05)
    for frame in range(5):
        assert np.array_equal(recording.positions(frame), np.asarray(batch.positions))
        assert np.array_equal(recording.velocities(frame), np.asarray(batch.velocities))
        batch.step(50)


def test_frames_count_from_the_end_too_and_stay(recorded):
    recording = mercurysim.Recording(str(recorded))
    last = recording.positions(-1)
    kept = last.copy()
    assert np.array_equal(last, recording.positions(np.int64(4)))
    recording.positions(0)
    assert np.array_equal(last, kept), "another frame is another array"
    for frame in (5, -6):
        with pytest.raises(IndexError, match=f"frame {frame} is out of range, the recording has 5"):
            recording.velocities(frame)
    with pytest.raises(TypeError):
        recording.positions("last")


def test_other_files_are_refused_in_one_line(tmp_path):
    (tmp_path / "text.h5").write_text("no recording")
    for name in ("text.h5", "missing.h5"):
        with pytest.raises(mercurysim.InputError) as refusal:
            mercurysim.Recording(tmp_path / name)
        assert str(refusal.value).startswith(str(tmp_path / name))
        assert "\n" not in str(refusal.value)
    with pytest.raises(TypeError):
        mercurysim.Recording(3)


def thinkers(targets):
    hunter = mercurysim.load("sample:hunter")
    batch = mercurysim.Batch([hunter, mercurysim.random_voxel(1, seed=1)[0], hunter], device="cpu")
    batch.brain.set_targets(targets)
    return batch


def test_recorded_senses_and_neurons_are_those_of_the_batch(tmp_path):
    targets = [[1, 2, 0], [0, 0, 0], [-1, 1, 0.5]]
    batch, again = thinkers(targets), thinkers(targets)
    with mercurysim.Recorder(batch, tmp_path / "a.h5", every=25, brains=True) as recorder:
        recorder.step(200)
    recording = mercurysim.Recording(tmp_path / "a.h5")
    assert recording.has_brains
    assert [recording.senses(1).shape, recording.neurons(1).shape] == [(9, 0), (9, 0)]
    for robot in (2, 0):
        layout = recording.robots[robot].brain_layout
        assert recording.senses(robot).shape == (9, len(layout["senses"]))
        assert recording.neurons(robot).shape == (9, len(layout["neurons"]))
        assert recording.senses(robot).dtype == recording.neurons(robot).dtype == np.float32
    for frame in range(9):
        for robot in (0, 2):
            senses, neurons = recording.senses(robot)[frame], recording.neurons(robot)[frame]
            assert np.array_equal(senses, again.brain.senses[robot, : len(senses)])
            assert np.array_equal(neurons, again.brain.neurons[robot, : len(neurons)])
        again.step(25)
    assert np.ptp(recording.senses(0), axis=0).max() > 0.01
    for robot in (3, -1):
        with pytest.raises(IndexError, match=f"robot {robot} is out of range, the recording has 3"):
            recording.senses(robot)


def test_senses_and_neurons_as_a_frame_of_pandas(tmp_path):
    pandas = pytest.importorskip("pandas")
    with mercurysim.Recorder(thinkers([[1, 2, 0]] * 3), tmp_path / "a.h5", fps=130, brains=True) as recorder:
        recorder.step(100)
    recording = mercurysim.Recording(tmp_path / "a.h5")
    frame = recording.brain_frame(2)
    assert isinstance(frame, pandas.DataFrame)
    assert np.array_equal(frame.index, recording.times)
    layout = recording.robots[2].brain_layout
    assert list(frame["senses"].columns) == layout["senses"]
    assert list(frame["neurons"].columns) == layout["neurons"]
    assert np.array_equal(frame["neurons"].to_numpy(), recording.neurons(2))
    assert np.array_equal(frame["senses"].to_numpy(), recording.senses(2))


def test_senses_and_neurons_are_recorded_on_request(recorded, tmp_path):
    recording = mercurysim.Recording(recorded)
    assert not recording.has_brains
    with pytest.raises(mercurysim.InputError, match="run.h5: has no senses and neurons; Recorder"):
        recording.neurons(0)
    batch = mercurysim.Batch(mercurysim.random_voxel(1, seed=1), device="cpu")
    with pytest.raises(mercurysim.InputError, match="brains: none of the robots has a brain"):
        mercurysim.Recorder(batch, tmp_path / "b.h5", every=1, brains=True)
