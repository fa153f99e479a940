# SPDX-License-Identifier: Apache-2.0
"""Pictures and films, without a display. They skip where there is no OpenGL or no encoder."""

import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import mercurysim
from mercurysim import _pictures

SMALL = (160, 90)


@pytest.fixture(autouse=True)
def opengl():
    try:
        mercurysim.picture(mercurysim.voxel(np.ones((1, 1, 1), np.uint8)), (16, 16))
    except mercurysim.DeviceError as error:
        pytest.skip(str(error))


@pytest.fixture
def encoder():
    try:
        return _pictures._ffmpeg()
    except mercurysim.DeviceError as error:
        pytest.skip(str(error))


@pytest.fixture
def robots():
    return mercurysim.random_voxel(2, seed=1)


@pytest.fixture
def batch(robots):
    return mercurysim.Batch(robots, device="cpu")


def frames_of(path, encoder):
    """Number of frames of a video, counted by decoding them."""
    decode = [encoder, "-v", "error", "-i", path, "-vf", "scale=16:16", "-pix_fmt", "gray", "-f", "rawvideo", "-"]
    return len(subprocess.run(decode, capture_output=True, check=True).stdout) // 256


def run(code, folder, **environment):
    """Runs Python code in a process of its own."""
    command = [sys.executable, "-c", "import mercurysim, os, sys\n" + code]
    return subprocess.run(
        command, cwd=folder, env=os.environ | environment, capture_output=True, text=True, timeout=120
    )


# Pictures


def test_pictures_have_the_size_asked_for(batch, robots):
    for what in (batch, robots, robots[0], tuple(robots)):
        image = mercurysim.picture(what, (161, 91))
        assert image.shape == (91, 161, 3)
        assert image.dtype == np.uint8
    assert mercurysim.picture(batch).shape == (720, 1280, 3)


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_a_robot_is_in_the_middle_of_its_picture(robots, theme):
    with_robot = mercurysim.picture(robots[0], (200, 200), theme=theme).astype(int)
    without = mercurysim.picture(robots[0], (200, 200), theme=theme, show="clock").astype(int)
    rows, columns = np.nonzero(np.abs(with_robot - without).max(axis=2) > 40)
    assert rows.size > 0.05 * 200 * 200
    assert abs(np.median(rows) - 100) < 30
    assert abs(np.median(columns) - 100) < 30


