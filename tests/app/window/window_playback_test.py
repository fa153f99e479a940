# SPDX-License-Identifier: Apache-2.0
"""Time, camera, perturbations and explosions in the real window: window_playback_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import json

from window_case import SAMPLES, WindowCase, main, numpy
from window_driver import SIZE, scratch


def robot_that_explodes(name):
    """A row of masses whose middle spring, number 3, is far too stiff for the time step."""
    masses = [[0.1 * i, 0, 0] for i in range(8)]
    springs = [[i, i + 1, 2 if i == 3 else 1, 0.098] for i in range(7)]
    materials = [{"stiffness": stiffness} for stiffness in (0, 50, 2.3e6)]
    return {"format": "mercury-robot", "version": 1, "name": name, "materials": materials, "masses": masses,
            "springs": springs, "faces": []}


class PlaybackTest(WindowCase):
    def test_opens_on_the_sample_robots_and_plays(self):
        window = self.open(surroundings=True)
        robots = window.wait("robots")
        self.assertIn("eel", robots["names"])
        self.assertGreaterEqual(robots["count"], 5)
        self.assertTrue(window.frame()["playing"])
        window.frame(lambda frame: frame["time"] > 0.05)
        window.key("space")
        steps = window.frame(lambda frame: not frame["playing"])["steps"]
        steps = window.frame()["steps"]  # a step that was in progress may have finished
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
        window.key(*["minus"] * 9)  # 1/1000 of real time: one step per second
        first = window.frame(lambda frame: frame["shown"] < frame["time"])
        second = window.frame(lambda frame: frame["steps"] > first["steps"] + 1)
        since, between = window.mark(), set()
        window.frame(lambda frame: frame["steps"] > second["steps"] + 2, since)
        for frame in window.events[since:]:
            if frame["event"] == "frame":
                self.assertLessEqual(frame["shown"], frame["time"])
                self.assertGreater(frame["shown"], frame["time"] - 0.0021)
                between.add(frame["shown"])
        self.assertGreater(len(between), 6)  # several pictures per step
        shown = [event["shown"] for event in window.events[since:] if event["event"] == "frame"]
        self.assertEqual(shown, sorted(shown))
        self.finish(window)

    def test_the_camera_turns_and_zooms(self):
        window = self.small("--paused")
        before = window.frame()
        x, y = window.place("view")
        window.drag(*((x + 8 * i, y + 150) for i in range(12)))
        turned = window.frame(lambda frame: abs(frame["azimuth"] - before["azimuth"]) > 0.1)
        window.do("click", 4)
        window.frame(lambda frame: frame["distance"] < 0.95 * turned["distance"])
        self.finish(window)

    def test_the_camera_stays_above_the_ground(self):
        window = self.small("--paused", "--environment", "land", surroundings=True)
        before = window.frame()
        x, y = window.place("view")
        for _ in range(3):
            window.drag((x, y + 150), (x, y), (x, y - 150))
        lowest = window.frame()
        self.assertLess(lowest["elevation"], before["elevation"] - 0.3)
        self.assertGreater(lowest["eye"][2], 0)
        self.finish(window)

    def test_a_dragged_mass_moves(self):
        window = self.small()
        window.frame(lambda frame: len(frame["where"]) == 2)
        window.key("minus", "minus", "minus")
        x, y = map(round, window.frame()["where"][0])
        window.hold((x, y), held=["Control_L"])
        pulled = window.wait("pull")
        for i in range(2, 20, 2):
            window.act("mousemove", x + 6 * i, y - 6 * i)
        time = window.frame()["time"]
        window.frame(lambda frame: frame["time"] > time + 0.15)
        window.do("mouseup", 1, "keyup", "Control_L")
        released = window.wait("pulled")
        self.assertGreater(released["force"], 1)
        moved = numpy.linalg.norm(numpy.subtract(released["at"], pulled["at"]))
        self.assertGreater(moved, 0.02)
        self.finish(window)

    def test_the_culprit_spring_of_an_explosion_is_marked(self):
        folder = scratch()
        for name in ("one", "two"):
            (folder / f"{name}.json").write_text(json.dumps(robot_that_explodes(name)))
        window = self.open(str(folder / "one.json"), str(folder / "two.json"), "--paused")
        window.frame(lambda frame: len(frame["where"]) == 2)
        yellow, magenta = numpy.array([255, 225, 74]) / 255, numpy.array([209, 0, 108]) / 255

        def marked(color, place, reach):
            """The number of pixels of a color within `reach` of an item (None: the middle), once the camera rests."""
            while (before := window.frame())["where"] != window.frame()["where"]:
                self.assertGreater(before["distance"], 0)
            x, y = window.place(place) if place else (SIZE[0] // 2, SIZE[1] // 2)
            near = window.screenshot()[max(0, y - reach):y + reach + 1, max(0, x - reach):x + reach + 1]
            return int((numpy.abs(near - color).max(axis=2) < 0.04).sum())

        self.assertEqual(marked(yellow, None, 400), 0)
        window.key("space")
        events = [window.wait("exploded", accept=lambda event, robot=robot: event["robot"] == robot) for robot in (1, 2)]
        self.assertEqual([event["spring"] for event in events], [3, 3])
        window.key("space")
        window.place("panel.Explosion")
        window.frame()  # the card has its final position
        area, ends = window.items["view"], ("explosion.a", "explosion.b")

        def show():
            window.click("explosion.show")
            window.until("the spring in the picture", lambda: all(
                abs(window.items[end]["x"] - area["x"]) < area["width"] / 2 and
                abs(window.items[end]["y"] - area["y"]) < area["height"] / 2 for end in ends))

        for _ in range(2):  # for each robot
            show()
            for end in ends:
                self.assertGreater(marked(yellow, end, 10), 60)
            window.click("explosion.next")
        show()
        window.key("b")
        window.frame()
        self.assertGreater(marked(magenta, "explosion.a", 10), 60)
        window.click("explosion.reset")
        window.until("the card gone", lambda: "panel.Explosion" not in window.items and "explosion.a" not in window.items)
        self.finish(window)


if __name__ == "__main__":
    main()
