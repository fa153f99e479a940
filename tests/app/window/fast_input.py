# SPDX-License-Identifier: Apache-2.0
"""Mouse and keyboard events through the XTEST extension, without a process per event as with xdotool.

The X server handles the requests of one connection in order, and those of several connections in any order: while it
waits for the delay of an event, it handles those of others. So whatever must happen between two events, such as a new
size of the window, has to go through the same connection.
"""
import ctypes
import ctypes.util

ON_ERROR = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
ignore = ON_ERROR(lambda display, error: 0)  # a window may have gone when its new size arrives


class FastInput:
    """Mouse and keyboard of a display, as fast as the X server accepts events. Counts the presses."""

    def __init__(self, display):
        self.x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self.xtest = ctypes.CDLL(ctypes.util.find_library("Xtst") or "libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XStringToKeysym.restype = ctypes.c_ulong
        self.x11.XDefaultRootWindow.restype = self.x11.XCreateSimpleWindow.restype = ctypes.c_ulong
        self.x11.XKeysymToKeycode.argtypes = [ctypes.c_void_p, ctypes.c_ulong]
        self.x11.XkbKeycodeToKeysym.restype = ctypes.c_ulong
        self.x11.XkbKeycodeToKeysym.argtypes = [ctypes.c_void_p, ctypes.c_ubyte, ctypes.c_uint, ctypes.c_uint]
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(display.name.encode()))
        if not self.display:
            raise RuntimeError(f"cannot open display {display.name}")
        self.x11.XSetErrorHandler(ignore)
        self.pressed = 0

    def close(self):
        self.x11.XCloseDisplay(self.display)

    def flush(self):
        self.x11.XFlush(self.display)

    def sync(self):
        """Returns when the server has handled all events."""
        self.x11.XSync(self.display, 0)

    def resize(self, window, width, height):
        """Between the events before and those after it. `window`: its number in the X server."""
        self.x11.XResizeWindow(self.display, ctypes.c_ulong(window), width, height)

    def cover(self, width, height):
        """Puts a black window over the top left corner of the display."""
        root = ctypes.c_ulong(self.x11.XDefaultRootWindow(self.display))
        self.cover_window = ctypes.c_ulong(self.x11.XCreateSimpleWindow(self.display, root, 0, 0, width, height, 0, 0, 0))
        self.x11.XMapRaised(self.display, self.cover_window)
        self.sync()

    def uncover(self):
        self.x11.XDestroyWindow(self.display, self.cover_window)
        self.sync()

    def move(self, x, y):
        self.xtest.XTestFakeMotionEvent(self.display, -1, x, y, 0)

    def button(self, number, down):
        self.xtest.XTestFakeButtonEvent(self.display, number, int(down), 0)
        self.pressed += bool(down)

    def click(self, number):
        self.button(number, True)
        self.button(number, False)

    def hold(self, key, down, after=0):
        """`after`: how long the server waits before this event [ms]."""
        code = self.x11.XKeysymToKeycode(self.display, self.x11.XStringToKeysym(key.encode()))
        assert code, f"no key {key}"
        # GLFW drops a second press of a key within the same millisecond.
        self.xtest.XTestFakeKeyEvent(self.display, code, int(down), max(after, 2) if down else after)
        self.pressed += bool(down)

    def key(self, name, after=0):
        """ "a", "plus", "ctrl+z"; `after`: how long the server waits before it [ms]."""
        *held, key = name.split("+")
        held = [{"ctrl": "Control_L", "shift": "Shift_L"}[name] for name in held]
        symbol = self.x11.XStringToKeysym(key.encode())
        code = self.x11.XKeysymToKeycode(self.display, symbol)
        if self.x11.XkbKeycodeToKeysym(self.display, code, 0, 0) != symbol and "Shift_L" not in held:
            held.append("Shift_L")
        for pressed in [*held, key]:
            self.hold(pressed, True, after)
            after = 0
        self.hold(key, False)
        for modifier in reversed(held):
            self.hold(modifier, False)
