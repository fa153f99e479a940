# SPDX-License-Identifier: Apache-2.0
"""Messages, columns, keys and other tools of the real window: window_tools_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
from window_case import PROGRAM, SAMPLES, WindowCase, main
from window_driver import Window, scratch


class ToolsTest(WindowCase):
    def test_messages_are_kept_and_can_be_copied(self):
        window = self.small("--paused")
        for name in ("first.json", "second.json"):
            (self.folder / name).write_text("{}")
            since = window.mark()
            window.drop(self.folder / name)
            window.wait("message", since, lambda event: event["tone"] == "error")
        window.click("toast.0")
        window.place("panel.Messages")
        since = window.mark()
        window.click("messages.copy")
        lines = window.wait("copied", since)["text"].splitlines()
        self.assertEqual(len(lines), 2)
        for line, name in zip(lines, ("first.json", "second.json")):
            self.assertRegex(line, rf"^\d\d:\d\d:\d\d  error  .*{name}")
        since = window.mark()
        window.click("message.1")
        self.assertEqual(window.wait("copied", since)["text"], lines[1])
        window.click("messages.Warnings")
        window.until("no warnings", lambda: "message.0" not in window.items)
        self.finish(window)

    def test_columns_collapse_by_key_and_in_a_narrow_window(self):
        window = self.small("--paused")

        def width():
            return window.items["picture"]["width"]

        both = width()
        window.key("bracketleft")
        window.until("wider picture", lambda: width() > both + 200)
        one = width()
        window.click("handle.right")
        window.until("whole width", lambda: width() == 1280)
        window.key("bracketleft")
        window.until("left column", lambda: width() == both + 1280 - one)
        self.finish(window)
        # The choice is kept for the next start.
        window = self.window_in(self.folder, "--paused")
        self.assertEqual(width(), both + 1280 - one)
        self.finish(window)
        window = Window(PROGRAM, self.display, scratch(), str(SAMPLES / "eel.json"), "--paused", size="640x400")
        self.addCleanup(window.close)
        self.assertEqual(width(), 640)
        window.key("bracketleft")
        window.place("panel.Robots")
        window.click("handle.right")
        window.place("panel.View")
        window.until("one column", lambda: "panel.Robots" not in window.items)
        window.key("bracketright")
        window.until("no column", lambda: width() == 640)
        self.finish(window)

    def test_keys_are_remapped_by_a_file(self):
        folder = scratch()
        settings = folder / "config/mercury/keys.txt"
        settings.parent.mkdir(parents=True)
        settings.write_text("theme = J\nlegend = Ctrl J\nnonsense = X\n")
        window = self.window_in(folder, str(SAMPLES / "eel.json"), "--paused")
        message = window.wait("message", 0, lambda event: event["tone"] == "warning")["text"]
        self.assertTrue(message.endswith('keys.txt:3: "nonsense" is no command'), message)
        window.key("b")  # no longer the key of the theme
        window.key("j")
        window.frame(lambda frame: frame["theme"] == "light")
        self.finish(window)


if __name__ == "__main__":
    main()
