# SPDX-License-Identifier: Apache-2.0
"""Layout, camera and names in the real window: window_layout_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import json
import math

from fast_input import FastInput
from window_case import SAMPLES, WindowCase, main, numpy
from window_driver import scratch
from window_playback_test import robot_that_explodes


def farthest(a, b):
    """The largest distance between places of the same robot [pixels]."""
    return numpy.linalg.norm(numpy.subtract(a, b), axis=1).max()


class LayoutTest(WindowCase):
    def after(self, window, seconds):
        """The first frame this much later in simulated time."""
        time = window.frame()["time"]
        return window.frame(lambda frame: frame["time"] > time + seconds)

    def test_robots_stay_in_their_cells_until_they_may_travel(self):
        window = self.small("--camera", "still")
        first = window.frame(lambda frame: len(frame["where"]) == 2 and frame["time"] > 0.2)
        self.assertEqual(first["layout"], "cells")
        self.assertLess(farthest(first["where"], self.after(window, 1)["where"]), 1.5)
        since = window.mark()
        window.key("c")
        travels = window.frame(lambda frame: frame["layout"] == "grid", since)
        self.assertGreater(farthest(travels["where"], self.after(window, 1.5)["where"]), 3)
        self.finish(window)

    def test_only_what_is_new_is_brought_to_the_display(self):
        window = self.small("--paused")

        def rest():
            """Tooltips and pictures of robots have come."""
            window.until("rest", lambda: len({window.frame()["presented"] for _ in range(10)}) == 1)

        window.open("View")
        window.do("mousemove", *window.place("panel.View"))
        rest()
        begin, shown = window.frame(), window.pixels()
        for _ in range(5):
            later = window.frame()
        self.assertGreater(later["number"], begin["number"] + 4)
        self.assertEqual(later["presented"], begin["presented"])
        window.click("tab.Tune")
        window.frame(lambda frame: frame["presented"] > begin["presented"])
        self.assertGreater((window.pixels() != shown).mean(), 0.01, "another panel")
        # What another window covered is shown again.
        rest()
        shown = window.pixels()
        cover = FastInput(self.display)
        self.addCleanup(cover.close)
        cover.cover(300, 200)  # away from the mouse, which would change the picture
        self.assertFalse(window.pixels()[:200, :300].any())
        self.assertTrue(shown[:200, :300].any())
        cover.uncover()
        window.until("what was covered", lambda: window.frame() and (window.pixels() == shown).all())
        self.finish(window)

    def test_top_shows_a_grid_from_above(self):
        window = self.open(*(str(SAMPLES / f"{name}.json") for name in ("eel", "fish", "ray", "squid")), "--paused",
                           "--grid", "2x2")
        before = window.frame(lambda frame: len(frame["where"]) == 4)
        window.key("z")
        above = window.frame(lambda frame: frame["elevation"] > 1.5)
        for _ in range(2):
            above = window.frame()
        where = numpy.array(above["where"])
        self.assertGreater(numpy.ptp(where[:, 0]), 100)
        self.assertGreater(numpy.ptp(where[:, 1]), 100, "rows lie beside each other")
        window.key("z")
        window.frame(lambda frame: abs(frame["elevation"] - before["elevation"]) < 0.01)
        self.finish(window)

    def test_a_wreck_neither_moves_the_camera_nor_hides_the_others(self):
        folder = scratch()
        (folder / "bad.json").write_text(json.dumps(robot_that_explodes("bad")))
        window = self.open(str(SAMPLES / "fish.json"), str(folder / "bad.json"), "--camera", "group", "--paused")
        before = window.frame(lambda frame: len(frame["where"]) == 2)["distance"]
        window.key("space")
        window.wait("exploded")
        later = self.after(window, 1)
        self.assertLess(later["distance"], 1.3 * before)
        x, y = later["where"][0]
        area = window.items["view"]
        self.assertLess(abs(x - area["x"]), area["width"] / 2)
        self.assertLess(abs(y - area["y"]), area["height"] / 2)
        # Its name stands clear of the card and of the text beside its spring.
        name = window.items.get("wreck.0")  # if there is room
        for other in ("panel.Explosion", "explosion.text") if name else ():
            self.assertFalse(self.meet(window.items[other], name))

        def red():
            picture = window.screenshot()
            return ((picture[:, :, 0] > 0.75) & (picture[:, :, 1] < 0.6) & (picture[:, :, 2] < 0.65)).mean()

        # Its springs are torn across the view; it is drawn as it was built.
        window.click("explosion.show")
        window.standing()
        self.assertLess(red(), 0.02)
        ends = [window.items[f"explosion.{end}"] for end in "ab"]
        self.assertLess(abs(ends[0]["x"] - ends[1]["x"]), area["width"] / 2)
        window.click("explosion.dismiss")
        window.key("Escape")
        self.assertLess(red(), 0.02)
        self.finish(window)

    @staticmethod
    def meet(a, b):
        return (abs(a["x"] - b["x"]) < (a["width"] + b["width"]) / 2 - 1.5 and
                abs(a["y"] - b["y"]) < (a["height"] + b["height"]) / 2 - 1.5)

    def test_names_leave_messages_and_hints_free(self):
        window = self.open("--random", "voxel:12", "--show", "skin,labels", "--paused")
        window.frame(lambda frame: len(frame["where"]) == 12)
        window.key("c")
        window.place("toast")
        labels = self.labels(window)
        self.assertGreaterEqual(len(labels), 4)
        over = [item for name, item in window.items.items() if name.startswith(("toast", "gesture.", "axes."))]
        self.assertGreaterEqual(len(over), 5)
        for label in labels:
            for item in over:
                self.assertFalse(self.meet(label, item), (label, item))
        self.finish(window)

    def test_messages_cover_nothing_and_move_nothing(self):
        window = self.open(*(str(SAMPLES / f"{name}.json") for name in ("eel", "fish", "squid")), "--camera", "group", "--paused")
        window.frame(lambda frame: len(frame["where"]) == 3)
        bad = self.folder / ("a-name-that-takes-several-lines-" * 7 + ".json")
        bad.write_text("{}")
        window.key("3")  # colors by strain: the legend shows
        window.place("legend")
        before = window.standing()

        def messages():
            """A short message and a long one, until both have gone. Returns where they were and what they could cover."""
            since = window.mark()
            window.key("F5")  # a camera bookmark that is not set
            window.drop(bad)
            window.wait("message", since, lambda event: event["tone"] == "error")
            window.place("toast")
            shown = dict(window.items["toast"]), dict(window.items["view"]), dict(window.items["legend"])
            while "toast" in window.items:
                window.click("toast", 3)
            return shown, [event for event in window.events[since:] if event["event"] == "frame"]

        (toast, view, legend), frames = messages()
        self.assertLessEqual(toast["y"] + toast["height"] / 2, view["y"] - view["height"] / 2, "it is in the menu bar")
        self.assertEqual({tuple(frame["eye"]) for frame in frames}, {tuple(before["eye"])})

        window.key("h")  # without the menu bar, they are over the view
        before = window.standing()
        (toast, view, legend), frames = messages()
        self.assertLess(abs(toast["y"] - toast["height"]), toast["height"], "it is at the top of the view")
        self.assertFalse(self.meet(toast, legend))
        self.assertLess(toast["y"] + toast["height"] / 2 + 15, min(y for x, y in before["where"]), "15 pixels: half an eel's height")
        self.assertEqual({tuple(frame["eye"]) for frame in frames}, {tuple(before["eye"])})
        self.finish(window)

    def labels(self, window):
        window.frame()
        window.frame()
        return [item for name, item in window.items.items() if name.startswith("label.")]

    def test_names_do_not_cover_each_other(self):
        window = self.open("--random", "voxel:12", "--show", "skin,labels", "--paused")
        window.frame(lambda frame: len(frame["where"]) == 12)
        labels = self.labels(window)
        self.assertGreaterEqual(len(labels), 6)
        for i, a in enumerate(labels):
            for b in labels[:i]:
                apart = max(abs(a["x"] - b["x"]) - (a["width"] + b["width"]) / 2,
                            abs(a["y"] - b["y"]) - (a["height"] + b["height"]) / 2)
                self.assertGreater(apart, -1.5)
        self.finish(window)

    def test_of_many_robots_only_the_best_and_the_selected_one_are_named(self):
        window = self.open("--random", "voxel:40", "--show", "skin,labels", "--paused")
        x, y = map(round, window.frame(lambda frame: len(frame["where"]) == 20)["where"][19])
        window.do("mousemove", 3, 3)  # off the robots: the one under the mouse would be named, too
        window.frame()
        self.assertLessEqual(len(self.labels(window)), 10)
        window.do("mousemove", x, y)
        window.frame()
        window.do("click", 1)
        window.frame(lambda frame: frame["selected"] == 1)
        window.until("the name of the selected robot", lambda: "label.19" in window.items)
        window.key("Escape")
        self.finish(window)

    def test_a_click_pins_figures_and_escape_takes_them_away(self):
        window = self.small("--paused")
        x, y = map(round, window.frame(lambda frame: len(frame["where"]) == 2)["where"][1])
        window.do("mousemove", x, y)
        window.frame()
        window.do("click", 1)
        window.wait("pinned")
        window.place("panel.Pinned")
        card, column = window.items["panel.Pinned"], window.items["panel.Robots"]
        self.assertLess(card["x"] + card["width"] / 2, window.items["view"]["x"] - window.items["view"]["width"] / 2)
        self.assertGreaterEqual(card["y"] - card["height"] / 2, column["y"] + column["height"] / 2)
        window.do("mousemove", x, y + 200)
        window.frame()
        window.place("panel.Pinned")
        window.key("Escape")
        window.until("the figures gone", lambda: "panel.Pinned" not in window.items)
        self.finish(window)

    def test_a_camera_that_is_chosen_while_robots_are_made_stays(self):
        window = self.open("--random", "voxel:1000", "--paused")
        window.frame()
        window.key("t")
        window.frame(lambda frame: frame["camera"] == "turntable")
        self.assertEqual(window.frame(lambda frame: frame["where"])["camera"], "turntable")
        self.finish(window)

    def test_the_axes_turn_the_camera_and_bookmarks_bring_it_back(self):
        window = self.small("--paused", "--camera", "still")
        begin = window.frame(lambda frame: len(frame["where"]) == 2)
        since = window.mark()
        window.key("shift+F5")
        window.wait("bookmark", since, lambda event: event.get("set") == 1)
        window.click("axes.y")
        window.frame(lambda frame: abs(frame["azimuth"] - math.pi / 2) < 0.01 and abs(frame["elevation"]) < 0.01)
        since = window.mark()
        window.key("F5")
        window.wait("bookmark", since, lambda event: event.get("gone") == 1)
        window.frame(lambda frame: abs(frame["azimuth"] - begin["azimuth"]) < 0.01 and
                     abs(frame["elevation"] - begin["elevation"]) < 0.01 and
                     abs(frame["distance"] - begin["distance"]) < 0.01 * begin["distance"])
        window.key("ctrl+s")
        window.dialog(str(self.folder / "marked.toml"))
        window.wait("saved")
        self.finish(window)
        again = self.window_in(self.folder / "again", str(self.folder / "marked.toml"), "--paused")
        again.frame(lambda frame: len(frame["where"]) == 2)
        since = again.mark()
        again.key("F5")
        again.wait("bookmark", since, lambda event: event.get("gone") == 1)
        self.finish(again)

    def test_racers_keep_to_their_lanes(self):
        window = self.small("--layout", "race", "--camera", "still")
        start = window.frame(lambda frame: len(frame["where"]) == 2)
        later = self.after(window, 3)
        first, last = numpy.array(start["where"]), numpy.array(later["where"])
        # Lanes run away from the eye, up in the picture, and are beside each other.
        self.assertGreater((first - last)[:, 1].max(), 5, "one of them has come along its lane")
        self.assertLess(abs((last - first)[:, 0]).max(), 0.4 * abs(first[1, 0] - first[0, 0]))
        self.finish(window)


if __name__ == "__main__":
    main()
