# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import mercurysim

if not isinstance(mercurysim.Recording, type):
    pytest.skip("this build reads no recordings", allow_module_level=True)


@pytest.fixture
def robots():
    return mercurysim.random_voxel(2, seed=1)


@pytest.fixture
def path(robots, tmp_path, mercury):
    for i, robot in enumerate(robots):
        robot.save(tmp_path / f"{i}.json")
    path = tmp_path / "run.h5"
    where = ["--record", path, "--every", 50, "--seconds", 0.2, "--device", "cpu"]
    mercury("run", tmp_path / "0.json", tmp_path / "1.json", *where)
    return path


def test_a_recording_has_what_a_batch_goes_through(robots, path):
    recording = mercurysim.Recording(path)
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


def test_frames_count_from_the_end_too_and_stay(path):
    recording = mercurysim.Recording(str(path))
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
