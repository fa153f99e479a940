# SPDX-License-Identifier: Apache-2.0
"""A window of `mercury view` on a display of its own, driven by real mouse and key events.

What happened is read from the file that --report writes; nothing waits for a fixed time, everything for a deadline.
"""
import ctypes
import ctypes.util
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PATIENCE = 60  # seconds until something that does not happen is a failure


class Display:
    """An X server without a screen."""

    def __init__(self, width=1280, height=720):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp", "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        with os.fdopen(read) as numbers:
            self.name = ":" + numbers.readline().strip()
        if self.name == ":":
            raise RuntimeError("Xvfb did not start")

    def close(self):
        self.server.terminate()
        self.server.wait()


class Fingers:
    """Mouse and keyboard of a display, as quick as the display takes them: counts what they press."""

    def __init__(self, display):
        self.x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self.xtest = ctypes.CDLL(ctypes.util.find_library("Xtst") or "libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XStringToKeysym.restype = ctypes.c_ulong
        self.x11.XKeysymToKeycode.argtypes = [ctypes.c_void_p, ctypes.c_ulong]
        self.x11.XkbKeycodeToKeysym.restype = ctypes.c_ulong
        self.x11.XkbKeycodeToKeysym.argtypes = [ctypes.c_void_p, ctypes.c_ubyte, ctypes.c_uint, ctypes.c_uint]
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(display.name.encode()))
        if not self.display:
            raise RuntimeError(f"no display {display.name}")
        self.pressed = 0

    def close(self):
        self.x11.XCloseDisplay(self.display)

    def flush(self):
        self.x11.XFlush(self.display)

    def move(self, x, y):
        self.xtest.XTestFakeMotionEvent(self.display, -1, x, y, 0)

    def button(self, number, down):
        self.xtest.XTestFakeButtonEvent(self.display, number, int(down), 0)
        self.pressed += bool(down)

    def click(self, number):
        self.button(number, True)
        self.button(number, False)

    def hold(self, key, down):
        code = self.x11.XKeysymToKeycode(self.display, self.x11.XStringToKeysym(key.encode()))
        assert code, f"no key {key}"
        # GLFW takes two presses of a key in the same millisecond for one that came twice.
        self.xtest.XTestFakeKeyEvent(self.display, code, int(down), 2 if down else 0)
        self.pressed += bool(down)

    def key(self, name):
        """ "a", "plus", "ctrl+z" """
        *held, key = name.split("+")
        held = [{"ctrl": "Control_L", "shift": "Shift_L"}[name] for name in held]
        symbol = self.x11.XStringToKeysym(key.encode())
        code = self.x11.XKeysymToKeycode(self.display, symbol)
        if self.x11.XkbKeycodeToKeysym(self.display, code, 0, 0) != symbol and "Shift_L" not in held:
            held.append("Shift_L")
        for modifier in held:
            self.hold(modifier, True)
        self.hold(key, True)
        self.hold(key, False)
        for modifier in reversed(held):
            self.hold(modifier, False)


