# SPDX-License-Identifier: Apache-2.0
"""The interactive window, started for real and driven with mouse and keys: window_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import csv
import importlib.util
import json
import os
import random
import shlex
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

SKIPPED = 77  # what ctest takes for "was not run"
NEEDED = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
NEEDED += [f"python3-{name}" for name in ("numpy", "matplotlib") if importlib.util.find_spec(name) is None]
if NEEDED:
    print("skipped: this machine has no", ", ".join(NEEDED))
    sys.exit(SKIPPED)

import numpy  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))
from window_driver import Display, Fingers, Window, scratch  # noqa: E402

PROGRAM, SAMPLES = sys.argv[1], Path(sys.argv[2])
LEFT = ["Robots", "Browser", "Ranking"]
SEEDS = [int(seed) for seed in os.environ.get("MERCURY_WINDOW_SEEDS", "4").split(",")]
PRESSES = int(os.environ.get("MERCURY_WINDOW_PRESSES", "10000"))
RIGHT = ["View", "Tune", "Measure", "Video", "Stats"]


def robot_that_explodes(name):
    """A row of masses; the spring in its middle, number 3, is far too stiff for the time step."""
    masses = [[0.1 * i, 0, 0] for i in range(8)]
    springs = [[i, i + 1, 2 if i == 3 else 1, 0.098] for i in range(7)]
    materials = [{"stiffness": stiffness} for stiffness in (0, 50, 2.3e6)]
    return {"format": "mercury-robot", "version": 1, "name": name, "materials": materials, "masses": masses,
            "springs": springs, "faces": []}


class WindowTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display()

    @classmethod
    def tearDownClass(cls):
        cls.display.close()

    def open(self, *arguments):
        self.folder = scratch()
        return self.window_in(self.folder, *arguments)

    def window_in(self, folder, *arguments):
        window = Window(PROGRAM, self.display, folder, *arguments)
        self.addCleanup(window.close)
        return window

    def finish(self, window):
        status = window.close()
        self.assertEqual(status, 0, window.said())
        self.assertEqual(window.complaints(), [])

    def small(self, *arguments):
        """A window with two small robots, so that little is waited for."""
        return self.open(str(SAMPLES / "eel.json"), str(SAMPLES / "fish.json"), *arguments)

    def test_opens_on_the_sample_robots_and_plays(self):
        window = self.open()
        robots = window.wait("robots")
        self.assertIn("eel", robots["names"])
        self.assertGreaterEqual(robots["count"], 5)
        self.assertTrue(window.frame()["playing"])
        window.frame(lambda frame: frame["time"] > 0.05)
        window.key("space")
        steps = window.frame(lambda frame: not frame["playing"])["steps"]
        steps = window.frame()["steps"]  # one that was under way may have ended
        window.key("period")
        window.frame(lambda frame: frame["steps"] == steps + 1)
        window.key("Right")
        window.frame(lambda frame: frame["steps"] == steps + 2)
        window.key("r")
        window.frame(lambda frame: frame["steps"] == 0)
        self.finish(window)

    def test_slow_motion_glides_between_steps(self):
        window = self.small()
        window.frame(lambda frame: frame["time"] > 0.02)
        window.key(*["minus"] * 9)  # to 1/1000: a step a second
        first = window.frame(lambda frame: frame["shown"] < frame["time"])
        second = window.frame(lambda frame: frame["steps"] > first["steps"] + 1)
        since, between = window.mark(), set()
        window.frame(lambda frame: frame["steps"] > second["steps"] + 2, since)
        for frame in window.events[since:]:
            if frame["event"] == "frame":
                self.assertLessEqual(frame["shown"], frame["time"])
                self.assertGreater(frame["shown"], frame["time"] - 0.0021)
                between.add(frame["shown"])
        self.assertGreater(len(between), 6)  # several a step
        shown = [event["shown"] for event in window.events[since:] if event["event"] == "frame"]
        self.assertEqual(shown, sorted(shown))
        self.finish(window)

    def test_camera_turns_and_comes_closer(self):
        window = self.small("--paused")
        before = window.frame()
        x, y = window.place("picture")
        window.script([f"mousemove {x} {y + 150}", "sleep 0.2", "mousedown 1", "sleep 0.1",
                       *(f"mousemove {x + 8 * i} {y + 150}\nsleep 0.03" for i in range(12)), "mouseup 1"])
        turned = window.frame(lambda frame: abs(frame["azimuth"] - before["azimuth"]) > 0.1)
        window.do("click", 4)
        window.frame(lambda frame: frame["distance"] < 0.95 * turned["distance"])
        self.finish(window)

    def test_every_panel_opens(self):
        window = self.small()
        for panel in LEFT[1:] + RIGHT[1:] + [LEFT[0], RIGHT[0]]:
            since = window.mark()
            window.click(f"tab.{panel}")
            window.wait("panel", since, lambda event: event["name"] == panel)
            window.place(f"panel.{panel}")
        window.key("F1")
        window.place("panel.Help")
        window.key("Escape")
        window.until("help closed", lambda: "panel.Help" not in window.items)
        window.key("h")
        window.frame(lambda frame: not frame["panels"])
        window.key("h")
        window.frame(lambda frame: frame["panels"])
        self.finish(window)

    def test_a_generated_robot_is_saved_and_loaded_again(self):
        window = self.small("--paused")
        since = window.mark()
        window.click("generate")
        robots = window.wait("robots", since, lambda event: all(name.startswith("voxel") for name in event["names"]))
        window.click("robot.1")
        window.frame(lambda frame: frame["selected"] == 1)
        for expected in ("saved", "asks"):  # the second time, the file is there already
            since = window.mark()
            window.key("ctrl+s")
            window.dialog(str(self.folder / "new.json"))
            window.wait(expected, since)
        window.click("dialog.cancel")
        window.place("files.place")  # where to, then?
        window.key("Escape")
        window.until("dialog closed", lambda: "files.place" not in window.items)
        self.finish(window)
        saved = json.loads((self.folder / "new.json").read_text())
        self.assertEqual(saved["name"], robots["names"][1])

        again = self.window_in(self.folder, "--fresh", "--paused")
        since = again.mark()
        again.key("ctrl+o")
        again.dialog(str(self.folder / "new.json"))
        again.wait("robots", since, lambda event: event["names"][-1:] == [saved["name"]])
        self.finish(again)

    def test_all_robots_are_saved_as_cbor(self):
        window = self.small("--paused")
        window.key("ctrl+s")
        window.click("files.format")
        window.choose_next("files.format")
        since = window.mark()
        window.click("dialog.text")
        window.dialog("both")
        saved = window.wait("saved", since)["files"]
        self.assertEqual([str(Path(file).relative_to(self.folder)) for file in saved], ["both/eel.cbor", "both/fish.cbor"])
        self.finish(window)
        info = subprocess.run([PROGRAM, "info", str(self.folder / "both")], capture_output=True, text=True)
        self.assertEqual(info.returncode, 0, info.stderr)
        self.assertIn("eel", info.stdout)

    def test_a_scene_copied_as_a_command_is_made_again_by_it(self):
        def copy(window):
            since = window.mark()
            window.click("tune.copy")
            return window.wait("copied", since)["text"]

        window = self.open(str(SAMPLES / "eel.json"), "--random", "voxel:2", "--seed", "3", "--paused")
        names = window.wait("robots", 0, lambda event: event["count"] == 3)["names"]
        window.key("3", "d", "b", "t")
        window.click("tab.Tune")
        window.click("tune.damping")
        window.click("tune.solver")
        window.choose_next("tune.solver")
        command = copy(window)
        words = shlex.split(command)
        self.assertEqual(words[:2], ["mercury", "view"])
        for word in ("--solver=xpbd", "--color=strain", "--theme=light", "--camera=turntable", "voxel:2:3"):
            self.assertTrue(any(given.startswith(word) for given in words), f"{word} in {command}")
        self.finish(window)
        again = self.window_in(self.folder, "--fresh", "--paused", *(word for word in words[2:] if not word.startswith("--device")))
        self.assertEqual(again.wait("robots", 0, lambda event: event["count"] == 3)["names"], names)
        again.click("tab.Tune")
        again.key("t")  # the turntable has gone on; all else is as it was
        again.frame(lambda frame: frame["camera"] == "still")

        def settings(command):
            return sorted(word for word in shlex.split(command) if not word.startswith(("--azimuth", "--elevation", "--camera")))

        self.assertEqual(settings(copy(again)), settings(command))
        self.finish(again)

    def test_ranking_sorts_and_measurements_are_exported(self):
        window = self.open(str(SAMPLES / "fish.json"), str(SAMPLES / "eel.json"), str(SAMPLES / "ray.json"))
        window.frame(lambda frame: frame["time"] > 1)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        window.click("tab.Ranking")
        for _ in range(2):
            since = window.mark()
            window.click("ranking.by.robot")
            told = window.wait("ranking", since)
            self.assertEqual(told["by"], "robot")
            self.assertEqual(told["names"], sorted(["fish", "eel", "ray"], reverse=not told["ascending"]))
        window.click("ranking.by.distance")
        window.click("tab.Measure")
        for button, file in (("measure.csv", "swim.csv"), ("ranking.csv", "rank.csv")):
            since = window.mark()
            window.click(button)
            window.dialog(str(self.folder / file))
            window.wait("saved", since)
        time = window.frame()["time"]
        self.finish(window)
        with open(self.folder / "swim.csv") as file:
            rows = list(csv.reader(file))
        self.assertEqual(rows[0][0], "time [s]")
        self.assertTrue(any("eel" in name and "distance" in name for name in rows[0]), rows[0])
        self.assertLessEqual(abs(float(rows[-1][0]) - time), 0.1)
        with open(self.folder / "rank.csv") as file:
            ranking = list(csv.DictReader(file))
        self.assertEqual(sorted(row["name"] for row in ranking), ["eel", "fish", "ray"])
        distances = [float(row[next(name for name in row if name.startswith("distance"))]) for row in ranking]
        self.assertEqual(distances, sorted(distances, reverse=True))

    def test_a_robot_that_cannot_be_loaded_is_told(self):
        window = self.small("--paused")
        bad = self.folder / "bad.json"
        bad.write_text('{"format": "mercury-robot", "version": 1, "masses": [[0, 0, 0]], "springs": [[0, 7, 1]], "faces": []}')
        since = window.mark()
        window.key("ctrl+o")
        window.dialog(str(bad))
        told = window.wait("message", since, lambda event: event["tone"] == "error")
        self.assertIn("/springs/0", told["text"])
        self.finish(window)

    def test_files_dropped_on_the_window_are_opened(self):
        window = self.small("--paused")
        inner = self.folder / "a folder, #1"
        inner.mkdir()
        for name in ("ray", "squid"):
            shutil.copy(SAMPLES / f"{name}.json", inner)
        odd = self.folder / "t\u00fcrtle 100%.json"
        shutil.copy(SAMPLES / "turtle.json", odd)
        (self.folder / "notes.txt").write_text("no robot")
        (self.folder / "broken.json").write_text("{")
        since = window.mark()
        window.drop(inner, self.folder / "notes.txt", odd, self.folder / "broken.json")
        self.assertEqual(window.wait("dropped", since)["files"], 4)
        robots = window.wait("robots", since, lambda event: event["count"] == 5)
        self.assertEqual(robots["names"], ["eel", "fish", "ray", "squid", "turtle"])
        for text in ("notes.txt", "broken.json"):
            window.wait("message", since, lambda event, text=text: event["tone"] == "error" and text in event["text"])
        window.key("ctrl+z")
        window.wait("robots", since, lambda event: event["names"] == ["eel", "fish"])
        self.finish(window)

    def test_drag_arrows_are_seen(self):
        window = self.small()
        window.frame(lambda frame: frame["time"] > 0.3)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        window.frame()
        without = window.screenshot()
        since = window.mark()
        window.key("d")
        window.wait("view", since, lambda event: event["drag"])
        area = window.items["picture"]
        left, right = int(area["x"] - area["width"] / 2) + 2, int(area["x"] + area["width"] / 2) - 2
        top, bottom = int(area["y"] - area["height"] / 2) + 120, int(area["y"] + area["height"] / 2) - 2

        def changed(a, b):
            return (numpy.abs(a - b).max(axis=2) > 0.15)[top:bottom, left:right]

        # Where the arrows are, near the robots, and nowhere else.
        deadline = 20
        while (share := changed(window.screenshot(), without).mean()) < 0.0005 and deadline:
            deadline -= 1
        self.assertGreater(share, 0.0005)
        self.assertLess(share, 0.3)
        self.finish(window)

    def test_the_first_bad_spring_is_shown(self):
        folder = scratch()
        for name in ("one", "two"):
            (folder / f"{name}.json").write_text(json.dumps(robot_that_explodes(name)))
        window = self.open(str(folder / "one.json"), str(folder / "two.json"), "--paused")
        window.frame(lambda frame: len(frame["where"]) == 2)
        yellow, magenta = numpy.array([255, 225, 74]) / 255, numpy.array([209, 0, 108]) / 255

        def marked(color, place, reach):
            """How many pixels of a colour are within reach of an item, or of the middle, when the camera rests."""
            while (before := window.frame())["where"] != window.frame()["where"]:
                self.assertGreater(before["distance"], 0)
            x, y = window.place(place) if place else (640, 360)
            near = window.screenshot()[max(0, y - reach):y + reach + 1, max(0, x - reach):x + reach + 1]
            return int((numpy.abs(near - color).max(axis=2) < 0.04).sum())

        self.assertEqual(marked(yellow, None, 400), 0)
        window.key("space")
        told = [window.wait("exploded", accept=lambda event, robot=robot: event["robot"] == robot) for robot in (1, 2)]
        self.assertEqual([event["spring"] for event in told], [3, 3])
        window.key("space")
        window.place("panel.Explosion")
        window.frame()  # where it stays
        area, ends = window.items["picture"], ("explosion.a", "explosion.b")
        for _ in range(2):  # each of them
            window.click("explosion.show")
            window.until("the spring in the picture", lambda: all(
                abs(window.items[end]["x"] - area["x"]) < area["width"] / 2 and
                abs(window.items[end]["y"] - area["y"]) < area["height"] / 2 for end in ends))
            for end in ends:
                self.assertGreater(marked(yellow, end, 10), 60)
            window.click("explosion.next")
        window.key("b")
        window.frame()
        self.assertGreater(marked(magenta, "explosion.a", 10), 60)
        window.click("explosion.reset")
        window.until("the card gone", lambda: "panel.Explosion" not in window.items and "explosion.a" not in window.items)
        self.finish(window)

    def test_a_dragged_mass_moves(self):
        window = self.small()
        window.frame(lambda frame: len(frame["where"]) == 2)
        window.key("minus", "minus", "minus")
        x, y = map(round, window.frame()["where"][0])
        window.script([f"mousemove {x} {y}", "sleep 0.3", "keydown ctrl", "sleep 0.1", "mousedown 1"])
        pulled = window.wait("pull")
        window.script([f"mousemove {x + 6 * i} {y - 6 * i}\nsleep 0.02" for i in range(1, 20)])
        time = window.frame()["time"]
        window.frame(lambda frame: frame["time"] > time + 0.15)
        window.script(["mouseup 1", "keyup ctrl"])
        released = window.wait("pulled")
        self.assertGreater(released["force"], 1)
        moved = numpy.linalg.norm(numpy.subtract(released["at"], pulled["at"]))
        self.assertGreater(moved, 0.02)
        self.finish(window)

    @unittest.skipUnless(shutil.which("ffmpeg") and shutil.which("ffprobe"), "this machine has no ffmpeg")
    def test_the_window_is_recorded(self):
        window = self.small()
        window.frame()
        since = window.mark()
        window.key("v")
        window.wait("recording", since)
        number = window.frame()["number"]
        window.frame(lambda frame: frame["number"] > number + 30)
        window.key("v")
        file = window.wait("recorded", since)["file"]
        probe = subprocess.run(["ffprobe", "-v", "error", "-count_frames", "-show_streams", "-of", "json", file],
                               capture_output=True, text=True, check=True)
        stream = json.loads(probe.stdout)["streams"][0]
        self.assertEqual((stream["width"], stream["height"]), (1280, 720))
        self.assertGreater(int(stream["nb_read_frames"]), 10)
        self.finish(window)

    def test_settings_are_remembered(self):
        window = self.small("--paused")
        window.click("tab.Tune")
        window.wait("panel", 0, lambda event: event["name"] == "Tune")
        x, y = window.place("picture")
        edge = int(x + window.items["picture"]["width"] / 2)
        window.script([f"mousemove {edge} {y}", "sleep 0.2", "mousedown 1", "sleep 0.2", f"mousemove {edge - 60} {y}", "sleep 0.2", "mouseup 1"])
        width = window.until("a wider column", lambda: window.items["panel.Tune"]["width"] if
                             abs(edge - 60 - window.items["picture"]["x"] - window.items["picture"]["width"] / 2) < 3 else 0)
        window.key("3", "b", "t")
        window.frame(lambda frame: (frame["color"], frame["theme"], frame["camera"]) == ("strain", "light", "turntable"))
        self.finish(window)
        again = self.window_in(self.folder, "--paused")
        again.place("panel.Tune")
        again.frame(lambda frame: (frame["color"], frame["theme"], frame["camera"]) == ("strain", "light", "turntable"))
        self.assertLess(abs(again.items["panel.Tune"]["width"] - width), 2)
        self.finish(again)

    def test_whatever_is_clicked_and_typed_the_window_lives(self):
        """Ten thousand presses of random buttons and keys; none is lost."""
        for seed in SEEDS:
            with self.subTest(seed=seed):
                RandomHands(self, seed).play(PRESSES)


class RandomHands:
    """Clicks, drags and types whatever comes into a small window; tells the seed and what was done last if it fails."""

    KEYS = ["space", "period", "Right", "plus", "minus", "asterisk", "0", "f", "r", "n", "d", "h", "s", "l", "k", "b", "t", "z",
            "g", "m", "p", "v", "1", "2", "3", "4", "5", "6", "7", "8", "9", "F1", "question", "Escape", "Escape", "Delete",
            "BackSpace", "ctrl+z", "ctrl+y", "ctrl+a", "ctrl+o", "ctrl+s", "Tab", "Return", "Up", "Down", "Left", "Home",
            "Next", "e", "l"]  # no slash: it would lead out of the scratch folder
    SIZE = (640, 400)
    AHEAD = 100  # presses that may wait in the window

    def __init__(self, test, seed):
        self.test, self.seed, self.chance, self.last = test, seed, random.Random(seed), []
        self.display = Display(*self.SIZE)
        test.addCleanup(self.display.close)
        self.fingers = Fingers(self.display)

    def open(self):
        # Far down: however often "Up" is pressed, what is saved at random stays in the scratch folder.
        self.top = scratch()
        folder = self.top.joinpath(*["down"] * 400)
        folder.mkdir(parents=True)
        robots = [str(shutil.copy(SAMPLES / name, folder)) for name in ("eel.json", "fish.json")]  # they may be replaced
        window = Window(PROGRAM, self.display, folder, *robots, "--fresh", size="x".join(map(str, self.SIZE)))
        self.test.addCleanup(window.kill)
        return window

    def play(self, presses):
        handled, window = 0, self.open()
        try:
            while handled + self.fingers.pressed < presses:
                for _ in range(20):
                    self.act()
                self.fingers.flush()
                self.wait(window, self.AHEAD)
                if window.process.poll() == 0:  # asked to quit by a click on the menu
                    handled += self.fingers.pressed
                    self.fingers.pressed = 0
                    self.test.assertEqual(window.complaints(), [])
                    window = self.open()
                self.test.assertIsNone(window.process.poll())
            self.wait(window, 0)
            self.test.assertEqual(window.pressed(), self.fingers.pressed)
            self.test.assertEqual(window.complaints(), [])
            for depth in range(100):
                self.test.assertEqual(os.listdir(self.top.joinpath(*["down"] * depth)), ["down"], "saved too near the root")
        except AssertionError as failure:
            raise AssertionError(f"seed {self.seed}, last done: {self.last[-60:]}\n{window.said()}") from failure
        finally:
            window.kill()

    def wait(self, window, ahead):
        """Until all but so many presses are handled, or it quits."""
        window.until("presses handled", lambda: window.process.poll() is not None or window.pressed() >= self.fingers.pressed - ahead,
                     may_end=True)

    def act(self):
        chance, fingers = self.chance, self.fingers
        kind = chance.random()
        if kind < 0.45:
            self.note("click", *self.go(), button := chance.choice([1, 1, 1, 1, 1, 3, 4, 5]))
            fingers.click(button)
        elif kind < 0.5:
            self.note("double click", *self.go())
            fingers.click(1)
            fingers.click(1)
        elif kind < 0.65:
            self.note("drag from", *self.go())
            fingers.button(button := chance.choice([1, 1, 1, 3]), True)
            self.note("to", *self.go())
            fingers.button(button, False)
        elif kind < 0.7:
            fingers.hold(held := chance.choice(["Control_L", "Shift_L"]), True)
            self.note(held, "drag from", *self.go())
            fingers.button(1, True)
            self.note("to", *self.go())
            fingers.button(1, False)
            fingers.hold(held, False)
        else:
            self.note("key", key := chance.choice(self.KEYS))
            fingers.key(key)

    def go(self):
        x, y = self.chance.randrange(self.SIZE[0]), self.chance.randrange(self.SIZE[1])
        self.fingers.move(x, y)
        return x, y

    def note(self, *what):
        self.last.append(" ".join(map(str, what)))


if __name__ == "__main__":
    result = unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2, exit=False).result
    skipped = result.skipped and len(result.skipped) == result.testsRun
    sys.exit(not result.wasSuccessful() or SKIPPED * bool(skipped))
