# SPDX-License-Identifier: Apache-2.0
import json
import re
import struct

import numpy as np
import pytest

import mercurysim

if not isinstance(mercurysim.Recording, type):
    pytest.skip("this build exports nothing", allow_module_level=True)


@pytest.fixture
def robots():
    return mercurysim.random_voxel(2, seed=1)


@pytest.fixture
def recording(recorded):
    return mercurysim.Recording(recorded)


def test_a_robot_is_exported_at_rest(robots, tmp_path):
    mercurysim.export(robots[0], tmp_path / "new/robot.stl")
    content = (tmp_path / "new/robot.stl").read_bytes()
    assert struct.unpack_from("<I", content, 80)[0] == len(robots[0].faces)
    triangle = np.frombuffer(content, "<f4", 9, 84 + 12).reshape(3, 3)
    assert np.array_equal(triangle, robots[0].masses[robots[0].faces[0]])


def test_a_motion_has_the_frames_that_are_asked_for(recording, robots, tmp_path):
    mercurysim.export(recording, tmp_path / "a.pc2", robot=1, start=0.05, every=2)
    content = (tmp_path / "a.pc2").read_bytes()
    points, _, _, samples = struct.unpack_from("<iffi", content, 16)
    skin = np.unique(robots[1].faces)
    assert (points, samples) == (len(skin), 2)
    frames = np.frombuffer(content, "<f4", offset=32).reshape(2, -1, 3)
    for frame, recorded in zip(frames, (1, 3)):
        positions = recording.positions(recorded)[recording.offsets[1]:]
        assert np.array_equal(frame, positions[skin])


def test_files_are_replaced_and_folders_must_be_empty(recording, tmp_path):
    for _ in range(2):
        mercurysim.export(recording, tmp_path / "a.usda", robot=recording.robots[0].name)
    mercurysim.export(recording, tmp_path / "a.pvd", robot=0)
    with pytest.raises(mercurysim.InputError, match="path: .*a-frames is not empty"):
        mercurysim.export(recording, tmp_path / "a.pvd", robot=0)


def test_what_cannot_be_used_is_one_line(recording, robots, tmp_path):
    def refused(message, *arguments, **options):
        with pytest.raises(mercurysim.InputError, match=message):
            mercurysim.export(*arguments, **options)

    refused('format: "gif" is not accepted; give obj, ', robots[0], tmp_path / "a", "gif")
    refused("format: .* does not say it; give obj, ", robots[0], tmp_path / "a.xyz")
    refused("path: .* is a name of obj files", robots[0], tmp_path / "a.obj", "stl")
    refused("format: xdmf holds a motion", robots[0], tmp_path / "a.xdmf")
    refused("seconds: give a number of seconds above 0", robots[0], tmp_path / "a.pc2", seconds=0)
    refused("what: has 2 robots, and a pc2 file holds one", robots, tmp_path / "a.pc2")
    refused("what: one Robot is expected for a pose", robots, tmp_path / "a.stl")
    refused("seconds: a Recording has its own length", recording, tmp_path / "a.html", seconds=1)
    refused("springs: a .stl file holds no springs", robots[0], tmp_path / "a.stl", springs=True)
    refused("choose from a Recording", robots[0], tmp_path / "a.stl", still=0)
    refused("robot: the recording has 2; give a name or an index", recording, tmp_path / "a.pc2")
    refused("robot: no robot is named \"7\"", recording, tmp_path / "a.glb", robot=7)
    refused("start: 3 is not accepted; the recording has 0 to 0.2 s", recording, tmp_path / "a.glb", robot=0, start=3)
    refused("format: stl holds one pose", recording, tmp_path / "a.stl", robot=0)
    with pytest.raises(TypeError, match="what: must be a Robot, a Batch, a Recording, a Result of evaluate\\(\\), or a sequence .*, not int"):
        mercurysim.export(7, tmp_path / "a.stl")
    assert [path.name for path in tmp_path.iterdir() if path.suffix not in (".h5", ".json")] == []


def page_of(text):
    return json.loads(re.search('<script type="application/json" id="page">(.*?)</script>', text, re.DOTALL).group(1))


def test_robots_are_simulated_for_a_motion(robots, recording, tmp_path):
    mercurysim.export(robots[1], tmp_path / "a.pc2", seconds=0.2, environment="ocean")
    points, _, _, samples = struct.unpack_from("<iffi", (tmp_path / "a.pc2").read_bytes(), 16)
    assert (points, samples) == (len(np.unique(robots[1].faces)), 1 + 0.2 * 30)