class Window:
    def __init__(self, program, display, folder, *arguments, size="1280x720"):
        self.folder = Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)
        self.report = self.folder / "report.jsonl"
        self.report.unlink(missing_ok=True)
        self.environment = dict(os.environ, DISPLAY=display.name, HOME=str(self.folder),
                                XDG_CONFIG_HOME=str(self.folder / "config"), LIBGL_ALWAYS_SOFTWARE="1")
        self.environment.pop("WAYLAND_DISPLAY", None)
        self.messages = open(self.folder / "messages", "w+")
        self.process = subprocess.Popen(
            [program, "view", "--device", "cpu", "--quality", "low", "--size", size, "--report", str(self.report), *arguments],
            cwd=self.folder, env=self.environment, stderr=self.messages)
        self.items, self.events, self.offset, self.rest = {}, [], 0, ""
        try:
            self.wait("ready")
        except BaseException:
            self.process.kill()
            self.process.wait()
            raise

    # What happened.

    def look(self):
        """Reads what was reported since the last look."""
        if not self.report.exists():
            return
        with open(self.report) as file:
            file.seek(self.offset)
            text = self.rest + file.read()
            self.offset = file.tell()
        *lines, self.rest = text.split("\n")
        for line in lines:
            event = json.loads(line)
            if event["event"] == "item":
                self.items[event["name"]] = event
            elif event["event"] == "gone":
                self.items.pop(event["name"], None)
            else:
                self.events.append(event)

    def until(self, what, found, may_end=False):
        deadline = time.monotonic() + PATIENCE
        while True:
            self.look()
            if result := found():
                return result
            if self.process.poll() is not None and not may_end:
                raise AssertionError(f"the window ended with {self.process.returncode} before {what}: {self.said()}")
            if time.monotonic() > deadline:
                raise AssertionError(f"no {what}; last: {self.events[-3:]}")
            time.sleep(0.02)

    def mark(self):
        """The number of events so far: later ones are those from there on."""
        self.look()
        return len(self.events)

    def wait(self, event, since=0, accept=lambda event: True):
        return self.until(f"{event} event", lambda: next(
            (e for e in self.events[since:] if e["event"] == event and accept(e)), None))

    def frame(self, accept=lambda frame: True, since=None):
        """The next frame told of, or the next that is accepted."""
        return self.wait("frame", self.mark() if since is None else since, accept)

    def pressed(self):
        """Buttons and keys that it has taken in, by the last frame told of."""
        self.look()
        return next((event["input"] for event in reversed(self.events) if event["event"] == "frame"), 0)

    def said(self):
        return Path(self.messages.name).read_text()

    # What is done.

    def do(self, *commands):
        subprocess.run(["xdotool", *map(str, commands)], env=self.environment, check=True, stdout=subprocess.DEVNULL)

    def script(self, lines):
        """Many commands by one process, as fast as the display takes them."""
        subprocess.run(["xdotool", "-"], input="\n".join(lines) + "\n", text=True, env=self.environment, check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def place(self, item):
        self.until(f"item {item}", lambda: item in self.items)
        return round(self.items[item]["x"]), round(self.items[item]["y"])

    def click(self, item):
        # What has just opened may still find its place.
        place = None
        while place != (place := self.place(item)):
            self.do("mousemove", *place)
            self.frame()
        self.do("click", 1)
        # A press and a release take a frame each, and what they do is seen in the next one.
        self.frame()
        self.frame()

    def choose_next(self, combo):
        """Of a list that a click opened below its field, the entry after the first."""
        x, y = self.place(combo)
        self.do("mousemove", x, y + 1.9 * self.items[combo]["height"])
        self.frame()
        self.do("click", 1)
        self.frame()

    def dialog(self, text):
        """Types into the question that is open, and accepts."""
        self.place("dialog.text")
        self.frame()  # it has the keyboard by then
        self.type(text)
        self.key("Return")

    def key(self, *keys):
        self.do("key", "--delay", "30", *keys)

    def type(self, text):
        self.do("type", "--delay", "25", text)

    def drop(self, *paths):
        """Files and folders, dropped on the middle of the picture as a file manager does."""
        found = subprocess.run(["xdotool", "search", "--class", "mercury"], env=self.environment, check=True,
                               capture_output=True, text=True).stdout.split()
        x, y = self.place("picture")
        subprocess.run([sys.executable, "-B", str(Path(__file__).with_name("drop_files.py")), found[-1], str(x), str(y),
                        *map(str, paths)], env=self.environment, check=True)

    def screenshot(self):
        """The window as a picture: height x width x 3, 0 to 1."""
        import matplotlib.image
        since = self.mark()
        self.key("F2")
        return matplotlib.image.imread(self.wait("screenshot", since)["file"])[:, :, :3]

    def complaints(self):
        self.look()
        return [event["text"] for event in self.events if event["event"] == "gl"]

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.messages.close()

    def close(self):
        """Quits, whatever would be lost; the exit status."""
        if self.process.poll() is None:
            since = self.mark()
            self.key("ctrl+q")
            try:
                self.until("end", lambda: self.process.poll() is not None or any(e["event"] == "asks" for e in self.events[since:]),
                           may_end=True)
                if self.process.poll() is None:
                    self.key("Return")
                self.process.wait(PATIENCE)
            except (AssertionError, subprocess.TimeoutExpired):
                self.process.kill()
                self.process.wait()
        self.messages.close()
        return self.process.returncode


def scratch():
    """A folder that is removed at the end."""
    folder = tempfile.mkdtemp(prefix="mercury-window-")
    import atexit
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


if __name__ == "__main__":
    sys.exit("run window_test.py")
