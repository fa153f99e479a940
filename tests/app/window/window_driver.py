# SPDX-License-Identifier: Apache-2.0
"""A window of `mercury view` on a display of its own, driven by real mouse and key events.

The tests read what happened from the file that --report writes. They never sleep for a fixed time: they poll until
something happens or a deadline passes.
"""
import atexit
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

DEADLINE = 60  # seconds
SIZE = (1280, 720)  # pixels of a window
APART = 8  # pixels between clicks that are no double click, for which ImGui allows 6


class Display:
    """An X server without a screen."""

    def __init__(self, width=SIZE[0], height=SIZE[1]):
        self.size = width, height
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as numbers:
            self.name = ":" + numbers.readline().strip()
        if self.name == ":":
            raise RuntimeError("Xvfb did not start")

    def release(self):
        """Leaves mouse and keys as they were at the start, also if a test failed while it held them."""
        subprocess.run(["xdotool", "keyup", "Control_L", "keyup", "Shift_L", "keyup", "Alt_L", "mouseup", "1", "mouseup", "3",
                        "mousemove", str(self.size[0] // 2), str(self.size[1] // 2)],
                       env=dict(os.environ, DISPLAY=self.name), check=True)

    def close(self):
        self.server.terminate()
        self.server.wait()


class Window:
    """`surroundings`: with the water or the land around robots, which take a third of the drawing."""

    def __init__(self, program, display, folder, *arguments, size="{}x{}".format(*SIZE), first_start=False, surroundings=False,
                 quality="low"):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.report = self.folder / "report.jsonl"
        self.report.unlink(missing_ok=True)
        self.environment = dict(os.environ, DISPLAY=display.name, HOME=str(self.folder),
                                XDG_CONFIG_HOME=str(self.folder / "config"), LIBGL_ALWAYS_SOFTWARE="1")
        self.environment.pop("WAYLAND_DISPLAY", None)
        settings = self.folder / "config" / "mercury" / "window.json"
        if not first_start and not settings.exists():  # both columns open
            settings.parent.mkdir(parents=True, exist_ok=True)
            settings.write_text('{"right_open": true}')
        self.messages = open(self.folder / "messages", "w+")
        self.process = subprocess.Popen(
            [program, "view", "--device", "cpu", "--quality", quality, "--size", size, "--report", str(self.report),
             *([] if first_start or surroundings else ["--plain"]), *arguments],
            cwd=self.folder, env=self.environment, stderr=self.messages)
        self.items, self.events, self.file, self.rest = {}, [], None, ""
        self.frames = 0  # frame events read
        self.clicked = -APART, -APART  # place of the last click
        try:
            self.wait("ready")
        except BaseException:
            self.process.kill()
            self.process.wait()
            raise

    # What happens in the window.

    def read_report(self):
        """Reads the new lines of the report."""
        if self.file is None and self.report.exists():
            self.file = open(self.report)
        if self.file is None or self.file.closed:
            return
        *lines, self.rest = (self.rest + self.file.read()).split("\n")
        for line in lines:
            event = json.loads(line)
            if event["event"] == "item":
                self.items[event["name"]] = dict(event, frames=self.frames)
            elif event["event"] == "gone":
                self.items.pop(event["name"], None)
            else:
                self.frames += event["event"] == "frame"
                self.events.append(event)

    def until(self, what, found, may_end=False):
        deadline = time.monotonic() + DEADLINE
        while True:
            self.read_report()
            if result := found():
                return result
            if self.process.poll() is not None and not may_end:
                raise AssertionError(f"the window ended with {self.process.returncode} before {what}: {self.stderr()}")
            if time.monotonic() > deadline:
                raise AssertionError(f"no {what}; last: {self.events[-3:]}")
            time.sleep(0.02)

    def mark(self):
        """The number of events so far, for the `since` of wait() and frame()."""
        self.read_report()
        return len(self.events)

    def wait(self, event, since=0, accept=lambda event: True):
        return self.until(f"{event} event", lambda: next(
            (e for e in self.events[since:] if e["event"] == event and accept(e)), None))

    def frame(self, accept=lambda frame: True, since=None):
        """The next frame event that `accept` accepts."""
        return self.wait("frame", self.mark() if since is None else since, accept)

    def standing(self):
        """The next frame in which the camera is where it was in the frame before."""
        before = self.frame()
        while (frame := self.frame())["eye"] != before["eye"]:
            before = frame
        return frame

    def pressed(self):
        """The number of presses that the window has handled, as of the last frame event."""
        self.read_report()
        return next((event["input"] for event in reversed(self.events) if event["event"] == "frame"), 0)

    def stderr(self):
        return Path(self.messages.name).read_text()

    # What the user does.

    def do(self, *commands):
        subprocess.run(["xdotool", *map(str, commands)], env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def place(self, item):
        """Where an item is, once it has stood there for a whole frame: a menu's first frame is hidden and takes no click."""
        self.until(f"item {item}", lambda: item in self.items and self.frames >= self.items[item]["frames"] + 2)
        return round(self.items[item]["x"]), round(self.items[item]["y"])

    def open(self, panel):
        """Opens a panel by its icon, which would close an open one."""
        self.frame()
        if f"panel.{panel}" not in self.items:
            self.click(f"tab.{panel}")

    def click(self, item, button=1):
        # An item that has just opened may still move.
        place = None
        while place != (place := self.place(item)):
            self.do("mousemove", *place)
            self.frame()
        # Too far from the last click to be the second of a double click, for which slow frames leave more time.
        if max(abs(place[0] - self.clicked[0]), abs(place[1] - self.clicked[1])) < APART:
            place = place[0] + (-APART if place[0] < self.clicked[0] else APART), place[1]
            self.do("mousemove", *place)
            self.frame()
        self.do("click", button)
        # Press and release take one frame each; their effect shows in the next one.
        self.frame()
        self.frame()
        self.clicked = place

    def drag(self, *places, held=(), at_release=()):
        """Drags the left button along places, with keys held; each action waits until the window has drawn what it did."""
        self.hold(*places, held=held)
        for key in at_release:
            self.act("keydown", key)
        self.act("mouseup", 1)
        for key in (*at_release, *held):
            self.act("keyup", key)

    def hold(self, *places, held=()):
        """The beginning of a drag: the button stays down."""
        self.act("mousemove", *map(round, places[0]))
        for key in held:
            self.act("keydown", key)
        self.act("mousedown", 1)
        for place in places[1:]:
            self.act("mousemove", *map(round, place))

    def act(self, *command):
        self.do(*command)
        self.frame()  # begun before the command, perhaps
        self.frame()

    def choose_next(self, combo):
        """Chooses the second entry of a list that a click has opened."""
        self.choose(combo, 1)

    def choose(self, combo, entry):
        """Chooses an entry of an open list, 0 being the first."""
        x, y = self.place(combo)
        self.do("mousemove", x, y + (1.01 + 0.89 * entry) * self.items[combo]["height"])
        self.frame()
        self.do("click", 1)
        self.frame()
        self.frame()  # as in click(): the list would take the next click while it is open

    def dialog(self, text):
        """Types into the open dialog, accepts it and waits for the answer: it closes, another one opens, or it objects."""
        field = None
        while field is None:  # not that of a dialog that is about to close
            self.place("dialog.text")
            self.frame()  # it has the keyboard focus now
            field = self.items.get("dialog.text")
        since = self.mark()
        self.type(text)
        self.key("Return")
        self.until("answer of the dialog", lambda: self.items.get("dialog.text") is not field or any(
            event["event"] in ("asks", "message") for event in self.events[since:]))

    def key(self, *keys):
        self.do("key", "--delay", "30", *keys)

    def type(self, text):
        self.do("type", "--delay", "25", text)

    def drop(self, *paths):
        """Drops files and folders on the middle of the picture, as a file manager does."""
        found = subprocess.run(["xdotool", "search", "--class", "mercury"], env=self.environment, check=True,
                               capture_output=True, text=True).stdout.split()
        x, y = self.place("view")
        subprocess.run([sys.executable, "-B", str(Path(__file__).with_name("drop_files.py")), found[-1], str(x), str(y),
                        *map(str, paths)], env=self.environment, check=True)

    def pixels(self):
        """What the display shows now: height x width x 3, values 0 to 255. Unlike screenshot(), with signs over the picture."""
        from screen_pixels import screen_pixels
        return screen_pixels(self.environment["DISPLAY"])

    def screenshot(self):
        """An array of the window's pixels: height x width x 3, values 0 to 1."""
        import numpy
        import PIL.Image
        since = self.mark()
        self.key("F2")
        picture = PIL.Image.open(self.wait("screenshot", since)["file"]).convert("RGB")
        return numpy.asarray(picture, numpy.float32) / 255

    def gl_messages(self):
        """Messages of OpenGL, of which there should be none."""
        self.read_report()
        return [event["text"] for event in self.events if event["event"] == "gl"]

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.close_files()

    def close_files(self):
        self.messages.close()
        self.read_report()
        if self.file:
            self.file.close()

    def close(self):
        """Quits without saving. Returns the exit status."""
        if self.process.poll() is None:
            since = self.mark()
            self.key("ctrl+q")
            try:
                self.until("end", lambda: self.process.poll() is not None or any(e["event"] == "asks" for e in self.events[since:]),
                           may_end=True)
                if self.process.poll() is None:
                    self.key("Return")
                self.process.wait(DEADLINE)
            except (AssertionError, subprocess.TimeoutExpired):
                self.process.kill()
                self.process.wait()
        self.close_files()
        return self.process.returncode


def scratch():
    """A temporary folder that is removed when the test program ends."""
    folder = tempfile.mkdtemp(prefix="mercury-window-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)
