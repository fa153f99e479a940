# SPDX-License-Identifier: Apache-2.0
"""Runs of an evolution in the real window: window_evolution_test.py PROGRAM SAMPLE-FOLDER [TEST...]"""
import csv
import json
import re
import shutil
import subprocess

from window_case import PROGRAM, WindowCase, main, numpy
from window_driver import scratch


def evolve(folder, *more):
    """A small run."""
    subprocess.run([PROGRAM, "evolve", str(folder), "--from", "voxel:3x2x2", "--device", "cpu", "--population", "8",
                    "--generations", "4", "--seconds", "0.2", "--quiet", *more],
                   check=True, stdout=subprocess.DEVNULL)


def individuals(folder):
    with open(folder / "lineage.csv") as file:
        return {int(row["id"]): row for row in csv.DictReader(file)}


class EvolutionTest(WindowCase):
    def open_run(self, *more):
        folder = scratch() / "swim"
        evolve(folder, *more)
        window = self.open(str(folder), "--paused")
        return window, folder

    def test_a_run_opens_with_its_best_robots(self):
        window, folder = self.open_run("--dt", "0.002")
        run = window.wait("run", 0, lambda event: event["generation"] == 4)
        self.assertEqual((run["generations"], run["folder"]), (4, str(folder)))
        self.assertGreater(run["champions"], 0)
        names = window.wait("robots", 0, lambda event: event["count"] > 0)["names"]
        born = individuals(folder)
        scores = [float(born[int(name.removeprefix("swim-"))]["distance"]) for name in names]
        self.assertEqual(scores, sorted(scores, reverse=True))
        self.assertEqual(scores[0], max(float(row["distance"]) for row in born.values()))
        window.place("panel.Evolution")
        # The simulation has the time step of the run.
        since = window.mark()
        window.key("period")
        self.assertAlmostEqual(window.frame(lambda frame: frame["steps"] == 1, since)["time"], 0.002, places=6)
        self.finish(window)

    def test_a_click_on_a_robot_of_the_run_puts_it_into_the_scene(self):
        window, _ = self.open_run()
        count = window.wait("robots", 0, lambda event: event["count"] > 0)["count"]
        window.key("ctrl+a", "Delete")
        window.frame(lambda frame: not frame["where"])
        since = window.mark()
        window.click("champion.0")
        name = window.wait("robots", since, lambda event: event["count"] == 1)["names"][0]
        self.assertTrue(name.startswith("swim-"), name)
        window.click("champion.0")  # it is there already
        window.frame(lambda frame: frame["selected"] == 1 and len(frame["where"]) == 1)
        since = window.mark()
        window.key("ctrl+z", "ctrl+z")
        window.wait("robots", since, lambda event: event["count"] == count)
        self.finish(window)

    def test_a_click_on_the_map_brings_an_elite(self):
        window, folder = self.open_run("--algorithm", "map-elites", "--axis", "masses:12:36:2", "--axis", "muscle_share:0:1:2")
        window.wait("robots")
        window.key("ctrl+a", "Delete")
        window.frame(lambda frame: not frame["where"])
        x, y = window.place("evolution.map")
        grid = window.items["evolution.map"]
        since = window.mark()
        for right, up in ((1, 1), (-1, 1), (1, -1), (-1, -1)):  # not every cell has an elite
            window.do("mousemove", round(x + right * grid["width"] / 4), round(y - up * grid["height"] / 4))
            window.frame()
            window.do("click", 1)
            window.frame()
            window.frame()
        names = window.wait("robots", since)["names"]
        best = {json.loads(file.read_text())["name"] for file in (folder / "best").iterdir()}
        self.assertLessEqual(set(names), best, "they are in the map at the end of the run")
        self.finish(window)

    def test_champions_ancestors_and_the_ranking_have_pictures_of_robots(self):
        window, _ = self.open_run()
        window.wait("robots", 0, lambda event: event["count"] > 0)

        def has_thumbnail(row, left):
            """A frame without a thumbnail has one color."""
            item, pixels = window.items[row], window.pixels()
            top, left = round(item["y"] - item["height"] / 2), round(item["x"] - item["width"] / 2 + left)
            side = round(item["height"])
            thumbnail = pixels[top + 4:top + side - 4, left + 4:left + side].reshape(-1, 3)
            return len(numpy.unique(thumbnail // 8, axis=0)) > 30

        def wait_for_thumbnail(row, left=0):
            """`left`: where it begins, in heights of the row."""
            window.place(row)
            window.until(f"thumbnail of {row}", lambda: has_thumbnail(row, left * window.items[row]["height"]))

        window.open("Evolution")
        wait_for_thumbnail("champion.0")
        window.do("mousemove", window.place("panel.Evolution")[0], 80)
        window.do("click", "--repeat", 30, 5)
        wait_for_thumbnail("family.0", 2.8)  # beyond the generation
        window.open("Ranking")
        wait_for_thumbnail("ranking.0")
        self.finish(window)

    def test_the_run_is_exported_as_a_page(self):
        window, folder = self.open_run()
        window.wait("run", 0, lambda event: event["generation"] == 4)
        page = folder.parent / "swim.html"
        since = window.mark()
        window.click("menu.File")
        window.click("menu.export_run")
        window.dialog(str(page))
        window.wait("message", since, lambda event: event["text"] == f"exported {page}")
        best = max(individuals(folder).items(), key=lambda born: float(born[1]["distance"]))[0]
        self.assertIn(f'"name":"swim-{best}"', page.read_text())
        self.finish(window)

    def test_a_run_that_grows_is_followed_and_one_that_vanishes_is_reported(self):
        window, folder = self.open_run()
        window.wait("run", 0, lambda event: event["generation"] == 4)
        since = window.mark()
        subprocess.run([PROGRAM, "evolve", str(folder), "--resume", "--generations", "6", "--device", "cpu", "--quiet"],
                       check=True, stdout=subprocess.DEVNULL)
        window.wait("run", since, lambda event: event["generation"] == 6)
        since = window.mark()
        shutil.rmtree(folder)
        message = window.wait("message", since, lambda event: event["tone"] == "error")
        self.assertIn(str(folder), message["text"])
        window.frame()
        self.finish(window)

    def test_a_folder_that_is_dropped_is_opened_as_a_run(self):
        folder = scratch() / "swim"
        evolve(folder)
        window = self.small("--paused")
        since = window.mark()
        window.drop(folder)
        window.wait("run", since)
        names = window.wait("robots", since, lambda event: event["names"][0].startswith("swim-"))["names"]
        window.key("ctrl+z")  # brings back the scene before
        window.wait("robots", since, lambda event: event["names"] == ["eel", "fish"])
        self.assertNotIn("eel", names)
        self.finish(window)

    def evolve_form(self, aim, **fields):
        """A window whose two robots are about to evolve for the entry `aim` of the list of objectives."""
        window = self.small("--paused")
        window.key("e")  # all robots, as none is selected
        window.place("evolve.name")
        window.click("evolve.algorithm")
        window.key("Escape")  # closes the list, not the dialog
        window.frame()
        window.frame()
        window.click("evolve.aim")
        window.choose("evolve.aim", aim)
        for name, value in fields.items():
            window.click(f"evolve.{name}")
            window.key("ctrl+a")
            window.type(f"{value}\t")
        return window

    def test_selected_robots_evolve_stop_and_go_on(self):
        window = self.evolve_form(6, name="mine", objective="path", population=4, generations=1000, seconds=0.1)  # a formula
        since = window.mark()
        window.click("dialog.accept")
        folder = self.folder / "mine"
        self.assertEqual(window.wait("evolving", since), {"event": "evolving", "folder": str(folder), "robots": 2})
        window.wait("run", since, lambda event: event["generation"] >= 1)
        window.click("evolution.stop")
        window.wait("message", since, lambda event: "stopped" in event["text"])
        settings = (folder / "run.toml").read_text()
        self.assertIn("path", settings)
        self.assertEqual(len(list((folder / "founders").iterdir())), 2)
        since = window.mark()
        window.click("evolution.resume")
        stopped_at = window.wait("run", since)["generation"]
        window.wait("run", since, lambda event: event["generation"] > stopped_at)
        # The end of the window stops it, too, and leaves a run that can be read.
        since = window.mark()
        window.key("ctrl+q")
        self.assertEqual(window.wait("asks", since)["what"], "evolution")
        window.key("Return")
        self.assertEqual(window.process.wait(60), 0, window.stderr())
        self.assertGreater(len(individuals(folder)), 8)

    def test_a_run_that_ends_brings_its_champion(self):
        window = self.evolve_form(1, name="short", population=4, generations=1, seconds=0.1)
        since = window.mark()
        window.click("dialog.accept")
        names = window.wait("robots", since, lambda event: event["count"] == 3)["names"]
        self.assertEqual(names[:2], ["eel", "fish"])
        self.assertIn('objectives = ["cruise_speed"]', (self.folder / "short" / "run.toml").read_text())
        window.frame(lambda frame: frame["selected"] == 1)
        self.finish(window)

    def test_a_run_that_cannot_be_read_is_refused_before_the_window_opens(self):
        folder = scratch() / "swim"
        evolve(folder)
        text = (folder / "run.toml").read_text()
        (folder / "run.toml").write_text(re.sub(r"(?m)^version = .*", "version = 999", text))
        self.assertNotEqual((folder / "run.toml").read_text(), text)
        refused = subprocess.run([PROGRAM, "view", str(folder)], capture_output=True, text=True)
        self.assertEqual(refused.returncode, 2)
        self.assertEqual(refused.stderr.count("\n"), 1, refused.stderr)
        self.assertIn("run.toml", refused.stderr)


if __name__ == "__main__":
    main()
