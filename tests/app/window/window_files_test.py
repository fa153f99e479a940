# SPDX-License-Identifier: Apache-2.0
"""Opening and saving robots in the real window: window_files_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import json
import shutil
import subprocess
from pathlib import Path

from window_case import PROGRAM, SAMPLES, WindowCase, main


class FilesTest(WindowCase):
    def test_a_generated_robot_is_saved_and_loaded_again(self):
        window = self.small("--paused")
        since = window.mark()
        window.key("n")
        robots = window.wait("robots", since, lambda event: all(name.startswith("voxel") for name in event["names"]))
        window.click("robot.1")
        window.frame(lambda frame: frame["selected"] == 1)
        for expected in ("saved", "asks"):  # the second time, the file exists
            window.until("no dialog", lambda: "dialog.text" not in window.items)
            since = window.mark()
            window.key("ctrl+shift+s")
            window.dialog(str(self.folder / "new.json"))
            window.wait(expected, since)
        window.until("the question alone", lambda: "files.place" not in window.items)  # both dialogs have a dialog.cancel
        window.click("dialog.cancel")
        window.place("files.place")  # the file dialog opens again
        window.key("Escape")
        window.until("dialog closed", lambda: "files.place" not in window.items)
        self.finish(window)
        saved = json.loads((self.folder / "new.json").read_text())
        self.assertEqual(saved["name"], robots["names"][1])

        again = self.window_in(self.folder, "--fresh", "--paused")
        since = again.mark()
        again.key("ctrl+o")
        again.dialog(str(self.folder / "new.json"))
        again.wait("robots", since, lambda event: event["names"][-1:] == [saved["name"]])
        self.finish(again)

    def test_samples_are_a_place_of_the_dialog(self):
        window = self.small("--paused")
        window.key("ctrl+o")
        window.click("files.samples")
        since = window.mark()
        window.dialog("inchworm.json")
        window.wait("robots", since, lambda event: event["names"] == ["eel", "fish", "inchworm"])
        self.finish(window)

    def test_a_scene_that_cannot_be_opened_is_not_offered_for_saving(self):
        window = self.small("--paused")
        bad = self.folder / "bad.toml"
        bad.write_text("robots = 1")
        since = window.mark()
        window.key("ctrl+o")
        window.dialog(str(bad))
        window.wait("message", since, lambda event: "bad.toml" in event["text"])
        since = window.mark()
        window.key("ctrl+s")
        window.dialog("")
        self.assertEqual([Path(file).name for file in window.wait("saved", since)["files"]], ["scene.toml"])
        self.assertEqual(bad.read_text(), "robots = 1")
        self.finish(window)

    def test_a_save_that_fails_leaves_the_dialog_as_it_was(self):
        window = self.small("--paused")
        window.click("robot.0")
        window.frame(lambda frame: frame["selected"] == 1)
        occupied = self.folder / "occupied"  # a file where a folder would be needed
        occupied.write_text("")
        since = window.mark()
        window.key("ctrl+shift+s")
        window.dialog(str(occupied / "eel.json"))
        window.wait("message", since, lambda event: event["tone"] == "error")
        window.place("files.place")
        window.frame()
        # The name is still there: once a folder is there, Enter is enough.
        occupied.unlink()
        occupied.mkdir()
        since = window.mark()
        window.key("Return")
        saved = window.wait("saved", since)
        self.assertEqual(saved["files"], [str(occupied / "eel.json")])
        self.finish(window)

    def test_all_robots_are_saved_as_cbor(self):
        window = self.small("--paused")
        window.key("ctrl+shift+s")
        window.click("files.format")
        window.choose_next("files.format")
        since = window.mark()
        window.click("dialog.text")
        window.dialog("both")
        saved = window.wait("saved", since)["files"]
        self.assertEqual([str(Path(file).relative_to(self.folder)) for file in saved], ["both/eel.cbor", "both/fish.cbor"])
        self.finish(window)
        info = subprocess.run([PROGRAM, "info", str(self.folder / "both")], capture_output=True, text=True)
        self.assertEqual(info.returncode, 0, info.stderr)
        self.assertIn("eel", info.stdout)

    def test_a_robot_is_exported_for_other_programs(self):
        window = self.small("--paused")
        window.click("robot.0")
        window.frame(lambda frame: frame["selected"] == 1)
        since = window.mark()
        window.click("menu.File")
        window.click("menu.export_pose")
        window.dialog(str(self.folder / "eel.stl"))
        window.wait("saved", since)
        window.key("Escape")  # in the frame after the dialog, if frames are slow: it is for the scene already
        window.frame(lambda frame: frame["selected"] == 0)
        faces = len(json.loads((SAMPLES / "eel.json").read_text())["faces"])
        self.assertEqual((self.folder / "eel.stl").stat().st_size, 84 + 50 * faces)

        window.click("robot.0")
        window.frame(lambda frame: frame["selected"] == 1)
        since = window.mark()
        window.click("menu.File")
        window.click("menu.export_motion")
        window.dialog("0.1")  # seconds
        window.place("files.place")
        window.dialog(str(self.folder / "eel.usda"))
        window.wait("message", since, lambda event: "exported " in event["text"])
        self.assertTrue((self.folder / "eel.usda").read_text().startswith("#usda 1.0"))

        window.key("Escape")  # nothing is selected: all robots, in a page
        window.frame(lambda frame: frame["selected"] == 0)
        since = window.mark()
        window.click("menu.File")
        window.click("menu.export_motion")
        window.dialog("0.1")
        window.place("files.place")
        window.dialog(str(self.folder / "both.html"))
        window.wait("message", since, lambda event: "exported " in event["text"])
        page = (self.folder / "both.html").read_text()
        self.assertIn('"name":"eel"', page)
        self.assertIn('"name":"fish"', page)
        self.finish(window)

    def test_a_scene_is_saved_and_comes_back(self):
        window = self.small("--paused", "--fresh", "--environment", "land", "--solver", "xpbd", "--color", "strain")
        window.key("b")  # light
        window.key("ctrl+a", "m")  # two children, which no file has
        window.wait("robots", 0, lambda event: event["count"] == 4)
        window.key("t", "t")  # the turntable moves the camera from where it began
        shown = window.frame(lambda frame: frame["theme"] == "light" and frame["camera"] == "still")
        scene = self.folder / "scene.toml"
        for expected in ("saved", "asks"):  # the second time, the file exists
            window.until("no dialog", lambda: "dialog.text" not in window.items)
            since = window.mark()
            window.key("ctrl+s")
            window.dialog(str(scene) if expected == "saved" else "")
            window.wait(expected, since)
        since = window.mark()
        window.click("dialog.accept")
        files = window.wait("saved", since)["files"]
        names = window.wait("robots", 0, lambda event: event["count"] == 4)["names"]
        self.assertEqual(len(files), 1, "the children have files now")
        self.assertEqual(len(list((self.folder / "scene-robots").iterdir())), 2)
        shown = window.frame()
        self.finish(window)

        again = self.window_in(self.folder, str(scene), "--paused", "--fresh")
        robots = again.wait("robots", 0, lambda event: event["count"] == 4)
        self.assertEqual(robots["names"], names)

        def is_as_saved(frame):
            return (all(frame[key] == shown[key] for key in ("camera", "theme", "color"))
                    and abs(frame["azimuth"] - shown["azimuth"]) < 1e-5
                    and abs(frame["distance"] - shown["distance"]) < 1e-4)

        self.assertEqual((shown["theme"], shown["color"]), ("light", "strain"))
        again.frame(is_as_saved)
        self.finish(again)

        # Opened in a window that shows something else, it takes its place.
        other = self.small("--paused", "--fresh")
        since = other.mark()
        other.drop(scene)
        other.wait("robots", since, lambda event: event["count"] == 4)
        other.frame(is_as_saved)
        self.finish(other)

        for arguments in (["info", scene, "--json"], ["run", scene, "--seconds", "0.01", "--json"],
                          ["render", scene, "--seconds", "0.1", "--size", "160x120", "-o", str(self.folder / "frames/")]):
            result = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stderr)
            if "--json" not in arguments:
                continue
            document = json.loads(result.stdout)
            configuration = document.get("configuration") or document["scenes"][0]["configuration"]
            self.assertEqual((configuration["environment"], configuration["solver"]), ("land", "xpbd"))
        self.assertGreater(len(list((self.folder / "frames").iterdir())), 1)

    def test_an_invalid_robot_file_shows_an_error(self):
        window = self.small("--paused")
        bad = self.folder / "bad.json"
        bad.write_text('{"format": "mercury-robot", "version": 1, "masses": [[0, 0, 0]], "springs": [[0, 7, 1]], "faces": []}')
        since = window.mark()
        window.key("ctrl+o")
        window.dialog(str(bad))
        message = window.wait("message", since, lambda event: event["tone"] == "error")
        self.assertIn("/springs/0", message["text"])
        self.finish(window)

    def test_files_dropped_on_the_window_are_opened(self):
        window = self.small("--paused")
        inner = self.folder / "a folder, #1"
        inner.mkdir()
        for name in ("ray", "squid"):
            shutil.copy(SAMPLES / f"{name}.json", inner)
        odd = self.folder / "t\u00fcrtle 100%.json"
        shutil.copy(SAMPLES / "turtle.json", odd)
        (self.folder / "notes.txt").write_text("no robot")
        (self.folder / "broken.json").write_text("{")
        since = window.mark()
        window.drop(inner, self.folder / "notes.txt", odd, self.folder / "broken.json")
        self.assertEqual(window.wait("dropped", since)["files"], 4)
        robots = window.wait("robots", since, lambda event: event["count"] == 5)
        self.assertEqual(robots["names"], ["eel", "fish", "ray", "squid", "turtle"])
        for text in ("notes.txt", "broken.json"):
            window.wait("message", since, lambda event, text=text: event["tone"] == "error" and text in event["text"])
        window.key("ctrl+z")
        window.wait("robots", since, lambda event: event["names"] == ["eel", "fish"])
        self.finish(window)


if __name__ == "__main__":
    main()
