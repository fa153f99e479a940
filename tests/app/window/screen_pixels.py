# SPDX-License-Identifier: Apache-2.0
"""Reads the pixels of an X display."""
import ctypes
import ctypes.util

import numpy


class Image(ctypes.Structure):
    """The start of Xlib's XImage."""
    _fields_ = [("width", ctypes.c_int), ("height", ctypes.c_int), ("xoffset", ctypes.c_int), ("format", ctypes.c_int),
                ("data", ctypes.c_void_p), ("byte_order", ctypes.c_int), ("bitmap_unit", ctypes.c_int),
                ("bitmap_bit_order", ctypes.c_int), ("bitmap_pad", ctypes.c_int), ("depth", ctypes.c_int),
                ("bytes_per_line", ctypes.c_int), ("bits_per_pixel", ctypes.c_int)]


def screen_pixels(name):
    x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
    for function in ("XOpenDisplay", "XGetImage"):
        getattr(x11, function).restype = ctypes.c_void_p
    x11.XDefaultRootWindow.restype = ctypes.c_ulong
    display = ctypes.c_void_p(x11.XOpenDisplay(name.encode()))
    screen = x11.XDefaultScreen(display)
    width, height = x11.XDisplayWidth(display, screen), x11.XDisplayHeight(display, screen)
    all_planes, z_pixmap = ctypes.c_ulong(-1), 2
    pointer = x11.XGetImage(display, ctypes.c_ulong(x11.XDefaultRootWindow(display)), 0, 0, width, height, all_planes, z_pixmap)
    image = ctypes.cast(pointer, ctypes.POINTER(Image)).contents
    assert image.bits_per_pixel == 32, "a display of 24 bits"
    rows = numpy.ctypeslib.as_array(ctypes.cast(image.data, ctypes.POINTER(ctypes.c_uint8)), (height, image.bytes_per_line))
    pixels = rows[:, :4 * width].reshape(height, width, 4)[:, :, 2::-1].copy()
    x11.XDestroyImage(ctypes.c_void_p(pointer)) if hasattr(x11, "XDestroyImage") else None
    x11.XCloseDisplay(display)
    return pixels
