# SPDX-License-Identifier: Apache-2.0
"""The timeline in the real window: window_timeline_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import subprocess

from window_case import PROGRAM, SAMPLES, WindowCase, main, numpy
from window_driver import scratch


class TimelineTest(WindowCase):
    def drag(self, window, *shares):
        """Drags along the timeline, over these shares of its length."""
        window.place("timeline")
        item = window.items["timeline"]
        x = [item["x"] + (share - 0.5) * item["width"] for share in shares]
        window.do("mousemove", x[0], item["y"])
        window.frame()
        window.do("mousedown", 1)
        for place in x:
            window.do("mousemove", place, item["y"])
            window.frame()
        window.do("mouseup", 1)
        window.frame(lambda frame: self.is_at(frame, shares[-1]))
        return window.frame()

    def is_at(self, frame, share):
        """Whether this share of the timeline is shown, within 3 %: the mouse moves by whole pixels."""
        timeline = frame["timeline"]
        length = timeline["head"] - timeline["begin"]
        return not timeline["seeking"] and abs(frame["time"] - timeline["begin"] - share * length) < 0.03 * length

    def paused_at(self, window, time):
        window.frame(lambda frame: frame["time"] > time)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        return window.frame()

    def test_earlier_moments_are_shown_and_gone_on_from(self):
        window = self.small()
        present = self.paused_at(window, 0.5)
        shown = self.drag(window, 0.9, 0.5, 0.3)
        self.assertTrue(shown["timeline"]["viewing"])
        self.assertEqual(shown["timeline"]["head"], present["time"])
        window.key("Left")
        back = window.frame(lambda frame: frame["steps"] == shown["steps"] - 1)
        window.key("comma")
        window.frame(lambda frame: frame["steps"] == shown["steps"] - 2)
        window.key("Right", "period")
        window.frame(lambda frame: frame["steps"] == shown["steps"])
        window.key("End")
        end = window.frame(lambda frame: frame["steps"] == present["steps"])
        self.assertFalse(end["timeline"]["viewing"])
        window.key("Home")
        window.frame(lambda frame: frame["time"] == frame["timeline"]["begin"])
        self.drag(window, 0.4)
        window.click("timeline.go_on")
        gone = window.frame(lambda frame: not frame["timeline"]["viewing"])
        self.assertEqual(gone["timeline"]["head"], gone["time"])
        self.assertLess(gone["time"], present["time"])
        self.assertLess(back["time"], shown["time"])
        self.finish(window)

    def test_playing_robots_go_on_after_a_drag(self):
        window = self.small()
        head = window.frame(lambda frame: frame["time"] > frame["timeline"]["begin"] + 0.5)["time"]
        window.place("timeline")
        item = window.items["timeline"]
        window.do("mousemove", item["x"], item["y"])
        window.frame()
        since = window.mark()
        window.do("mousedown", 1)
        window.frame(lambda frame: frame["timeline"]["viewing"] and not frame["playing"], since)
        window.do("mouseup", 1)
        window.frame(lambda frame: frame["playing"] and frame["timeline"]["viewing"], since)
        window.frame(lambda frame: frame["time"] > head + 0.1 and not frame["timeline"]["viewing"], since)
        self.finish(window)

    def test_a_drag_that_ends_in_motion_shows_where_it_ended(self):
        window = self.small()
        self.paused_at(window, 0.6)
        window.place("timeline")
        item = window.items["timeline"]
        for begin, end in ((0.95, 0.5), (0.1, 0.7)):
            x = [round(item["x"] + (begin + i / 20 * (end - begin) - 0.5) * item["width"]) for i in range(21)]
            since = window.mark()
            window.do("mousemove", x[0], item["y"], "mousedown", 1, *(word for at in x for word in ("mousemove", at, item["y"])),
                      "mouseup", 1, "mousemove", x[0], item["y"])
            window.frame(lambda frame: self.is_at(frame, end), since)
            presses = window.frame()["input"]
            self.assertTrue(self.is_at(window.frame(lambda frame: frame["input"] >= presses), end))
        self.finish(window)

    def test_bookmarks_and_a_loop(self):
        window = self.small()
        self.paused_at(window, 0.4)
        first = self.drag(window, 0.25)
        window.key("x", "o")
        second = self.drag(window, 0.5)
        window.key("x", "o")
        marked = window.frame(lambda frame: frame["timeline"]["looping"])
        self.assertEqual(marked["timeline"]["bookmarks"], [first["time"], second["time"]])
        window.key("Prior")  # page up
        window.frame(lambda frame: frame["steps"] == first["steps"])
        window.key("Next")
        window.frame(lambda frame: frame["steps"] == second["steps"])
        since = window.mark()
        window.key("space")
        window.frame(lambda frame: frame["playing"] and frame["steps"] < second["steps"], since)
        window.frame(lambda frame: first["steps"] < frame["steps"] <= second["steps"], window.mark())
        window.key("o")
        window.frame(lambda frame: not frame["timeline"]["looping"])
        window.frame(lambda frame: frame["steps"] > second["steps"])
        self.finish(window)

    def test_a_fork_adds_a_robot(self):
        window = self.small()
        self.paused_at(window, 0.3)
        self.drag(window, 0.5)
        window.key("ctrl+a")
        window.frame(lambda frame: frame["selected"] == 2)
        window.key("y")
        self.assertEqual(window.wait("robots", accept=lambda event: event["count"] == 4)["names"][2:], ["eel-2", "fish-2"])
        self.assertEqual(window.frame()["selected"], 2)
        before = window.mark()
        window.key("ctrl+z")
        window.wait("robots", before, lambda event: event["count"] == 2)
        self.finish(window)

    def test_a_recording_plays_and_is_gone_on_from(self):
        folder = scratch()
        recording = folder / "eel.h5"
        subprocess.run([PROGRAM, "run", str(SAMPLES / "eel.json"), "--seconds", "1", "--device", "cpu", "--quiet",
                        "--record", str(recording)], check=True, stdout=subprocess.DEVNULL)
        window = self.open(str(recording))
        played = window.frame(lambda frame: frame["timeline"]["recording"] and frame["time"] > 0.2)
        self.assertAlmostEqual(played["timeline"]["head"], 0.99, delta=0.04)
        window.frame(lambda frame: not frame["playing"])  # its end
        self.drag(window, 0.5)
        window.key("u")
        gone = window.frame(lambda frame: not frame["timeline"]["recording"])
        self.assertEqual(gone["steps"] % 33, 0)  # a frame
        window.key("space")
        window.frame(lambda frame: frame["time"] > 1.2)
        self.finish(window)

    def test_a_recording_shows_what_brains_did(self):
        folder = scratch()
        recording, silent = folder / "hunt.h5", folder / "silent.h5"
        for path, more in ((recording, ["--brains"]), (silent, [])):
            subprocess.run([PROGRAM, "run", "sample:hunter", "--target", "-2,3,0", "--seconds", "1", "--device", "cpu",
                            "--quiet", "--record", str(path), *more], check=True, stdout=subprocess.DEVNULL)
        window = self.open(str(recording), "--paused")
        window.frame(lambda frame: frame["timeline"]["recording"])
        window.open("Brain")
        window.place("brain.graph")
        window.place("brain.plot")
        plot = window.items["brain.plot"]
        left, top = int(plot["x"] - plot["width"] / 2), int(plot["y"] - plot["height"] / 2)
        curves = window.screenshot()[top:top + int(plot["height"]), left:left + int(plot["width"])]
        colored = numpy.ptp(curves, axis=2) > 0.3
        later = colored[:, colored.shape[1] // 2:colored.shape[1] * 9 // 10]
        self.assertGreater(later.any(axis=0).mean(), 0.8, "the plot has the whole recording at its start")
        self.finish(window)
        window = self.open(str(silent), "--paused")
        window.frame(lambda frame: frame["timeline"]["recording"])
        window.open("Brain")
        window.frame()
        self.assertNotIn("brain.graph", window.items)
        self.finish(window)


if __name__ == "__main__":
    main()