def test_the_same_state_gives_the_same_pixels(robots):
    first = mercurysim.picture(robots, SMALL)
    others = [None] * 3

    def draw(place):
        batch = mercurysim.Batch(robots, device="cpu")
        others[place] = mercurysim.picture(batch, SMALL)

    threads = [threading.Thread(target=draw, args=(place,)) for place in range(len(others))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for other in others:
        assert (other == first).all()


def test_a_batch_is_drawn_as_it_is_now(batch):
    before = mercurysim.picture(batch, SMALL)
    batch.step(500)
    after = mercurysim.picture(batch, SMALL)
    assert (before != after).any()
    assert batch.time == pytest.approx(0.5), "drawing does not step"


def test_words_change_the_picture(batch):
    batch.step(300)
    looks = [
        {},
        {"color": "strain"},
        {"color": "pressure"},
        {"color": "strain", "scale": (-0.01, 0.01)},
        {"show": "springs,masses"},
        {"show": ["skin", "labels", "scale"]},
        {"theme": "light"},
        {"caption": "two robots"},
        {"camera": "top"},
        {"azimuth": 40},
        {"elevation": 80.0},
        {"zoom": 2},
        {"layout": "race"},
        {"grid": (1, 2)},
        {"cut": "y:0"},
        {"faceted": True},
        {"plain": True},
        {"quality": "medium"},
    ]
    pictures = {mercurysim.picture(batch, SMALL, **look).tobytes() for look in looks}
    assert len(pictures) == len(looks)
    usual = mercurysim.picture(batch, SMALL, color=None, grid=None).tobytes()
    assert usual == mercurysim.picture(batch, SMALL).tobytes(), "None means the usual"
    assert usual == mercurysim.picture(batch, SMALL, smooth=True).tobytes(), "few robots are round anyway"


def test_robots_at_rest_are_shown_in_an_environment(robots):
    water, land = (mercurysim.picture(robots, SMALL, environment=e) for e in (None, mercurysim.Land()))
    assert (water != land).any()


def test_a_hero_is_shown_as_mercury_render_shows_it(tmp_path, mercury):
    """The same pixels as the command's, of a robot at rest with its copies."""
    image = pytest.importorskip("matplotlib.image")
    mercury("render", "sample:eel", "--style", "hero", "--still", 0, "--size", "160x90", "--quality", "low", "--show", "skin",
            "-o", tmp_path / "hero.png", "--quiet")  # fmt: skip
    eel = mercurysim.load("sample:eel")
    ours = mercurysim.picture(eel, SMALL, style="hero", quality="low", show="skin")
    assert (ours == np.round(255 * image.imread(tmp_path / "hero.png")[..., :3])).all()
    assert (ours != mercurysim.picture(eel, SMALL, aperture=0.3, quality="low", show="skin")).any()


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"color": "mood"}, 'color: "mood" is not accepted; give material, activation, '),
        ({"camera": "drone"}, 'camera: "drone" is not accepted; give group, follow, '),
        ({"camera": "follow:nobody"}, 'camera: no robot is named "nobody"; '),
        ({"show": "bones"}, 'show: "bones" is not accepted; give some of skin,springs,'),
        ({"theme": "pink"}, 'theme: "pink" is not accepted; give dark, light'),
        ({"quality": "best"}, 'quality: "best" is not accepted; give auto, low, medium, high'),
        ({"cut": "w"}, 'cut: "w" is not accepted; '),
        ({"style": "noir"}, 'style: "noir" is not accepted; give usual or hero'),
        ({"aperture": 2}, "aperture: give 0 to 1"),
        ({"zoom": 0}, "zoom: 0 is not accepted; give 0.001 to 1000"),
        ({"azimuth": float("nan")}, "azimuth: give a finite number of degrees"),
        ({"scale": (2, 1)}, 'scale: "2,1" is not accepted; give two finite numbers, the lower first'),
        ({"grid": (1, 1)}, "grid: 2 robots do not fit into 1x1; give more columns or rows"),
        ({"size": (0, 90)}, "size: 0 is not accepted; "),
        ({"size": (160, 20000)}, "size: 160x20000 is not accepted; give WIDTHxHEIGHT from 1x1 to 16384x16384"),
        ({"environment": "land", "color": "pressure"}, "color: pressure: land has no drag on faces; "),
    ],
)
def test_bad_input_is_refused_in_one_line(robots, arguments, message):
    with pytest.raises(mercurysim.InputError) as refusal:
        mercurysim.picture(robots, **arguments)
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)


def test_wrong_types_are_type_errors(batch, robots):
    for arguments in ({"color": 3}, {"size": 90}, {"size": "90x90"}, {"size": (90, 1.5)}, {"grid": 3}, {"smooth": "yes"}):
        with pytest.raises(TypeError):
            mercurysim.picture(robots, **arguments)
    for nothing in (3, None, [3], ["robot.json"]):
        with pytest.raises(TypeError):
            mercurysim.picture(nothing)
    with pytest.raises(TypeError, match='"colr" is not an option of pictures; did you mean color'):
        mercurysim.picture(batch, colr="strain")
    with pytest.raises(mercurysim.InputError, match="there is no robot to show"):
        mercurysim.picture([])
    with pytest.raises(mercurysim.InputError, match="environment: "):
        mercurysim.picture(batch, environment="land")


def test_notebooks_show_robots_and_batches(robots, batch, tmp_path):
    for what in (robots[0], batch):
        png = what._repr_png_()
        assert png[:8] == b"\x89PNG\r\n\x1a\n"
        width, height = (int.from_bytes(png[at : at + 4], "big") for at in (16, 20))
        assert 300 <= width <= 1000 and 200 <= height <= 600
    assert mercurysim.Batch([], device="cpu")._repr_png_() is None
    assert mercurysim.Batch(300 * [robots[0]], device="cpu")._repr_png_() is None, "drawing it would take long"


