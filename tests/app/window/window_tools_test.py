# SPDX-License-Identifier: Apache-2.0
"""Messages, columns, keys and other tools of the real window: window_tools_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import shutil
import subprocess
import time
from pathlib import Path

from window_case import PROGRAM, SAMPLES, WindowCase, main, numpy
from window_driver import SIZE, Window, scratch


class ToolsTest(WindowCase):
    def test_a_slider_drives_a_muscle_by_hand_until_it_is_released(self):
        window = self.small("--paused")
        window.open("Actuators")
        x, y = window.place("actuator.0")
        width, since = window.items["actuator.0"]["width"], window.mark()
        window.drag((x, y), (x + 0.2 * width, y), (x + width, y))
        self.assertEqual(window.wait("drive", since, lambda event: event["drive"] == 1)["drive"], 1)
        window.place("actuator.0.release")
        since = window.mark()
        window.key("ctrl+z")  # the whole drag is one edit
        window.until("release", lambda: "actuator.0.release" not in window.items)
        window.key("ctrl+y")
        window.click("actuator.0.release")
        self.assertIsNone(window.wait("drive", since)["drive"])
        window.until("release", lambda: "actuator.0.release" not in window.items)
        window.drag((x, y), (x + width, y))
        window.click("actuators.release")
        window.until("release", lambda: "actuator.0.release" not in window.items)
        self.finish(window)

    def test_a_drag_pushes_all_robots_along_its_arrow(self):
        window = self.open(str(SAMPLES / "quadruped.json"), "--environment", "land", "--paused")
        x, y = window.frame(lambda frame: len(frame["where"]) == 1)["where"][0]
        pushes = []
        for way in (80, 160):
            since = window.mark()
            window.act("mousemove", round(x), round(y))
            window.act("keydown", "Control_L")
            window.act("mousedown", 3)
            for step in (way // 2, way):
                window.act("mousemove", round(x) + step, round(y))
            window.act("mouseup", 3)
            window.act("keyup", "Control_L")
            pushes.append(window.wait("push", since)["velocity"])
        for velocity in pushes:
            self.assertAlmostEqual(velocity[2], 0, places=4)  # along the ground
        # Twice the arrow is twice the velocity, but for perspective.
        self.assertAlmostEqual(numpy.linalg.norm(pushes[1]) / numpy.linalg.norm(pushes[0]), 2, delta=0.2)
        self.finish(window)

    def test_probes_plot_a_mass_and_a_spring_over_time_until_they_are_removed(self):
        window = self.small()
        x, y = map(round, window.frame(lambda frame: len(frame["where"]) == 2)["where"][1])
        window.do("mousemove", x, y)
        window.frame()
        window.do("click", 1)
        window.wait("pinned")
        since = window.mark()
        window.click("pinned.plot")
        self.assertEqual(window.wait("probe", since)["count"], 1)
        for quantity in ("speed", "strain", "force"):
            window.place(f"probe.plot.{quantity}")
        time = window.frame()["time"]
        window.frame(lambda frame: frame["time"] > time + 0.5)
        window.click("pinned.plot")  # it is there already
        window.click("probe.0.remove")
        self.assertEqual(window.wait("probe", since, lambda event: event["count"] == 0)["count"], 0)
        window.until("no plots", lambda: "probe.plot.speed" not in window.items)
        self.finish(window)

    def test_the_tree_of_the_scene_is_searched_and_selects(self):
        window = self.open("--random", "voxel:1000", "--paused")
        window.wait("robots", 0, lambda event: event["count"] == 1000)
        window.open("Tree")
        window.click("tree.1")
        window.frame(lambda frame: frame["selected"] == 1)
        row = window.items["tree.1"]
        window.do("mousemove", row["x"] - row["width"] / 2 + 1.5 * row["height"] / 1.5, row["y"])
        since = window.mark()
        window.do("click", 1)
        window.wait("tree", since)
        since = window.mark()
        window.click("tree.2")  # the muscles of the first robot
        self.assertTrue(window.wait("tree", since)["row"].startswith("muscles: "))
        window.click("tree.search")
        name = window.wait("robots", 0, lambda event: event["count"] == 1000)["names"][-1]
        window.type(name)
        window.until("one robot", lambda: "tree.1" in window.items and "tree.3" not in window.items)
        since = window.mark()
        window.click("tree.1")
        self.assertEqual(window.wait("tree", since)["row"], name)
        self.finish(window)

    def test_messages_are_kept_and_can_be_copied(self):
        window = self.small("--paused")
        for name in ("first.json", "second.json"):
            (self.folder / name).write_text("{}")
            since = window.mark()
            window.drop(self.folder / name)
            window.wait("message", since, lambda event: event["tone"] == "error")
        window.click("toast")
        window.place("panel.Messages")
        since = window.mark()
        window.click("messages.copy")
        lines = window.wait("copied", since)["text"].splitlines()
        self.assertEqual(len(lines), 2)
        for line, name in zip(lines, ("first.json", "second.json")):
            self.assertRegex(line, rf"^\d\d:\d\d:\d\d  error  .*{name}")
        since = window.mark()
        window.click("message.1")
        self.assertEqual(window.wait("copied", since)["text"], lines[1])
        window.click("messages.Warnings")
        window.until("no warnings", lambda: "message.0" not in window.items)
        self.finish(window)

    def test_a_message_of_forty_thousand_letters(self):
        """ImGui ends the program at 16,384 letters of one wrapped text: a command with many long paths is longer."""
        folder = scratch().joinpath(*["a-folder-deep-down"] * 100)
        folder.mkdir(parents=True)
        robots = [shutil.copy(SAMPLES / "eel.json", folder / f"eel{i}.json") for i in range(20)]
        window = self.open(*map(str, robots), "--paused")
        window.open("Tune")
        since = window.mark()
        window.click("tune.copy")
        command = window.wait("copied", since)["text"]
        self.assertGreater(len(command), 38000)
        self.assertEqual(window.wait("message", since)["text"], "copied: " + command)
        window.click("toast")
        window.place("panel.Messages")
        since = window.mark()
        window.click("messages.copy")
        self.assertIn(command, window.wait("copied", since)["text"])
        self.finish(window)

    def test_columns_collapse_by_key_and_in_a_narrow_window(self):
        window = self.small("--paused")

        def width():
            return window.items["view"]["width"]

        rails = 4 * window.items["tab.Robots"]["x"]  # of two, in whose middles the icons are
        both = width()
        window.key("bracketleft")
        window.until("wider picture", lambda: width() > both + 200)
        one = width()
        window.click("tab.View")
        window.until("whole width", lambda: width() == SIZE[0] - rails)
        window.key("bracketleft")
        window.until("left column", lambda: width() == both + SIZE[0] - rails - one)
        self.finish(window)
        # The choice is kept for the next start.
        window = self.window_in(self.folder, "--paused")
        self.assertEqual(width(), both + SIZE[0] - rails - one)
        self.finish(window)
        window = Window(PROGRAM, self.display, scratch(), str(SAMPLES / "eel.json"), "--paused", size="640x400")
        self.addCleanup(window.close)
        self.assertEqual(width(), 640 - rails)
        window.key("bracketleft")
        window.place("panel.Robots")
        window.click("tab.View")
        window.place("panel.View")
        window.until("one column", lambda: "panel.Robots" not in window.items)
        window.key("bracketright")
        window.until("no column", lambda: width() == 640 - rails)
        self.finish(window)

    def test_the_first_start_shows_one_robot_and_then_all(self):
        window = Window(PROGRAM, self.display, scratch(), first_start=True)
        self.addCleanup(window.close)
        near = window.frame(since=0)
        self.assertIn("panel.Robots", window.items)
        self.assertNotIn("panel.View", window.items)
        self.assertTrue(near["playing"])
        self.assertEqual(near["camera"], "group")
        far = window.frame(lambda frame: frame["distance"] > 2 * near["distance"])
        self.assertLess(far["time"], 15)
        window.click("tab.View")
        window.place("panel.View")
        window.click("tab.View")
        window.until("closed column", lambda: "panel.View" not in window.items)
        self.finish(window)

    def test_undo_ends_at_the_first_scene_and_an_empty_one_has_a_hint(self):
        window = self.small("--paused")
        window.wait("robots", accept=lambda event: event["count"] == 2)
        since = window.mark()
        window.key("ctrl+z")
        window.click("clear")
        window.place("empty_hint")
        self.assertEqual(window.wait("robots", since)["count"], 0, "the undo before changed nothing")
        window.key("ctrl+z")
        window.wait("robots", since, lambda event: event["count"] == 2)
        window.until("no hint", lambda: "empty_hint" not in window.items)
        self.finish(window)

    def test_the_ranking_holds_still_under_the_mouse(self):
        window = self.open(*(str(SAMPLES / f"{name}.json") for name in ("fish", "eel", "paddler", "wriggler")))
        window.frame(lambda frame: frame["time"] > 0.5)
        window.open("Ranking")
        window.click("ranking.by.speed")  # changes all the time
        heading, panel = window.items["ranking.by.speed"], window.items["panel.Ranking"]
        self.assertLess(heading["x"] + heading["width"] / 2, panel["x"] + panel["width"] / 2, "two figures are in view")
        window.do("mousemove", *window.place("ranking.0"))
        window.frame()

        def row(place):
            since = window.mark()
            window.click(f"ranking.{place}")
            return window.wait("row", since)

        before = [row(place)["robot"] for place in range(4)]
        time = window.frame()["time"]
        window.frame(lambda frame: frame["time"] > time + 1)
        self.assertEqual([row(place)["robot"] for place in range(4)], before)
        self.assertEqual(sorted(before), ["eel", "fish", "paddler", "wriggler"])
        row(0)
        window.do("keydown", "Shift_L")
        self.assertEqual(row(2)["selected"], 3)
        window.do("keyup", "Shift_L")
        window.do("keydown", "Control_L")
        self.assertEqual(row(1)["selected"], 2)
        self.assertEqual(row(1)["selected"], 3)
        window.do("keyup", "Control_L")
        self.assertEqual(row(3)["selected"], 1)
        self.finish(window)

    def test_the_text_size_buttons_stay_under_the_mouse(self):
        window = self.small("--paused")
        window.open("View")
        x, y = window.place("view")
        panel = window.items["panel.View"]
        window.do("mousemove", panel["x"], panel["y"])
        for _ in range(40):
            if "text.larger" in window.items and abs(window.items["text.larger"]["y"] - panel["y"]) < panel["height"] / 2 - 30:
                break
            window.do("click", 5)
            window.frame()
        since = window.mark()
        window.click("text.larger")
        place = window.place("text.larger")
        for _ in range(3):
            window.do("click", 1)
        window.frame(lambda frame: abs(frame["text"] - 1.4) < 0.01, since)
        self.assertEqual(window.place("text.larger"), place)
        window.key("ctrl+minus")
        window.frame(lambda frame: abs(frame["text"] - 1.3) < 0.01)
        window.key("ctrl+shift+equal")
        window.frame(lambda frame: abs(frame["text"] - 1.4) < 0.01)
        self.finish(window)

    def test_a_recording_shows_a_sign_that_is_not_in_the_film(self):
        if shutil.which("ffmpeg") is None:
            self.skipTest("this machine has no ffmpeg")
        window = self.small("--paused", "--caption", "two swimmers")
        window.open("Video")
        since = window.mark()
        window.click("video.record")
        file = window.wait("recording", since)["file"]
        sign = window.until("a sign", lambda: window.items.get("recording.sign"))
        caption = window.items["caption"]
        self.assertGreater(sign["y"] - sign["height"] / 2, caption["y"] + caption["height"] / 2)
        rows, columns = (slice(int(sign[at] - sign[size] / 2), int(sign[at] + sign[size] / 2))
                         for at, size in (("y", "height"), ("x", "width")))

        def red(pixels):
            part = pixels[rows, columns].astype(int)
            return int(((part[:, :, 0] > 180) & (part[:, :, 1] < 90) & (part[:, :, 2] < 90)).sum())

        window.frame()
        self.assertGreater(red(window.pixels()), 30)
        self.assertEqual(red(window.screenshot() * 255), 0)
        since = window.mark()
        window.key("v")
        window.wait("recorded", since)
        window.until("no sign", lambda: "recording.sign" not in window.items)
        film = subprocess.run(["ffmpeg", "-v", "error", "-i", file, "-frames:v", "1", "-f", "rawvideo", "-pix_fmt", "rgb24", "-"],
                              capture_output=True, check=True).stdout
        self.assertEqual(red(numpy.frombuffer(film, numpy.uint8).reshape(SIZE[1], SIZE[0], 3)), 0)
        self.finish(window)

    def test_a_clean_picture_of_the_group_is_saved(self):
        window = self.small("--paused")
        window.open("Video")
        since = window.mark()
        window.click("video.picture")
        file = Path(window.wait("recorded", since)["file"])
        self.assertEqual(file.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(file.read_bytes()[16:24], (1920).to_bytes(4, "big") + (1080).to_bytes(4, "big"))
        self.finish(window)

    def test_the_first_gestures_fade_after_use(self):
        folder = scratch()
        window = self.window_in(folder, str(SAMPLES / "eel.json"), "--paused")
        for gesture in ("turn", "move", "zoom", "pull a mass"):
            window.place(f"gesture.{gesture}")
        x, y = window.place("view")
        window.do("mousemove", x, y - 150, "click", 4)
        window.until("zoom known", lambda: "gesture.zoom" not in window.items)
        window.drag((x, y - 150), (x + 60, y - 150))
        window.until("turn known", lambda: "gesture.turn" not in window.items)
        self.assertIn("gesture.pull a mass", window.items)
        self.finish(window)
        again = self.window_in(folder, str(SAMPLES / "eel.json"), "--paused")
        again.place("gesture.move")
        again.frame()
        self.assertNotIn("gesture.turn", again.items)
        self.assertNotIn("gesture.zoom", again.items)
        self.finish(again)

    def test_nothing_covers_another_in_a_low_window(self):
        window = Window(PROGRAM, self.display, scratch(), str(SAMPLES / "eel.json"), "--paused", "--color", "strain", size="640x400")
        self.addCleanup(window.kill)

        def box(name):
            item = window.items[name]
            return (item["x"] - item["width"] / 2, item["y"] - item["height"] / 2,
                    item["x"] + item["width"] / 2, item["y"] + item["height"] / 2)

        def covered():
            names = [name for name in window.items if name == "caption" or name.startswith(("gesture.", "axes.", "legend."))]
            self.assertIn("legend.high", names)
            boxes = {name: box(name) for name in names}
            return [(a, b) for a in names for b in names if a < b and a.split(".")[0] != b.split(".")[0]
                    and boxes[a][0] < boxes[b][2] and boxes[b][0] < boxes[a][2]
                    and boxes[a][1] < boxes[b][3] and boxes[b][1] < boxes[a][3]]

        for key in (None, "bracketleft", "bracketright"):  # no column, the left one, the right one
            if key:
                window.key(key)
            window.until("settled", lambda: window.frame() and not covered())
        window.key("bracketright", "ctrl+a")
        window.frame(lambda frame: frame["selected"] == 1)
        window.key("e")
        window.place("dialog.accept")
        window.until("all of the form in the window", lambda: window.frame() and box("dialog.accept")[3] < 400)
        window.kill()

    def test_messages_leave_the_caption_free(self):
        for size, place in (("1280x720", "beside"), ("640x480", "below")):
            window = self.small("--paused", "--caption", "Two swimmers that nobody should confuse with each other", size=size)
            window.key("h")  # without the menu bar, messages are over the view
            since = window.mark()
            window.key("F5")  # a camera bookmark that is not set
            window.wait("message", since)
            window.place("toast")
            caption, toast = window.items["caption"], window.items["toast"]
            beside = toast["x"] - toast["width"] / 2 > caption["x"] + caption["width"] / 2
            below = toast["y"] - toast["height"] / 2 > caption["y"] + caption["height"] / 2
            self.assertTrue({"beside": beside, "below": below}[place], (place, caption, toast))
            self.finish(window)

    def test_a_window_on_land_ends_in_order_at_sigterm(self):
        for delay in (0, 0.05, 0.3):
            window = self.open(str(SAMPLES.parent / "dog.json"), "--environment", "land", surroundings=True, quality="medium")
            # Footprints are drawn from this quality on, while the physics looks for the next ones.
            window.frame(lambda frame: frame["time"] > 0.2)
            time.sleep(delay)  # other moments of steps and frames
            window.process.terminate()
            # In order, or at once after half a second (app/base/interrupt.h), and never by a crash.
            self.assertIn(window.process.wait(60), (0, 128 + 15), window.stderr())

    def test_the_button_that_makes_robots_is_in_view(self):
        window = self.small("--paused")
        item = window.items["generate"]
        bottom = window.items["panel.Robots"]["y"] + window.items["panel.Robots"]["height"] / 2
        self.assertLess(item["y"] + item["height"] / 2, bottom)
        since = window.mark()
        window.click("generate")
        window.wait("robots", since, lambda event: event["count"] == 6)
        self.finish(window)

    def test_keys_are_remapped_by_a_file(self):
        folder = scratch()
        settings = folder / "config/mercury/keys.txt"
        settings.parent.mkdir(parents=True)
        settings.write_text("theme = J\nlegend = Ctrl J\nnonsense = X\n")
        window = self.window_in(folder, str(SAMPLES / "eel.json"), "--paused")
        message = window.wait("message", 0, lambda event: event["tone"] == "warning")["text"]
        self.assertTrue(message.endswith('keys.txt:3: "nonsense" is no command'), message)
        window.key("b")  # no longer the key of the theme
        window.key("j")
        window.frame(lambda frame: frame["theme"] == "light")
        self.finish(window)


if __name__ == "__main__":
    main()
