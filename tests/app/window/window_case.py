# SPDX-License-Identifier: Apache-2.0
"""The base of tests that start the real window and drive it with mouse and keys.

A test file calls main() and is run as FILE PROGRAM SAMPLE-FOLDER [TEST...]: the program `mercury`, robots/library/paper, and
the names of cases. It exits with SKIPPED if the machine lacks a tool that the tests need.
"""
import importlib.util
import shutil
import sys
import unittest
from pathlib import Path

SKIPPED = 77  # the exit status that ctest counts as "not run"
MISSING = [name for name in ("Xvfb", "xdotool") if shutil.which(name) is None]
MISSING += [f"python3-{name.lower()}" for name in ("numpy", "PIL") if importlib.util.find_spec(name) is None]
if MISSING:
    print("skipped: this machine has no", ", ".join(MISSING))
    sys.exit(SKIPPED)

import numpy  # noqa: E402, F401: for the test files, which import it from here after the check above

from window_driver import Display, Window, scratch  # noqa: E402

PROGRAM, SAMPLES = sys.argv[1], Path(sys.argv[2])


class WindowCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.display = Display()

    @classmethod
    def tearDownClass(cls):
        cls.display.close()

    def setUp(self):
        self.display.release()

    def open(self, *arguments, **how):
        """A window in a folder of its own. `how`: as of Window()."""
        self.folder = scratch()
        return self.window_in(self.folder, *arguments, **how)

    def window_in(self, folder, *arguments, **how):
        window = Window(PROGRAM, self.display, folder, *arguments, **how)
        self.addCleanup(window.close)
        return window

    def small(self, *arguments, **how):
        """A window with two small robots, which open and step quickly."""
        return self.open(str(SAMPLES / "eel.json"), str(SAMPLES / "fish.json"), *arguments, **how)

    def finish(self, window):
        """Closes the window; it must exit with 0 and without OpenGL messages."""
        status = window.close()
        self.assertEqual(status, 0, window.stderr())
        self.assertEqual(window.gl_messages(), [])


def main():
    result = unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2, exit=False).result
    skipped = result.skipped and len(result.skipped) == result.testsRun
    sys.exit(not result.wasSuccessful() or SKIPPED * bool(skipped))
