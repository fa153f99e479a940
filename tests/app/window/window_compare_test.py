# SPDX-License-Identifier: Apache-2.0
"""Two views and ghosts in the real window: window_compare_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
from window_case import WindowCase, main, numpy
from window_driver import SIZE


class CompareTest(WindowCase):
    def pause(self, window):
        window.key("space")
        return window.frame(lambda frame: not frame["playing"])

    def half(self, picture, window, item):
        """The pixels of the middle of an item."""
        area = window.items[item]
        x, y = int(area["x"]), int(area["y"])
        width, height = int(0.4 * area["width"]), int(0.25 * area["height"])
        return picture[y - height:y + height, x - width:x + width]

    def test_two_views_show_the_same_time_under_different_settings(self):
        window = self.small()
        window.key("i")
        shown = window.frame(lambda frame: frame["second"] and frame["second"]["time"] > 0.3)
        self.assertEqual(shown["second"]["solver"], "xpbd")
        window.place("title.first")
        window.place("title.second")
        self.assertLess(window.items["title.first"]["x"], window.items["second"]["x"])
        self.pause(window)
        paused = window.frame()
        self.assertEqual(paused["second"]["steps"], paused["steps"])
        # One step, one step back, and a drag along the timeline.
        window.key("Right")
        frame = window.frame(lambda frame: frame["steps"] == paused["steps"] + 1)
        self.assertEqual(frame["second"]["steps"], frame["steps"])
        window.key("Left", "Left")
        frame = window.frame(lambda frame: frame["steps"] == paused["steps"] - 1)
        self.assertEqual(frame["second"]["steps"], frame["steps"])
        window.key("r")
        frame = window.frame(lambda frame: frame["time"] == 0)
        self.assertEqual(frame["second"]["time"], 0)
        # The right side in another environment: its picture is another one.
        window.open("Compare")
        window.click("compare.environment")
        window.frame(lambda frame: frame["second"] and frame["second"]["environment"] == "land")
        picture = window.screenshot()
        water = self.half(picture, window, "title.first").mean(axis=(0, 1))
        land = self.half(picture, window, "title.second").mean(axis=(0, 1))
        self.assertGreater(numpy.abs(water - land).max(), 0.03)
        window.click("compare.off")
        window.frame(lambda frame: frame["second"] is None)
        window.until("one view", lambda: "title.first" not in window.items)
        self.finish(window)

    def test_the_legend_covers_no_robot_of_the_second_view(self):
        window = self.small("--paused", "--camera", "group")
        window.key("3", "i")  # colors by strain
        window.frame(lambda frame: frame["second"])
        window.place("legend")
        frame = window.standing()
        area, legend = window.items["second"], window.items["legend"]
        to_second = area["x"] - window.items["title.first"]["x"]
        left = legend["x"] - legend["width"] / 2
        picture = window.screenshot()
        background = picture[int(area["y"]) + 5, int(area["x"])]
        for x, y in frame["where"]:
            row = numpy.abs(picture[round(y), :int(left)] - background).max(axis=1) > 0.1
            end = max(column for column in range(round(x + to_second), int(left)) if row[column])
            self.assertLess(end, left - 2, "the robot ends before the legend")
        self.finish(window)

    def test_the_mouse_selects_robots_on_either_side(self):
        window = self.small("--paused")
        window.key("i")
        window.frame(lambda frame: frame["second"])
        frame = window.standing()
        window.place("second")
        distance = window.items["second"]["x"] - window.items["title.first"]["x"]
        x, y = frame["where"][0]
        window.do("mousemove", x + distance, y)
        window.frame()
        window.do("click", 1)
        window.frame(lambda frame: frame["selected"] == 1)
        self.finish(window)

    def test_a_ghost_shows_a_robot_as_it_was(self):
        window = self.small()
        window.key("ctrl+a", "a")
        window.frame(lambda frame: frame["ghosts"] == 2)
        window.place("ghost.0")
        window.key("a")
        window.frame(lambda frame: frame["ghosts"] == 0)
        window.until("no figures", lambda: "ghost.0" not in window.items)
        # Mutants beside the ghosts of their parents.
        window.key("m")
        window.wait("robots", 0, lambda event: event["count"] == 4)
        window.key("ctrl+i", "a", "r")
        window.frame(lambda frame: frame["ghosts"] == 2 and frame["time"] > 0.5)
        self.pause(window)
        window.place("ghost.2")
        window.frame()
        with_ghosts = window.screenshot()
        window.key("a")
        window.frame(lambda frame: frame["ghosts"] == 0)
        window.until("no figures", lambda: "ghost.2" not in window.items)
        without = window.screenshot()
        changed = (numpy.abs(with_ghosts - without).max(axis=2) > 0.05).mean()
        self.assertGreater(changed, 0.001)
        self.finish(window)

    def test_plots_and_the_timeline_share_a_cursor(self):
        window = self.small("--compare", "damping=1")
        window.frame(lambda frame: frame["time"] > 1 and frame["second"])
        paused = self.pause(window)
        window.open("Measure")
        x, y = window.place("plot.distance")
        window.do("mousemove", x, y)
        moment = window.frame(lambda frame: frame["cursor"] is not None)["cursor"]
        begin, head = paused["timeline"]["begin"], paused["timeline"]["head"]
        window.place("timeline.cursor")
        strip = window.items["timeline"]
        share = (window.items["timeline.cursor"]["x"] - strip["x"]) / strip["width"] + 0.5
        self.assertAlmostEqual(share, (moment - begin) / (head - begin), delta=0.02)
        # Ctrl and a click go there.
        window.do("keydown", "Control_L", "mousedown", 1)
        window.frame(lambda frame: frame["timeline"]["viewing"] and not frame["timeline"]["seeking"])
        window.do("mouseup", 1, "keyup", "Control_L")
        shown = window.frame()
        self.assertAlmostEqual(shown["time"], moment, delta=0.002)
        self.assertEqual(shown["second"]["steps"], shown["steps"])
        # Away from plots and timeline there is no cursor; over the timeline, plots have it, too.
        window.do("mousemove", SIZE[0] // 2, 300)
        window.frame(lambda frame: frame["cursor"] is None)
        window.do("mousemove", round(strip["x"]), round(strip["y"]))
        self.assertAlmostEqual(window.frame(lambda frame: frame["cursor"] is not None)["cursor"], (begin + head) / 2,
                               delta=0.02 * (head - begin))
        self.finish(window)

    def test_dashed_lines_of_a_zoomed_plot_are_drawn_only_inside_it(self):
        window = self.small("--compare", "damping=1")
        window.frame(lambda frame: frame["time"] > 1 and frame["second"])
        self.pause(window)
        window.open("Measure")
        window.do("mousemove", *window.place("plot.speed"))
        window.frame()
        # Each click shows 0.8 of the time before, so that the lines become a million times as long as the plot.
        since = window.mark()
        window.do("click", "--repeat", 70, "--delay", 30, 4)
        window.wait("plot", since, lambda event: event["to"] - event["from"] < 1e-5)
        window.frame()
        self.finish(window)

    def test_a_scene_keeps_its_two_views(self):
        window = self.small("--paused", "--compare", "solver=xpbd")
        window.frame(lambda frame: frame["second"])
        since = window.mark()
        window.key("ctrl+s")
        window.dialog("two.toml")
        window.wait("saved", since)
        self.assertIn('compare = "solver=xpbd"', (self.folder / "two.toml").read_text())
        self.finish(window)
        window = self.window_in(self.folder, "two.toml", "--paused")
        self.assertEqual(window.frame(lambda frame: frame["second"])["second"]["solver"], "xpbd")
        self.finish(window)


if __name__ == "__main__":
    main()