def test_without_opengl_notebooks_show_text_and_picture_says_why(tmp_path):
    code = """
robot = mercurysim.random_voxel(1, seed=1)[0]
try:
    mercurysim.picture(robot)
    print("draws")
except mercurysim.DeviceError as error:
    print(error)
print(robot._repr_png_())
"""
    nowhere = str(tmp_path / "none")
    # Neither of Mesa's ways to OpenGL, nor a GPU's.
    done = run(code, tmp_path, MESA_GL_VERSION_OVERRIDE="3.3", __EGL_VENDOR_LIBRARY_FILENAMES=nowhere)
    lines = done.stdout.splitlines()
    if lines[:1] == ["draws"]:
        pytest.skip("OpenGL works here in spite of it")
    assert done.returncode == 0, done.stderr
    assert len(lines) == 2
    assert lines[0].startswith("cannot draw: no OpenGL 4.5 without a display here (")
    assert lines[1] == "None"


# Videos


def test_a_film_has_a_frame_per_call(batch, tmp_path, encoder):
    with mercurysim.Film(tmp_path / "a.mp4", batch, fps=10, size=SMALL) as film:
        for _ in range(12):
            batch.step(20)
            film.frame()
        assert film.frames == 12
        assert "12 frames so far" in repr(film)
    assert frames_of(tmp_path / "a.mp4", encoder) == 12
    assert film.video.frames == 12
    assert film.close() is film.video, "closing again changes nothing"
    assert 'src="data:video/mp4;base64,' in film._repr_mimebundle_()["text/html"]
    with pytest.raises(mercurysim.InputError, match="the film has ended"):
        film.frame()
    assert os.listdir(tmp_path) == ["a.mp4"]


def test_a_film_that_steps_has_frames_at_exactly_its_rate(robots, tmp_path, encoder):
    batch = mercurysim.Batch(robots, device="cpu")
    with mercurysim.Film(tmp_path / "stepped", batch, fps=30, size=SMALL) as film:
        for n in (0, 7, 26, 1, 1, 65, 34, 33):
            film.step(n)
            assert film.frames == batch.steps * 30 // 1000 + 1
    assert batch.steps == 167 and film.frames == 6
    mercurysim.render(robots, tmp_path / "whole", 0.2, fps=30, size=SMALL, device="cpu")
    for frame in sorted(os.listdir(tmp_path / "whole")):
        assert (tmp_path / "stepped" / frame).read_bytes() == (tmp_path / "whole" / frame).read_bytes()
    coarse = mercurysim.Batch(robots, device="cpu", dt=0.01)
    with pytest.raises(mercurysim.InputError, match="fps: 200 is not accepted; give more than 0 and at most 100"):
        mercurysim.Film(tmp_path / "fast", coarse, fps=200, size=SMALL).step(1)


def test_steps_that_a_batch_makes_by_itself_are_not_filmed(batch, tmp_path):
    with mercurysim.Film(tmp_path / "frames", batch, fps=100, size=SMALL) as film:
        film.step(20)
        batch.step(1000)
        film.step(20)
        batch.add(mercurysim.random_voxel(1, seed=5))
        film.step(10)
        batch.reset()
        film.step(10)
    assert film.frames == 3 + 3 + 1 + 2


def test_an_exception_discards_the_film(batch, tmp_path, encoder):
    (tmp_path / "a.mp4").write_text("old")
    with pytest.raises(ZeroDivisionError):
        with mercurysim.Film(tmp_path / "a.mp4", batch, size=SMALL) as film:
            film.frame()
            1 / 0
    with pytest.raises(mercurysim.DeviceError, match="no frames"):
        with mercurysim.Film(tmp_path / "b.mp4", batch, size=SMALL):
            pass
    mercurysim.Film(tmp_path / "c.mp4", batch, size=SMALL).frame()
    assert os.listdir(tmp_path) == ["a.mp4"]
    assert (tmp_path / "a.mp4").read_text() == "old"


def test_a_film_follows_robots_that_come_and_go(batch, tmp_path):
    with mercurysim.Film(tmp_path / "frames", batch, size=SMALL) as film:
        film.frame()
        batch.add(mercurysim.random_voxel(3, seed=5))
        film.frame()
        batch.keep([4])
        film.frame()
    assert sorted(os.listdir(tmp_path / "frames")) == [f"frame-{i:05}.png" for i in range(3)]


def test_a_film_fills_only_a_new_or_empty_folder(batch, tmp_path):
    (tmp_path / "frame-00000.png").write_text("mine")
    with pytest.raises(mercurysim.InputError, match="is not empty; give a new or empty folder"):
        mercurysim.Film(tmp_path, batch, size=SMALL)
    assert os.listdir(tmp_path) == ["frame-00000.png"]
    assert (tmp_path / "frame-00000.png").read_text() == "mine"


