# SPDX-License-Identifier: Apache-2.0
"""Finding, choosing, breeding and editing robots in the real window: window_robots_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
from window_case import SAMPLES, WindowCase, main


class RobotsTest(WindowCase):
    def still(self, window):
        """The places of the robots in the view, once the camera stands."""
        presses = window.frame(lambda frame: frame["where"])["input"]
        window.key("f")
        before = window.frame(lambda frame: frame["input"] > presses)["where"]
        while before != (before := window.frame()["where"]):
            pass
        return before

    def names(self, window, count):
        return window.wait("robots", 0, lambda event: event["count"] == count)["names"]

    def palette(self, window, text):
        since = window.mark()
        window.key("ctrl+k")
        window.place("panel.Palette")
        window.frame()
        window.type(text)
        window.key("Return")
        name = window.wait("palette", since)["name"]
        window.until("palette closed", lambda: "panel.Palette" not in window.items)
        return name

    def test_the_palette_finds_commands_robots_and_settings(self):
        window = self.small("--paused")
        window.key("ctrl+k")
        window.place("palette.9")
        whole = window.items["panel.Palette"]["height"]
        window.type("turntable")
        window.until("it is as low as its rows", lambda: window.frame() and window.items["panel.Palette"]["height"] < whole / 2)
        window.key("Escape")
        window.until("closed", lambda: "panel.Palette" not in window.items)
        self.assertEqual(self.palette(window, "dark or light"), "dark or light theme")
        window.frame(lambda frame: frame["theme"] == "light")
        self.assertEqual(self.palette(window, "strain"), "color by Strain")
        window.frame(lambda frame: frame["color"] == "strain")
        self.assertEqual(self.palette(window, "eel"), "eel")
        window.frame(lambda frame: frame["selected"] == 1)
        self.assertTrue(self.palette(window, "panel measure").startswith("panel Measure"))
        window.place("panel.Measure")
        # A number: the palette asks for it.
        self.assertEqual(self.palette(window, "damping"), "damping")
        window.dialog("0.5")
        window.open("Tune")
        since = window.mark()
        window.click("tune.copy")
        self.assertIn("--damping=0.5", window.wait("copied", since)["text"])
        # Esc closes it without doing anything; letters meant for it are no commands.
        window.key("ctrl+k")
        window.place("panel.Palette")
        window.type("b")
        window.key("Escape")
        window.until("palette closed", lambda: "panel.Palette" not in window.items)
        self.assertEqual(window.frame()["theme"], "light")
        self.finish(window)

    def test_the_palette_prefers_words_and_has_every_list(self):
        window = self.small("--paused")
        for text, name in (("race", "layout race: one lane each"), ("layout cells", "layout cells: robots stay"),
                           ("turntable", "circle the group"), ("video", "panel Video"),
                           ("columns", "columns of the grid"), ("zoom out", "zoom out"), ("delete", "remove the selected robots"),
                           ("quality medium", "quality medium"), ("magma", "color map magma"), ("sea", "environment ocean"),
                           ("samples", "panel Browser"), ("help", "help: keys"), ("pause", "play or pause"),
                           ("robots begin radius", "robots begin: target radius"), ("gravity", "gravity"),
                           # The samples are made for water: the force solver would tear them apart there.
                           ("land", "environment land with XPBD")):
            self.assertEqual(self.palette(window, text)[:len(name)], name)
            answer = {"columns of the grid": "2", "robots begin: target radius": "0.5", "gravity": "0, 0, -0.5"}.get(name)
            if answer:
                window.dialog(answer)
            if name.startswith("layout cells"):
                window.frame(lambda frame: frame["layout"] == "cells")
            if name.startswith("help"):
                window.key("Escape")
        window.open("Tune")
        since = window.mark()
        window.click("tune.copy")
        command = window.wait("copied", since)["text"]
        for part in ("--target-radius=0.5", "--environment=land", "--solver=xpbd"):
            self.assertIn(part, command)
        self.finish(window)

    def test_where_words_are_found_letters_add_no_noise(self):
        window = self.small("--paused")
        for text, count in (("race", 1), ("gravity", 2)):  # gravity: the number and its arrows
            window.key("ctrl+k")
            window.place("panel.Palette")
            window.frame()
            window.type(text)
            window.until("few entries", lambda: f"palette.{count}" not in window.items and f"palette.{count - 1}" in window.items)
            window.key("Escape")
            window.until("palette closed", lambda: "panel.Palette" not in window.items)
        window.key("ctrl+k")  # letters find names of which nobody wrote a word
        window.place("panel.Palette")
        window.frame()
        since = window.mark()
        window.type("dplct")
        window.key("Return")
        self.assertEqual(window.wait("palette", since)["name"], "duplicate the selected robots")
        self.finish(window)

    def test_no_tooltip_covers_the_palette(self):
        window = self.small("--paused")
        x, y = window.place("tab.Tree")

        def beside():
            return window.pixels()[y - 10:y + 11, x + 30:x + 150]

        before = beside()
        window.do("mousemove", x, y)
        window.until("a tooltip", lambda: (beside() != before).any())
        window.key("ctrl+k")
        window.place("panel.Palette")
        window.until("no tooltip", lambda: (beside() == before).all())
        window.key("Escape")
        self.finish(window)

    def test_the_robot_that_is_looked_at_stays_in_view(self):
        """Cells are packed again for a fork and for two views; a camera that stands goes along."""
        window = self.open(*(str(SAMPLES / f"{name}.json") for name in ("eel", "fish", "ray", "squid", "turtle")), "--paused")
        self.names(window, 5)
        window.click("robot.4")
        window.key("f")
        window.until("the turtle alone", lambda: self.sees(window.standing(), window.items["view"], 4))
        window.key("i")
        window.place("second")
        frame = window.standing()
        self.assertTrue(self.sees(frame, window.items["view"], 4, half=True), frame["where"])
        window.key("i")
        window.until("one view", lambda: window.frame() and "second" not in window.items)
        window.key("y")
        self.names(window, 6)
        window.until("both", lambda: all(self.sees(window.standing(), window.items["view"], robot) for robot in (4, 5)))
        self.finish(window)

    @staticmethod
    def sees(frame, area, robot, half=False):
        """Whether the middle of a robot is in the view, or in its left half."""
        if len(frame["where"]) <= robot:
            return False
        x, y = frame["where"][robot]
        left = area["x"] - area["width"] / 2
        return left < x < left + area["width"] / (2 if half else 1) and abs(y - area["y"]) < area["height"] / 2

    def test_a_right_click_opens_a_menu_and_a_robot_is_renamed(self):
        window = self.small("--paused")
        x, y = self.still(window)[0]
        window.do("mousemove", round(x), round(y), "click", 3)
        window.click("robot_menu.Rename...")
        window.place("dialog.text")
        window.key("ctrl+a")
        window.dialog("aal")
        since = window.mark()
        window.key("ctrl+d")
        window.until("a copy", lambda: any(e["event"] == "robots" and e["names"] == ["aal", "fish", "aal-2"] for e in window.events[since:]))
        window.do("mousemove", *window.place("robot.1"), "click", 3)
        window.click("robot_menu.Remove")
        window.until("fish removed", lambda: any(e["event"] == "robots" and e["names"] == ["aal", "aal-2"] for e in window.events[since:]))
        self.finish(window)

    def test_a_box_selects_and_the_selection_is_inverted(self):
        window = self.open("--random", "voxel:6", "--seed", "2", "--paused", "--voxels", "2x2x2")
        self.names(window, 6)
        places = self.still(window)
        left = sorted(places)[:2]
        low = [min(p[i] for p in left) - 15 for i in (0, 1)]
        high = [max(p[i] for p in left) + 15 for i in (0, 1)]
        inside = sum(low[0] <= x <= high[0] and low[1] <= y <= high[1] for x, y in places)
        since = window.mark()
        window.drag(low, high, held=["Shift_L"])
        self.assertEqual(window.wait("box", since)["selected"], inside)
        window.key("ctrl+i")
        window.frame(lambda frame: frame["selected"] == 6 - inside)
        self.finish(window)

    def test_robots_are_searched_bred_and_the_best_are_kept(self):
        window = self.open("--random", "voxel:10", "--seed", "2", "--voxels", "2x2x2")
        self.names(window, 10)
        window.click("robots.search")
        window.type("2-7")
        window.until("one row", lambda: "robot.1" not in window.items)
        window.click("robot.0")
        window.frame(lambda frame: frame["selected"] == 1)
        window.click("robots.search")
        window.key("ctrl+a", "BackSpace")
        window.place("robot.3")
        window.click("robot.1")
        window.do("keydown", "Control_L")
        window.click("robot.3")
        window.do("keyup", "Control_L")
        window.frame(lambda frame: frame["selected"] == 2)
        window.click("breed")
        self.assertEqual(self.names(window, 11)[-1], "voxel-2-1-x")
        window.open("Ranking")
        window.click("ranking.keep")
        window.place("dialog.text")
        window.key("ctrl+a")
        window.dialog("4")
        self.names(window, 4)
        window.key("ctrl+z")
        window.until("all robots", lambda: window.events and [e for e in window.events if e["event"] == "robots"][-1]["count"] == 11)
        self.finish(window)

    def test_swimmers_survive_a_move_to_land_with_xpbd_and_one_undo_takes_them_back(self):
        window = self.small("--paused", surroundings=True)
        window.key("space")
        window.frame(lambda frame: frame["time"] > 0.5)
        window.open("Tune")
        window.click("tune.environment")
        window.click("tune.environment.xpbd")
        window.place("tune.hint")
        time = window.frame()["time"]
        window.frame(lambda frame: frame["time"] > time + 2)
        window.key("space")
        self.assertFalse([e for e in window.events if e["event"] == "exploded"])
        since = window.mark()
        window.click("tune.copy")
        command = window.wait("copied", since)["text"]
        self.assertIn("--environment=land", command)
        self.assertIn("--solver=xpbd", command)
        window.key("ctrl+z")
        window.until("no hint", lambda: "tune.hint" not in window.items)
        since = window.mark()
        window.click("tune.copy")
        command = window.wait("copied", since)["text"]
        self.assertNotIn("land", command)
        self.assertNotIn("xpbd", command)
        self.finish(window)

    def test_a_body_is_edited_in_place(self):
        window = self.open("--random", "voxel:1", "--seed", "2", "--paused", "--voxels", "2x2x2", "--air", "0")
        self.names(window, 1)
        x, y = map(round, self.still(window)[0])
        window.do("mousemove", x, y, "click", 1)
        window.frame(lambda frame: frame["selected"] == 1)
        window.key("ctrl+e")
        window.place("panel.BodyEdit")
        masses = []
        for tool in ("Add", "Paint", "Take away"):
            window.click(f"edit.{tool}")
            since = window.mark()
            window.do("mousemove", x, y)
            window.place("voxel_outline")
            window.do("click", 1)
            if tool != "Paint":  # which may paint what has the material already
                masses.append(window.wait("edited", since)["masses"])
        self.assertEqual(masses, [31, 27])
        window.key("Escape")
        window.until("no tools", lambda: "panel.BodyEdit" not in window.items)
        self.finish(window)

    def test_plots_zoom_and_grow(self):
        window = self.small()
        window.frame(lambda frame: frame["time"] > 1)
        window.key("space")
        window.frame(lambda frame: not frame["playing"])
        window.open("Measure")
        window.click("measure.large")
        window.place("panel.Plots")
        x, y = window.place("plot.speed")
        since = window.mark()
        window.do("mousemove", x, y)
        window.frame()
        window.do("click", 4)
        first = window.wait("plot", since)
        since = window.mark()
        window.do("click", 4)
        second = window.wait("plot", since)
        self.assertAlmostEqual((second["to"] - second["from"]) / (first["to"] - first["from"]), 0.8, delta=0.01)
        since = window.mark()
        window.do("click", "--repeat", 2, "--delay", 60, 1)
        window.wait("plot", since, lambda event: event["from"] is None)
        self.finish(window)

    def test_a_spring_stays_attached_until_it_is_removed(self):
        window = self.small("--paused")
        x, y = map(round, self.still(window)[0])
        since = window.mark()
        window.drag((x, y), (x + 80, y), held=["Control_L"], at_release=["Shift_L"])
        self.assertTrue(window.wait("pulled", since)["stays"])
        window.frame(lambda frame: frame["attached"] == 1)
        window.key("w")
        window.frame(lambda frame: frame["attached"] == 0)
        window.key("ctrl+z")
        window.frame(lambda frame: frame["attached"] == 1)
        # A scene file keeps it.
        since = window.mark()
        window.key("ctrl+s")
        window.dialog("held.toml")
        window.wait("saved", since)
        self.assertIn("attach = [", (self.folder / "held.toml").read_text())
        self.finish(window)
        window = self.open(str(self.folder / "held.toml"), "--paused")
        window.frame(lambda frame: frame["attached"] == 1)
        self.finish(window)


if __name__ == "__main__":
    main()
