# SPDX-License-Identifier: Apache-2.0
"""Drops files on a window as a file manager does: the source's side of the X drag-and-drop protocol (XDND, version 5).

drop_files.py WINDOW X Y PATH... with the number of the X window and a position in it. Needs only libX11.
"""
import ctypes
import sys
import time
from ctypes import c_char_p, c_int, c_long, c_ubyte, c_ulong, c_void_p
from pathlib import Path

DEADLINE = 30  # seconds
CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31
SOURCE_VERSION = 5

HEAD = [("type", c_int), ("serial", c_ulong), ("send_event", c_int), ("display", c_void_p)]


class ClientMessage(ctypes.Structure):
    _fields_ = HEAD + [("window", c_ulong), ("message_type", c_ulong), ("format", c_int), ("data", c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = HEAD + [("owner", c_ulong), ("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong),
                       ("property", c_ulong), ("time", c_ulong)]


class SelectionNotify(ctypes.Structure):
    _fields_ = HEAD + [("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong),
                       ("time", c_ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", c_int), ("client", ClientMessage), ("request", SelectionRequest), ("notify", SelectionNotify),
                ("pad", c_long * 24)]


def library():
    x11 = ctypes.CDLL("libX11.so.6")
    for name, result, *arguments in [
            ("XOpenDisplay", c_void_p, c_char_p),
            ("XDefaultRootWindow", c_ulong, c_void_p),
            ("XCreateSimpleWindow", c_ulong, c_void_p, c_ulong, c_int, c_int, c_int, c_int, c_int, c_ulong, c_ulong),
            ("XInternAtom", c_ulong, c_void_p, c_char_p, c_int),
            ("XSetSelectionOwner", c_int, c_void_p, c_ulong, c_ulong, c_ulong),
            ("XSendEvent", c_int, c_void_p, c_ulong, c_int, c_long, c_void_p),
            ("XChangeProperty", c_int, c_void_p, c_ulong, c_ulong, c_ulong, c_int, c_int, c_void_p, c_int),
            ("XTranslateCoordinates", c_int, c_void_p, c_ulong, c_ulong, c_int, c_int, c_void_p, c_void_p, c_void_p),
            ("XPending", c_int, c_void_p), ("XNextEvent", c_int, c_void_p, c_void_p), ("XFlush", c_int, c_void_p),
            ("XCloseDisplay", c_int, c_void_p)]:
        function = getattr(x11, name)
        function.restype, function.argtypes = result, arguments
    return x11


class Source:
    def __init__(self):
        self.x11 = library()
        self.display = self.x11.XOpenDisplay(None)
        if not self.display:
            raise RuntimeError("no display")
        self.root = self.x11.XDefaultRootWindow(self.display)
        self.window = self.x11.XCreateSimpleWindow(self.display, self.root, 0, 0, 1, 1, 0, 0, 0)

    def atom(self, name):
        return self.x11.XInternAtom(self.display, name.encode(), 0)

    def send(self, target, message, *data):
        event = Event()
        event.client = ClientMessage(type=CLIENT_MESSAGE, window=target, message_type=self.atom(message), format=32,
                                     data=(c_long * 5)(self.window, *data))
        self.x11.XSendEvent(self.display, target, 0, 0, ctypes.byref(event))
        self.x11.XFlush(self.display)

    def until(self, message, content):
        """Answers requests for the files until a message arrives, and returns the data of that message."""
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline:
            while self.x11.XPending(self.display):
                event = Event()
                self.x11.XNextEvent(self.display, ctypes.byref(event))
                if event.type == SELECTION_REQUEST:
                    self.give(event.request, content)
                elif event.type == CLIENT_MESSAGE and event.client.message_type == self.atom(message):
                    return list(event.client.data)
            time.sleep(0.01)
        raise RuntimeError(f"{message} did not arrive")

    def give(self, request, content):
        bytes_ = (c_ubyte * len(content)).from_buffer_copy(content)
        self.x11.XChangeProperty(self.display, request.requestor, request.property, request.target, 8, 0, bytes_, len(content))
        event = Event()
        event.notify = SelectionNotify(type=SELECTION_NOTIFY, requestor=request.requestor, selection=request.selection,
                                       target=request.target, property=request.property, time=request.time)
        self.x11.XSendEvent(self.display, request.requestor, 0, 0, ctypes.byref(event))
        self.x11.XFlush(self.display)

    def drop(self, target, x, y, paths):
        content = "".join(Path(path).absolute().as_uri() + "\r\n" for path in paths).encode()
        root_x, root_y, child = c_int(), c_int(), c_ulong()
        self.x11.XTranslateCoordinates(self.display, target, self.root, x, y, ctypes.byref(root_x), ctypes.byref(root_y),
                                       ctypes.byref(child))
        self.x11.XSetSelectionOwner(self.display, self.atom("XdndSelection"), self.window, 0)
        self.send(target, "XdndEnter", SOURCE_VERSION << 24, self.atom("text/uri-list"), 0, 0)
        self.send(target, "XdndPosition", 0, root_x.value << 16 | root_y.value, 0, self.atom("XdndActionCopy"))
        if not self.until("XdndStatus", content)[1] & 1:
            raise RuntimeError("the window refuses files")
        self.send(target, "XdndDrop", 0, 0, 0, 0)
        # The protocol sets one bit on success; GLFW 3.3 sends the number of bytes instead.
        if not self.until("XdndFinished", content)[1]:
            raise RuntimeError("the window did not take the files")
        self.x11.XCloseDisplay(self.display)


if __name__ == "__main__":
    Source().drop(int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]), sys.argv[4:])
