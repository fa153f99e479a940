# SPDX-License-Identifier: Apache-2.0
"""The real window under random input: window_random_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import itertools
import os
import random
import shutil
import subprocess

from fast_input import FastInput
from window_case import PROGRAM, SAMPLES, WindowCase, main
from window_driver import Display, Window, scratch

SEEDS = [int(seed) for seed in os.environ.get("MERCURY_WINDOW_SEEDS", "4").split(",")]
PRESSES = int(os.environ.get("MERCURY_WINDOW_PRESSES", "2000"))


class RandomInputTest(WindowCase):
    def test_random_input_does_not_end_the_window(self):
        """Random buttons and keys, with tooltips, dialogs, the quit question and new sizes of the window; no press is lost."""
        for seed in SEEDS:
            with self.subTest(seed=seed):
                RandomUser(self, seed).play(PRESSES)


    def test_a_dialog_that_opens_together_with_a_tooltip(self):
        """The tooltip of a robot appears a quarter of a second after the mouse came to rest on it."""
        user = RandomUser(self, SEEDS[0])
        window = user.open()
        since = window.mark()
        window.key("space")  # robots that hold still
        x, y = window.frame(lambda frame: not frame["playing"] and frame["where"], since)["where"][0]
        for trial, key in zip(range(15), itertools.cycle(["ctrl+o", "ctrl+s", "F1"])):
            user.input.move(round(x) + trial % 2, round(y))
            user.input.key(key, after=user.chance.randrange(210, 330))
            user.input.key("Escape", after=200)
            user.input.flush()
            user.wait(window, 0)
            self.assertIsNone(window.process.poll(), f"{key}, trial {trial}: {window.stderr()}")
        self.assertEqual(window.gl_messages(), [])


class RandomUser:
    """Clicks, drags and types at random in a small window. A failure names the seed and the last actions."""

    KEYS = ["space", "period", "Right", "plus", "minus", "asterisk", "0", "f", "r", "n", "d", "h", "s", "l", "k", "b", "t", "z",
            "g", "m", "p", "v", "1", "2", "3", "4", "5", "6", "7", "8", "9", "F1", "question", "Escape", "Escape", "Delete",
            "BackSpace", "ctrl+z", "ctrl+y", "ctrl+a", "ctrl+o", "ctrl+s", "Tab", "Return", "Up", "Down", "Left", "Home",
            "Next", "e", "l", "bracketleft", "bracketright", "ctrl+k", "ctrl+i", "ctrl+e", "ctrl+r", "ctrl+plus", "ctrl+minus",
            "x", "u", "o", "y", "w", "End", "c", "F5", "shift+F5", "a", "i"]  # no slash: a path could leave the scratch folder
    MODAL = ["ctrl+o", "ctrl+s", "ctrl+q", "ctrl+k", "F1", "e", "Escape"]
    SIZE = (640, 400)
    # The last three are smaller than window managers allow.
    SIZES = [SIZE, SIZE, SIZE, (1100, 600), (1280, 720), (320, 200), (640, 90), (200, 400)]
    AHEAD = 100  # presses that may wait in the window's queue

    def __init__(self, test, seed):
        self.test, self.seed, self.chance, self.last = test, seed, random.Random(seed), []
        self.display = Display(*map(max, *self.SIZES))
        test.addCleanup(self.display.close)
        self.input = FastInput(self.display)

    def open(self):
        # Many folders deep, so that files stay in the scratch folder however often "Up" is pressed.
        self.top = scratch()
        folder = self.top.joinpath(*["down"] * 400)
        folder.mkdir(parents=True)
        robots = [str(shutil.copy(SAMPLES / name, folder)) for name in ("eel.json", "fish.json")]  # copies: saving may replace them
        window = Window(PROGRAM, self.display, folder, *robots, "--fresh", size="x".join(map(str, self.SIZE)),
                        surroundings=True)
        self.test.addCleanup(window.kill)
        self.size, self.input.pressed = self.SIZE, 0
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--class", "mercury"], env=window.environment,
                               check=True, capture_output=True, text=True).stdout.split()
        self.x_window = int(found[-1])
        return window

    def play(self, presses):
        handled, window = 0, self.open()
        try:
            while handled + self.input.pressed < presses:
                for _ in range(20):
                    self.act()
                self.input.flush()
                self.wait(window, self.AHEAD)
                if self.has_quit(window):
                    handled += self.input.pressed
                    window = self.open()
            self.wait(window, 0)
            if not self.has_quit(window):
                self.test.assertEqual(window.pressed(), self.input.pressed)
                self.test.assertEqual(window.gl_messages(), [])
            for depth in range(100):
                self.test.assertEqual(os.listdir(self.top.joinpath(*["down"] * depth)), ["down"], "a file was saved near the root")
        except AssertionError as failure:
            raise AssertionError(f"seed {self.seed}, last actions: {self.last[-60:]}\n{window.stderr()}") from failure
        finally:
            window.kill()

    def has_quit(self, window):
        """Whether "Quit" in the menu, or Ctrl Q, has ended the window as it should."""
        if window.process.poll() is None:
            return False
        self.test.assertEqual(window.process.returncode, 0)
        self.test.assertEqual(window.gl_messages(), [])
        self.input.sync()  # the next window would receive the rest
        return True

    def wait(self, window, ahead):
        """Waits until at most `ahead` presses are unhandled, or the window quits."""
        window.until("presses handled", lambda: window.process.poll() is not None or window.pressed() >= self.input.pressed - ahead,
                     may_end=True)

    def act(self):
        chance, device = self.chance, self.input
        kind = chance.random()
        if kind < 0.45:
            self.note("click", *self.go(), button := chance.choice([1, 1, 1, 1, 1, 3, 4, 5]))
            device.click(button)
        elif kind < 0.5:
            self.note("double click", *self.go())
            device.click(1)
            device.click(1)
        elif kind < 0.65:
            self.note("drag from", *self.go())
            device.button(button := chance.choice([1, 1, 1, 3]), True)
            self.note("to", *self.go())
            device.button(button, False)
        elif kind < 0.7:
            device.hold(held := chance.choice(["Control_L", "Shift_L"]), True)
            self.note(held, "drag from", *self.go())
            device.button(1, True)
            self.note("to", *self.go())
            device.button(1, False)
            device.hold(held, False)
        elif kind < 0.72:
            self.note("rest", *self.go(), "then", key := chance.choice(self.MODAL))  # a tooltip is about to open
            device.key(key, after=chance.randrange(200, 330))
        elif kind < 0.73:
            self.size = chance.choice(self.SIZES)
            self.note("resize", *self.size)
            device.resize(self.x_window, *self.size)
            self.go()  # a press outside the window would not be for the window
        else:
            self.note("key", key := chance.choice(self.KEYS))
            device.key(key)

    def go(self):
        x, y = map(self.chance.randrange, self.size)
        self.input.move(x, y)
        return x, y

    def note(self, *what):
        self.last.append(" ".join(map(str, what)))


if __name__ == "__main__":
    main()
