# SPDX-License-Identifier: Apache-2.0
"""Panels, keys and settings of the real window: window_panels_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import csv
import json
import shlex
import shutil
import subprocess
import unittest

from window_case import SAMPLES, WindowCase, main, numpy
from window_driver import SIZE, scratch


def near(place, item):
    return (place[0] - item["x"]) ** 2 + (place[1] - item["y"]) ** 2 < 50 ** 2


LEFT = ["Robots", "Browser", "Ranking", "Evolution", "Compare"]
RIGHT = ["View", "Tune", "Measure", "Brain", "Video", "Messages", "Stats"]


class PanelsTest(WindowCase):
    def test_every_panel_opens(self):
        window = self.small("--paused")
        for panel in LEFT[1:] + RIGHT[1:] + [LEFT[0], RIGHT[0]]:
            since = window.mark()
            window.open(panel)
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

    def test_keys_show_contact_and_net_forces(self):
        window = self.small("--paused", "--environment", "land")
        for key, kind in (("q", "contact"), ("ctrl+f", "force")):
            for shown in (True, False):
                since = window.mark()
                window.key(key)
                self.assertEqual(window.wait("view", since)[kind], shown)
        self.finish(window)

    def test_drag_arrows_are_drawn(self):
        window = self.small()
        window.frame(lambda frame: frame["time"] > 0.3)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        window.frame()
        without = window.screenshot()
        since = window.mark()
        window.key("d")
        window.wait("view", since, lambda event: event["drag"])
        area = window.items["view"]
        left, right = int(area["x"] - area["width"] / 2) + 2, int(area["x"] + area["width"] / 2) - 2
        top, bottom = int(area["y"] - area["height"] / 2) + 120, int(area["y"] + area["height"] / 2) - 2

        def changed(a, b):
            return (numpy.abs(a - b).max(axis=2) > 0.15)[top:bottom, left:right]

        # The arrows change a small part of the picture.
        deadline = 20
        while (share := changed(window.screenshot(), without).mean()) < 0.0005 and deadline:
            deadline -= 1
        self.assertGreater(share, 0.0005)
        self.assertLess(share, 0.3)
        self.finish(window)

    def test_fixing_a_color_scale_keeps_its_range(self):
        window = self.small()
        window.open("View")
        since = window.mark()
        window.click("color.strain")
        window.frame(lambda frame: frame["color"] == "strain" and frame["time"] > 0.5, since)
        since = window.mark()
        window.key("space")
        still = window.frame(lambda frame: not frame["playing"], since)["scale"]
        self.assertGreater(still[1], 1, "muscles strain by several per cent")
        window.click("color.fixed")
        self.assertEqual(window.frame()["scale"], still)
        self.finish(window)

    def test_the_ends_of_a_legend_are_dragged(self):
        window = self.small()
        window.open("View")
        since = window.mark()
        window.click("color.strain")
        window.frame(lambda frame: frame["color"] == "strain" and frame["time"] > 0.5, since)
        since = window.mark()
        window.key("space")
        fitted = window.frame(lambda frame: not frame["playing"], since)
        self.assertGreater(fitted["scale"][1], 1)
        x, y = window.place("legend.high")
        bar = window.place("legend.low")[1] - y
        window.do("mousemove", x, y)
        window.frame()
        window.do("mousedown", 1)
        window.frame()
        window.do("mousemove", x, y + 10)
        window.frame()
        window.do("mousemove", x, y + bar // 4)
        moved = window.frame(lambda frame: frame["scale"] != fitted["scale"])
        window.do("mouseup", 1)
        # The upper end was at 1 of the bar and is at 3/4 now: halfway from the middle, which stays 0.
        moved = window.frame(lambda frame: abs(frame["scale"][1] / fitted["scale"][1] - 0.5) < 0.08)
        self.assertAlmostEqual(moved["scale"][0], -moved["scale"][1], places=4)
        self.assertEqual(moved["azimuth"], fitted["azimuth"], "the camera does not take the mouse from the legend")
        window.until("bar of the new scale", lambda: window.place("legend.high") == (x, y))
        window.do("mousemove", x, y)
        window.frame()
        window.do("click", "--repeat", 2, "--delay", 60, 1)
        again = window.frame(lambda frame: frame["scale"] != moved["scale"])["scale"]
        # It fits the current values now; before, it fitted those of the last seconds too.
        self.assertLessEqual(again[1], fitted["scale"][1])
        self.assertGreater(again[1], 1.2 * moved["scale"][1])
        window.click("color.log")
        self.finish(window)

    def test_a_selected_robot_keeps_its_colors(self):
        window = self.small("--paused", "--color", "strain")
        window.key("f")
        window.frame(lambda frame: len(frame["where"]) == 2)
        aside = window.place("play.play") if "play.play" in window.items else (SIZE[0] // 2, SIZE[1] - 5)

        def picture():
            """The window, and where the middle of the robot is: the message of a picture that is saved takes room."""
            window.do("mousemove", *aside)
            x, y = map(round, window.standing()["where"][1])
            return window.screenshot(), x, y

        before, x, y = picture()
        was = before[y - 5:y + 6, x - 5:x + 6]
        window.click("robot.1")  # a click in the picture would mark a mass, too
        window.frame(lambda frame: frame["selected"] == 1)
        after, x, y = picture()
        changed = numpy.abs(after - before).max(axis=2) > 0.02
        self.assertLessEqual(numpy.abs(after[y - 5:y + 6, x - 5:x + 6] - was).max(), 0.02, "the middle of the robot is as before")
        red, green, blue = numpy.moveaxis(after, 2, 0)
        line = changed & (red > 0.85) & (green > 0.75) & (blue < 0.75) & (red - blue > 0.2)
        near = line[max(0, y - 200):y + 200, max(0, x - 250):x + 250]
        self.assertGreater(near.sum(), 60, "there is a line")
        # The line is thin: no block of 7 pixels is on it.
        thick = numpy.lib.stride_tricks.sliding_window_view(near, (7, 7)).all(axis=(2, 3))
        self.assertFalse(thick.any())
        self.finish(window)

    def test_a_handle_moves_the_cut_of_every_robot(self):
        window = self.small("--paused", "--cut=-y:50%")
        window.place("cut.handle")
        whole = window.screenshot()
        before = window.frame(lambda frame: frame["cut"] == 50)
        x, y = window.place("cut.handle")
        window.do("mousemove", x, y)
        window.frame()
        window.do("mousedown", 1)
        window.frame()
        for step in range(1, 5):
            window.do("mousemove", x + 10 * step, y - 10 * step)
            window.frame()
        window.do("mouseup", 1)
        moved = window.frame(lambda frame: abs(frame["cut"] - 50) > 3)
        self.assertEqual(moved["azimuth"], before["azimuth"], "the camera does not take the mouse from the handle")
        cut = window.screenshot()
        changed = numpy.abs(cut - whole).max(axis=2) > 0.05
        for x, y in moved["where"]:
            x, y = round(x), round(y)
            self.assertGreater(changed[max(0, y - 60):y + 60, max(0, x - 60):x + 60].sum(), 20, "each robot is cut elsewhere now")
        self.finish(window)

    def test_a_robot_swims_to_the_target_that_the_mouse_moves(self):
        window = self.open(str(SAMPLES.parent / "hunter.json"), "--paused", "--target", "1,1,0")
        before = window.frame(lambda frame: frame["target"] == [1, 1, 0])
        self.assertEqual(before["layout"], "grid", "cells have no place for a target")

        def drag(right, up):
            x, y = map(round, window.place("target.handle"))
            window.do("mousemove", x, y)
            window.frame()
            window.do("mousedown", 1)
            window.frame()
            for step in range(1, 5):
                window.do("mousemove", x + right * step, y - up * step)
                window.frame()
            window.do("mouseup", 1)
            return window.frame()["target"]

        level = drag(-15, 8)
        self.assertEqual(level[2], 0)
        self.assertGreater(abs(level[0] - 1) + abs(level[1] - 1), 0.3)
        window.do("keydown", "shift")
        raised = drag(0, 6)
        window.do("keyup", "shift")
        self.assertEqual(raised[:2], level[:2])
        self.assertGreater(raised[2], 0.05)
        window.key("ctrl+z")  # each drag is one edit
        window.frame(lambda frame: frame["target"] == level)
        window.key("space")
        window.frame(lambda frame: near(frame["where"][0], window.items["target.handle"]))
        self.finish(window)

    def test_a_robot_begins_around_the_target_and_returns_there(self):
        window = self.open(str(SAMPLES.parent / "hunter.json"), "--paused", "--target-radius", "2", "--turned", "--seed", "4")
        self.assertEqual(window.frame(lambda frame: frame["where"])["layout"], "grid")

        def offset():
            """From the target to the robot on the screen, when nothing moves any more."""
            return numpy.array(window.standing()["where"][0]) - numpy.array(window.place("target.handle"))

        begins = offset()
        self.assertGreater(numpy.hypot(*begins), 100)
        window.key("space")
        window.frame(lambda frame: frame["steps"] > 1000)
        window.key("space")
        self.assertGreater(numpy.hypot(*(offset() - begins)), 5)
        window.key("r")
        window.frame(lambda frame: frame["steps"] == 0)
        self.assertLess(numpy.hypot(*(offset() - begins)), 2)
        self.finish(window)

    def test_a_brain_is_watched(self):
        window = self.small("--paused")
        window.open("Brain")
        since = window.mark()
        window.click("brain.sample")  # neither of the two robots has one
        window.wait("robots", since, lambda event: event["names"] == ["eel", "fish", "hunter"])
        x, y = window.place("brain.graph")
        window.place("brain.plot")
        window.key("space")
        window.frame(lambda frame: frame["time"] > 0.2)
        before = window.screenshot()
        window.frame(lambda frame: frame["time"] > 0.4)
        after = window.screenshot()
        changed = numpy.abs(after - before).max(axis=2) > 0.05
        self.assertGreater(changed[y - 80:y + 80, x - 100:x + 100].sum(), 50, "the graph shows what neurons do")
        since = window.mark()
        window.click("brain.neuron.0")
        window.wait("brain", since, lambda event: event["node"] == "turn 0" and event["plotted"] == 4)
        self.finish(window)

    def test_a_long_name_of_a_neuron_is_wrapped(self):
        folder = scratch()
        name = "a layer whose name is much longer than the window is wide: " + 4 * "model.encoder.blocks.0.attention.weight/"
        text = (SAMPLES.parent / "hunter.json").read_text().replace('"turn"', f'"{name}"')
        (folder / "long.json").write_text(text)
        window = self.window_in(folder, str(folder / "long.json"), "--paused")
        window.open("Brain")
        x, y = map(round, window.place("brain.neuron.0"))
        window.do("mousemove", x, y + 150)
        window.standing()
        before = window.screenshot()
        window.do("mousemove", x, y)
        window.standing()
        changed = (numpy.abs(window.screenshot() - before).max(axis=2) > 0.05).any(axis=0)
        self.assertGreater(changed[920:1200].sum(), 200, "there is a tooltip")
        self.assertEqual(changed[:340].sum(), 0, "it is wrapped, and does not reach the left panel")
        self.finish(window)

    def test_a_neuron_is_silenced_and_the_whole_brain_is_its_ghost(self):
        window = self.small("--paused")
        window.open("Brain")
        window.click("brain.sample")
        window.place("brain.neuron.0")
        since = window.mark()
        window.click("brain.neuron.0", button=3)
        window.click("brain.silence")
        self.assertEqual(window.wait("clamp", since)["value"], 0)
        window.click("brain.compare")
        window.key("space")
        window.frame(lambda frame: frame["ghosts"] == 1 and frame["time"] > 0.2)
        window.key("space")
        since = window.mark()
        window.click("brain.neuron.0", button=3)
        x, y = window.place("brain.hold")
        window.drag((x, y), (x + 40, y))
        self.assertGreater(window.wait("clamp", since)["value"], 0)
        window.key("Escape")
        window.click("brain.release_all")
        window.until("release", lambda: "brain.release_all" not in window.items)
        window.key("ctrl+z")
        window.place("brain.release_all")
        self.finish(window)

    def test_a_message_has_a_bar_in_the_color_of_its_tone(self):
        window = self.small()
        bad = numpy.array([0xf0, 0x70, 0x5f]) / 255

        def marked():
            return int((numpy.abs(window.screenshot() - bad).max(axis=2) < 0.04).sum())

        before = marked()
        broken = self.folder / "broken.json"
        broken.write_text("{}")
        since = window.mark()
        window.drop(broken)
        window.wait("message", since, lambda event: event["tone"] == "error")
        window.frame()
        self.assertGreater(marked(), before + 40)
        self.finish(window)

    def test_ranking_sorts_and_measurements_are_exported(self):
        window = self.open(str(SAMPLES / "fish.json"), str(SAMPLES / "eel.json"), str(SAMPLES / "ray.json"))
        window.frame(lambda frame: frame["time"] > 1)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        window.open("Ranking")
        for _ in range(2):
            since = window.mark()
            window.click("ranking.by.robot")
            event = window.wait("ranking", since)
            self.assertEqual(event["by"], "robot")
            self.assertEqual(event["names"], sorted(["fish", "eel", "ray"], reverse=not event["ascending"]))
        window.click("ranking.by.distance")
        window.open("Measure")
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

    def test_a_copied_command_makes_the_same_scene(self):
        def copy(window):
            since = window.mark()
            window.click("tune.copy")
            return window.wait("copied", since)["text"]

        window = self.open(str(SAMPLES / "eel.json"), "--random", "voxel:2", "--seed", "3", "--paused")
        names = window.wait("robots", 0, lambda event: event["count"] == 3)["names"]
        window.key("3", "d", "b", "t")
        window.open("Tune")
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
        again.open("Tune")
        again.key("t")  # the turntable has moved on; everything else is the same
        again.frame(lambda frame: frame["camera"] == "still")

        def settings(command):
            return sorted(word for word in shlex.split(command) if not word.startswith(("--azimuth", "--elevation", "--camera")))

        self.assertEqual(settings(copy(again)), settings(command))
        self.finish(again)

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
        self.assertEqual((stream["width"], stream["height"]), SIZE)
        self.assertGreater(int(stream["nb_read_frames"]), 10)
        self.finish(window)

    def test_settings_are_kept_for_the_next_start(self):
        window = self.small("--paused", surroundings=True)
        window.open("Tune")
        window.wait("panel", 0, lambda event: event["name"] == "Tune")
        x, y = window.place("view")
        edge = int(x + window.items["view"]["width"] / 2)
        window.drag((edge, y), (edge - 60, y))
        width = window.until("a wider column", lambda: window.items["panel.Tune"]["width"] if
                             abs(edge - 60 - window.items["view"]["x"] - window.items["view"]["width"] / 2) < 3 else 0)
        window.key("3", "b", "t")
        window.frame(lambda frame: (frame["color"], frame["theme"], frame["camera"]) == ("strain", "light", "turntable"))
        self.finish(window)
        again = self.window_in(self.folder, "--paused", surroundings=True)
        again.place("panel.Tune")
        again.frame(lambda frame: (frame["color"], frame["theme"], frame["camera"]) == ("strain", "light", "turntable"))
        self.assertLess(abs(again.items["panel.Tune"]["width"] - width), 2)
        self.finish(again)


if __name__ == "__main__":
    main()