def test_a_film_keeps_its_batch(robots, tmp_path):
    film = mercurysim.Film(tmp_path / "frames", mercurysim.Batch(robots, device="cpu"), size=SMALL)
    film.frame()
    film.frame()
    assert film.close().frames == 2


def test_a_batch_is_filmed_and_stepped_by_different_threads(batch, tmp_path):
    with mercurysim.Film(tmp_path / "frames", batch, size=SMALL) as film:
        stepping = threading.Thread(target=lambda: [batch.step(5) for _ in range(40)])
        drawing = threading.Thread(target=lambda: [mercurysim.picture(batch, (90, 90)) for _ in range(5)])
        stepping.start()
        drawing.start()
        for _ in range(10):
            film.frame()
        stepping.join()
        drawing.join()
    assert len(os.listdir(tmp_path / "frames")) == 10
    assert batch.steps == 200


@pytest.mark.parametrize("name, rate", [("a.mp4", 30), ("a.webm", 30), ("a.gif", 25)])
def test_render_simulates_robots(robots, tmp_path, encoder, name, rate):
    video = mercurysim.render(robots, tmp_path / name, 0.4, size=(161, 91), speed=2, device="cpu", color="strain")
    assert video.frames == round(0.2 * rate)
    assert frames_of(tmp_path / name, encoder) == video.frames
    assert video.size == ((161, 91) if name == "a.gif" else (162, 92))
    assert os.fspath(video) == str(tmp_path / name)
    html = video._repr_html_()
    assert html.startswith("<img " if name == "a.gif" else "<video ")
    assert repr(video) == video._repr_mimebundle_()["text/plain"]


def test_render_plays_a_recording(robots, tmp_path, encoder, mercury):
    for i, robot in enumerate(robots):
        robot.save(tmp_path / f"{i}.json")
    recording = tmp_path / "run.h5"
    where = ["--record", recording, "--every", 10, "--seconds", 0.5, "--device", "cpu"]
    mercury("run", tmp_path / "0.json", tmp_path / "1.json", *where)
    played = mercurysim.render(recording, tmp_path / "played", fps=10, size=SMALL)
    assert played.frames == 5
    mercurysim.render(robots, tmp_path / "simulated", 0.5, fps=10, size=SMALL, device="cpu")
    # The video's frames are among those of the recording.
    for frame in sorted(os.listdir(tmp_path / "played")):
        assert (tmp_path / "played" / frame).read_bytes() == (tmp_path / "simulated" / frame).read_bytes()
    for arguments in ({"what": tmp_path / "missing.h5"}, {"what": recording, "environment": "land"}):
        with pytest.raises(mercurysim.InputError):
            mercurysim.render(output=tmp_path / "a.mp4", **arguments)
    assert mercurysim.render(str(tmp_path / "0.json"), tmp_path / "file", 0.1, size=SMALL, device="cpu").frames == 3


def frames_in(folder):
    return [(folder / frame).read_bytes() for frame in sorted(os.listdir(folder))]


def test_results_are_filmed_as_they_were_tried(robots, tmp_path, encoder):
    settings = dict(solver="xpbd", dt=2e-3, device="cpu")
    results = list(mercurysim.evaluate(robots, 0.4, settle=0.1, states=True, **settings))
    film = mercurysim.render(results, tmp_path / "results", fps=10, size=SMALL)
    assert film.frames == 4, "0.4 s, settling included"
    mercurysim.render(robots, tmp_path / "robots", 0.4, fps=10, size=SMALL, **settings)
    assert frames_in(tmp_path / "results") == frames_in(tmp_path / "robots")
    # With jitter it is not the robot at rest that begins.
    (jittered,) = mercurysim.evaluate(robots[:1], 0.2, trials=2, jitter=0.3, device="cpu")
    mercurysim.render(jittered, tmp_path / "jittered", fps=10, size=SMALL)
    mercurysim.render(robots[0], tmp_path / "still", 0.2, fps=10, size=SMALL, device="cpu")
    assert frames_in(tmp_path / "jittered")[0] != frames_in(tmp_path / "still")[0]