def test_show_is_a_page_of_all_robots_and_leaves_a_batch_alone(robots, recording, tmp_path):
    batch = mercurysim.Batch(robots, device="cpu")
    batch.step(10)
    before = [batch.hash(i) for i in range(2)]
    page = mercurysim.show(batch, seconds=0.1)
    assert [robot["name"] for robot in page_of(page.text)["robots"]] == [robot.name for robot in robots]
    assert page_of(page.text)["robots"][0]["start"] == pytest.approx(0.01)
    assert [batch.hash(i) for i in range(2)] == before and batch.time == pytest.approx(0.01)
    page.save(tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == page.text
    assert "srcdoc=" in page._repr_html_() and "<script" not in page._repr_html_()
    for shown in (robots[0], recording):
        assert "srcdoc=" in shown._repr_html_()
    assert len(page_of(mercurysim.show(recording).text)["robots"]) == 2


@pytest.mark.parametrize("trials", (1, 2))
def test_results_are_tried_again_as_they_were(robots, tmp_path, trials):
    options = dict(seconds=0.099, dt=1e-3, environment="land", settle=0.03, trials=trials, hashes=True, device="cpu")
    results = list(mercurysim.evaluate(robots, **options))
    page = page_of(mercurysim.show(results).text)
    for result, robot in zip(results, page["robots"]):
        facts = dict(robot["facts"])
        assert facts["final state"] == f"{result.hash:016x} at 0.099 s"  # to the bit, the jitter of a trial included
    assert "srcdoc=" in results[0]._repr_html_()
    last = results[0].trials[-1]
    assert dict(page_of(mercurysim.show(last).text)["robots"][0]["facts"])["final state"].startswith(f"{last.hash:016x}")
    with pytest.raises(mercurysim.InputError, match="seconds: a Result has its own"):
        mercurysim.show(results, seconds=1)
    other = next(mercurysim.evaluate(robots, seconds=0.1, device="cpu"))
    with pytest.raises(mercurysim.InputError, match="result 0: it is of another call of evaluate"):
        mercurysim.export([results[0], other], tmp_path / "a.html")


def test_a_batch_is_recorded_at_exact_frames_per_second(robots, tmp_path):
    batch = mercurysim.Batch(robots, device="cpu", dt=0.004)
    with mercurysim.Recorder(batch, tmp_path / "a.h5", fps=30) as recorder:
        for _ in range(5):
            recorder.step(20)
        with pytest.raises(mercurysim.InputError, match="step the batch by step"):
            recorder.frame()
        batch.step(30)
        with pytest.raises(mercurysim.InputError, match="a frame was due 22 steps ago"):
            recorder.step(1)
    recording = mercurysim.Recording(tmp_path / "a.h5")
    assert np.allclose(recording.times, np.arange(13) / 30, rtol=0, atol=1e-12)
    again = mercurysim.Batch(robots, device="cpu", dt=0.004)
    again.step(8)
    before = np.array(again.positions)
    again.step(1)
    between = before + (1 / 30 / 0.004 - 8) * (np.array(again.positions) - before)
    assert np.allclose(recording.positions(1), between, rtol=0, atol=1e-6)
    for arguments in {}, {"every": 2, "fps": 30}:
        with pytest.raises(mercurysim.InputError, match="every, fps"):
            mercurysim.Recorder(batch, tmp_path / "b.h5", **arguments)


def test_a_batch_is_recorded_while_a_program_drives_it(robots, tmp_path):
    batch = mercurysim.Batch(robots, device="cpu")
    drive = np.asarray(batch.actuation.drive)
    with mercurysim.Recorder(batch, tmp_path / "new/driven.h5", every=20) as recorder:
        for step in range(5):
            drive[:] = np.sin(step)
            batch.step(20)
            recorder.frame()
        assert recorder.frames == 6
        batch.step(7)
        with pytest.raises(mercurysim.InputError, match="a frame is due at step 120 and the batch is at step 107"):
            recorder.frame()
    recording = mercurysim.Recording(tmp_path / "new/driven.h5")
    assert np.array_equal(recording.steps, 20 * np.arange(6))
    assert len(page_of(mercurysim.show(recording).text)["robots"]) == 2
    with pytest.raises(mercurysim.InputError, match="the recording is closed"):
        recorder.frame()