def test_results_recordings_and_robots_stand_side_by_side(robots, tmp_path, encoder):
    batch = mercurysim.Batch(robots, device="cpu")
    with mercurysim.Recorder(batch, tmp_path / "a.h5", fps=30) as recorder:
        recorder.step(200)
    (result,) = mercurysim.evaluate(robots[:1], 0.3, device="cpu")
    recording = mercurysim.Recording(tmp_path / "a.h5")
    sides = {"recorded": recording, "tried": result, "robot": robots[1], "file": tmp_path / "a.h5"}
    film = mercurysim.render(sides, tmp_path / "a.mp4", size=(320, 90))
    assert film.frames == 9, "as long as the longest of recordings and results"
    assert frames_of(tmp_path / "a.mp4", encoder) == 9
    # Each column is what it is alone, without the words above it.
    twice = mercurysim.render({"a": result, "b": result}, tmp_path / "twice", size=(320, 90), fps=10, show="skin")
    assert twice.frames == 3
    png = tmp_path / "twice" / "frame-00002.png"
    decode = [encoder, "-v", "error", "-i", png, "-pix_fmt", "rgb24", "-f", "rawvideo", "-"]
    pixels = subprocess.run(decode, capture_output=True, check=True).stdout
    picture = np.frombuffer(pixels, np.uint8).reshape(90, 320, 3)
    assert (picture[40:, :160] == picture[40:, 160:]).all()
    for refused, message in [({}, "0 sides"), (dict.fromkeys("abcde", result), "5 sides")]:
        with pytest.raises(mercurysim.InputError, match=message):
            mercurysim.render(refused, tmp_path / "b.mp4")
    with pytest.raises(mercurysim.InputError, match="recordings and results have their own"):
        mercurysim.render({"a": result, "b": recording}, tmp_path / "b.mp4", environment="land")
    with pytest.raises(mercurysim.InputError, match="another call of evaluate"):
        (other,) = mercurysim.evaluate(robots[:1], 0.3, device="cpu")
        mercurysim.render([result, other], tmp_path / "b.mp4")
    with pytest.raises(TypeError):
        mercurysim.render({"a": 7}, tmp_path / "b.mp4")


def test_render_does_not_take_a_batch(batch, tmp_path):
    with pytest.raises(TypeError, match="a batch is filmed by Film"):
        mercurysim.render(batch, tmp_path / "a")


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"output": "a.avi"}, 'output: a.avi: ".avi" is not a format written here; '),
        ({"output": "a.png"}, "output: a.png is one picture; use picture(), "),
        ({"output": "a.mp4", "fps": 0}, "fps: 0 is not accepted; give a finite number > 0 frames/s"),
        ({"output": "a.gif", "fps": 60}, "fps: a GIF shows at most 50 frames/s; "),
        ({"output": "a.mp4", "seconds": -1}, "seconds: -1 is not accepted; give a finite number >= 0 s"),
        ({"output": "a.mp4", "speed": 0}, "speed: 0 is not accepted; give a finite number > 0"),
        ({"output": "a.mp4", "crf": 99}, "crf: 99 is not accepted; "),
        ({"output": "a.mp4", "solver": "euler"}, 'solver: "euler" is not a solver; '),
        ({"output": "a.mp4", "dt": -1}, "dt: -1 is not accepted; "),
        ({"output": "a.mp4", "color": "mood"}, 'color: "mood" is not accepted; '),
        ({"output": "a.mp4", "style": "hero"}, "style: hero is of picture()"),
        ({"output": "a.mp4", "aperture": 0.1}, "aperture: is of picture()"),
        ({"output": "a.mp4", "what": []}, "there is no robot to film"),
    ],
)
def test_render_refuses_bad_input_in_one_line(robots, tmp_path, monkeypatch, encoder, arguments, message):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(mercurysim.InputError) as refusal:
        mercurysim.render(**{"what": robots, "seconds": 1, "device": "cpu"} | arguments)
    assert str(refusal.value).startswith(message)
    assert "\n" not in str(refusal.value)
    assert os.listdir(tmp_path) == []


def test_ctrl_c_ends_a_video_and_keeps_nothing(robots, tmp_path, encoder):
    def interrupt():
        while not os.listdir(tmp_path):
            pass
        os.kill(os.getpid(), signal.SIGINT)

    interrupting = threading.Thread(target=interrupt)
    interrupting.start()
    with pytest.raises(KeyboardInterrupt):
        mercurysim.render(robots, tmp_path / "a.mp4", 1e5, size=SMALL, device="cpu")
    interrupting.join()
    assert os.listdir(tmp_path) == []
    assert mercurysim.render(robots, tmp_path / "a.mp4", 0.1, size=SMALL, device="cpu").frames == 3


def test_a_missing_encoder_is_reported(robots, tmp_path, monkeypatch):
    monkeypatch.delenv("MERCURY_FFMPEG", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(mercurysim.DeviceError, match="^ffmpeg was not found: install it .*$"):
        mercurysim.render(robots, tmp_path / "a.mp4", 1)
    monkeypatch.setenv("MERCURY_FFMPEG", str(tmp_path / "none"))
    with pytest.raises(mercurysim.InputError, match="^ffmpeg: .*none cannot be started: No such file or directory$"):
        mercurysim.render(robots, tmp_path / "a.mp4", 1)
    assert os.listdir(tmp_path) == []


def test_the_encoder_of_imageio_ffmpeg_is_found(robots, tmp_path, monkeypatch):
    package = pytest.importorskip("imageio_ffmpeg")
    monkeypatch.delenv("MERCURY_FFMPEG", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert _pictures._ffmpeg() == package.get_ffmpeg_exe()
    assert mercurysim.render(robots, tmp_path / "a.mp4", 0.1, size=SMALL, device="cpu").frames == 3


# Processes


def test_a_film_that_is_open_at_the_end_of_python_keeps_nothing(tmp_path, encoder):
    code = """
robots = mercurysim.random_voxel(2, seed=1)
batch = mercurysim.Batch(robots, device="cpu")
mercurysim.picture(batch, (90, 90))
film = mercurysim.Film("a.mp4", batch, size=(160, 90))
for _ in range(5):
    film.frame()
"""
    done = run(code, tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert os.listdir(tmp_path) == []


def test_a_forked_process_gets_an_error_and_ends_cleanly(tmp_path, encoder):
    code = """
import warnings
warnings.simplefilter("ignore", DeprecationWarning)  # Python 3.12 warns of fork() in programs with threads
robot = mercurysim.random_voxel(1, seed=1)[0]
batch = mercurysim.Batch([robot], device="cpu")
first = mercurysim.picture(robot, (90, 90))
film = mercurysim.Film("a.mp4", batch, size=(160, 90))
film.frame()
if os.fork() == 0:
    for draw in (lambda: mercurysim.picture(robot), film.frame):
        try:
            draw()
        except mercurysim.DeviceError as error:
            print(error, flush=True)
    print(robot._repr_png_(), flush=True)
    os._exit(3)  # as multiprocessing does: exit handlers of a GPU's driver in the child would stop the parent's drawing
print(os.waitstatus_to_exitcode(os.wait()[1]))
film.frame()
print(film.close().frames, (mercurysim.picture(robot, (90, 90)) == first).all())
"""
    done = run(code, tmp_path)
    assert done.stderr == ""
    lines = done.stdout.splitlines()
    assert lines[0].startswith("this process was forked from one that had drawn, ")
    assert lines[1:] == ["a film goes on only in the process that began it", "None", "3", "2 True"]
    assert frames_of(tmp_path / "a.mp4", encoder) == 2


def test_threads_that_draw_do_not_disturb_the_end_of_python(tmp_path, encoder):
    code = """
import threading
robots = mercurysim.random_voxel(1, seed=1)
batch = mercurysim.Batch(robots, device="cpu")
mercurysim.picture(batch, (90, 90))
started = threading.Barrier(4)

def draw():
    started.wait()
    while True:
        mercurysim.picture(batch, (90, 90))

def film():
    film = mercurysim.Film("film.mp4", batch, size=(160, 90))
    film.frame()
    started.wait()
    while True:
        film.frame()

def render():
    started.wait()
    mercurysim.render(robots, "render.mp4", 1e5, size=(160, 90), device="cpu")

for work in (draw, film, render):
    threading.Thread(target=work, daemon=True).start()
started.wait()
while not any(name.startswith("render") for name in os.listdir()):
    pass
"""
    done = run(code, tmp_path)
    assert done.returncode == 0, done.stderr
    assert os.listdir(tmp_path) == []
