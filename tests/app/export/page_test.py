# SPDX-License-Identifier: Apache-2.0
"""Web pages of mercury export in a browser: they draw, they play, they obey mouse, fingers and keys, and need no network.

    page_test.py MERCURY NAME

NAME is the name of a class below. Exit status 77: the browser of the distribution that it takes is not installed.
"""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import browser

MERCURY = sys.argv[1]
PHONE = (390, 844)  # pixels of a page


def mercury(*arguments):
    return subprocess.run([MERCURY, *map(str, arguments), "--quiet"], check=True, capture_output=True, text=True).stdout


# How many colors the middle of the canvas has, drawn now.
COLORS = """(() => {
  player.draw(0);
  const gl = player.view.gl, w = gl.drawingBufferWidth, h = gl.drawingBufferHeight, pixels = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const colors = new Set();
  for (let i = 0; i < pixels.length; i += 4) colors.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]);
  return colors.size;
})()"""
# The color of the pixel at the middle of the first robot, drawn now.
PIXEL = """(() => {
  player.draw(0);
  const gl = player.view.gl, at = player.orbit.project(player.group.boxes[0].center), pixel = new Uint8Array(4);
  gl.readPixels(at.x * gl.drawingBufferWidth, (1 - at.y) * gl.drawingBufferHeight, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  return [...pixel];
})()"""


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def open(self, file, **options):
        page = browser.Chromium(**options)
        self.addCleanup(page.__exit__)
        page.open(self.folder / file)
        self.assertEqual(page.value("document.documentElement.dataset.state"), "ready", page.problems)
        page.wait_for("player.drawn > 0")
        return page

    def export(self, *arguments):
        mercury("export", *arguments, "--device", "cpu")

    def assert_within_reach(self, page):
        """Of a finger, on a phone."""
        self.assertEqual(page.value("[innerWidth, innerHeight]"), list(PHONE))
        self.assertEqual(page.value("document.documentElement.scrollWidth"), PHONE[0])
        for x, y, width, height in page.value("""[...document.querySelectorAll('#bar > *')].filter((e) => e.offsetWidth)
            .map((e) => e.getBoundingClientRect()).map((r) => [r.x, r.y, r.width, r.height])"""):
            self.assertGreaterEqual(min(x, y), 0)
            self.assertLessEqual(x + width, PHONE[0])
            self.assertLessEqual(y + height, PHONE[1])


class Recording(Case):
    """One page, opened once: a browser takes seconds."""

    def test_page_of_a_recording(self):
        mercury("new", "voxel", "--seed", 7, "--voxels", "3x2x2", "-o", self.folder / "eel.json")
        mercury("run", self.folder / "eel.json", "--seconds", 1, "--every", 40, "--device", "cpu", "--record",
                self.folder / "swim.h5")
        mercury("export", self.folder / "swim.h5", "-o", self.folder / "swim.html")
        page = self.open("swim.html")
        with self.subTest("it draws"):
            self.assertGreater(page.value(COLORS), 1000)
        with self.subTest("it plays"):
            time, drawn = page.value("[player.time, player.drawn]")
            page.wait_for(f"player.drawn > {drawn} && player.time !== {time}")
        with self.subTest("space stops it, arrows step a frame, and it loops"):
            page.press(" ")
            page.wait_for("!player.playing")
            page.value("player.setTime(0.4)")
            page.press("ArrowRight")
            page.wait_for("Math.abs(player.time - 0.44) < 1e-6")  # a frame is 40 steps of 1 ms
            page.press("ArrowLeft")
            page.wait_for("Math.abs(player.time - 0.4) < 1e-6")
        with self.subTest("colors"):
            materials = page.value(PIXEL)
            page.press("2")
            page.wait_for("player.color === 'strain'")
            strain = page.value(PIXEL)
            self.assertNotEqual(materials, strain)
            # The mean strain of a mass's springs, from the robot's file and the recorded positions.
            page.value("player.setTime(0.4)")
            page.value("player.group.update(player.time, 'strain')")
            shown = page.value("[...player.group.masses.filter((_, i) => i % 4 === 3)].slice(0, player.group.massCount)")
            for expected, value in zip(self.strains(10), shown, strict=True):
                self.assertAlmostEqual(expected, value, delta=0.01)
        with self.subTest("mouse"):
            azimuth, zoom = page.value("[player.orbit.azimuth, player.orbit.zoom]")
            page.mouse("mousePressed", 300, 150, button="left", buttons=1, clickCount=1)
            page.mouse("mouseMoved", 350, 150, button="left", buttons=1)
            page.mouse("mouseReleased", 350, 150, button="left", clickCount=1)
            page.wait_for(f"player.orbit.azimuth < {azimuth} - 0.1")
            page.mouse("mouseWheel", 300, 150, deltaX=0, deltaY=-100)
            page.wait_for(f"player.orbit.zoom < {zoom}")
        with self.subTest("details"):
            page.press("i")
            page.wait_for("!document.getElementById('panel').hidden")
            details = page.value("document.getElementById('information').textContent")
            for text in ("mercury export", "swim.h5", "ocean", "rounded to 0.25 mm", "final state"):
                self.assertIn(text, details)
        self.assertEqual(page.problems, [])
        self.assertEqual(page.requests, [f"file://{self.folder}/swim.html"])

    def strains(self, frame):
        import h5py
        import numpy as np
        robot = json.loads((self.folder / "eel.json").read_text())
        with h5py.File(self.folder / "swim.h5") as file:
            positions = next(iter(file["particles"].values()))["position/value"][frame].astype(float)
        masses = np.array(robot["masses"])
        sums, counts = np.zeros(len(masses)), np.zeros(len(masses))
        for a, b, _, *rest in robot["springs"]:
            length = rest[0] if rest else np.linalg.norm(masses[a] - masses[b])
            for mass in (a, b):
                sums[mass] += (np.linalg.norm(positions[a] - positions[b]) - length) / length
                counts[mass] += 1
        return list(sums / counts)


class Group(Case):
    """Robots on land, simulated for the page, on a phone."""

    def test_page_of_robots(self):
        mercury("new", "voxel", "--seed", 7, "--voxels", "2x2x2", "--count", 3, "-o", self.folder / "robots")
        self.export(self.folder / "robots", "--environment", "land", "--seconds", 1, "-o", self.folder / "three.html")
        page = self.open("three.html", size=PHONE, touch=True, scale=3)
        with self.subTest("all is within reach"):
            self.assert_within_reach(page)
        self.assertEqual(page.value("player.shown.length"), 3)
        self.assertAlmostEqual(page.value("player.end"), 1)  # 30 frames per second, between steps of 1 ms
        page.press(" ")
        with self.subTest("they stand on the ground side by side"):
            boxes = page.value("player.group.boxes.map(({ low, high }) => [low, high])")
            for low, high in boxes:
                self.assertGreater(low[2], -0.01)
            centers = [[(l + h) / 2 for l, h in zip(low, high)] for low, high in boxes]
            self.assertEqual(len({tuple(round(x, 1) for x in center[:2]) for center in centers}), 3)
        with self.subTest("a finger turns, two fingers zoom"):
            # Names are buttons, and none is to be in the way.
            page.value("player.labels.forEach((label) => (label.style.pointerEvents = 'none'))")
            azimuth, zoom = page.value("[player.orbit.azimuth, player.orbit.zoom]")
            page.touch("touchStart", (100, 450))
            for x in (130, 160, 190):
                page.touch("touchMove", (x, 450))
            page.touch("touchEnd")
            page.wait_for(f"player.orbit.azimuth < {azimuth} - 0.1")
            page.touch("touchStart", (150, 450), (210, 450))
            page.touch("touchMove", (110, 450), (250, 450))
            page.touch("touchEnd")
            page.wait_for(f"player.orbit.zoom < 0.8 * {zoom}")
            self.assertTrue(page.value("player.follow"))
            page.touch("touchStart", (150, 450), (210, 450))
            for y in (430, 400, 370):
                page.touch("touchMove", (150, y), (210, y))
            page.touch("touchEnd")
            page.wait_for("!player.follow")  # a move of both is meant
        with self.subTest("a name chooses its robot"):
            page.value("player.labels[1].click()")
            self.assertEqual(page.value("player.selected"), 1)
        self.assertEqual(page.problems, [])


class Run(Case):
    def test_pages_of_a_run(self):
        mercury("evolve", self.folder / "run", "--from", "cppn:2x2x2", "--algorithm", "map-elites", "--axis",
                "masses:0:40:3", "--axis", "muscle_share:0:1:2", "--population", 8, "--generations", 2, "--seconds", 0.1,
                "--device", "cpu", "--seed", 1)
        run = self.folder / "run"
        self.export(run, "--map", "--seconds", 0.2, "-o", self.folder / "map.html")
        page = self.open("map.html")
        cells = page.value("document.querySelectorAll('#chooser .elite').length")
        self.assertEqual(cells, page.value("player.page.robots.length"))
        best = page.value("player.shown[0]")
        other = page.value("[...document.querySelectorAll('#chooser .elite')].findIndex((cell) => !cell.classList.contains('chosen'))")
        if cells > 1:
            page.value(f"document.querySelectorAll('#chooser .elite')[{other}].dispatchEvent(new Event('click'))")
            page.wait_for(f"player.shown.length === 1 && player.shown[0] !== {best}")
        self.assertEqual(page.problems, [])
        page.__exit__()

        self.export(run, "--lineage", "best", "--seconds", 0.2, "-o", self.folder / "ancestry.html")
        page = self.open("ancestry.html")
        robots = page.value("player.page.robots.length")
        self.assertEqual(page.value("player.shown.length"), robots)
        self.assertEqual(page.value("document.querySelectorAll('#chooser .plays').length"), robots)
        # No number of the axes is cut off.
        self.assertGreaterEqual(page.value("Math.min(...[...document.querySelectorAll('#chooser text')].map((t) => t.getBBox().x))"), 0)
        page.value("document.querySelector('#chooser .plays').dispatchEvent(new Event('click'))")
        page.wait_for("player.shown.length === 1")
        self.assertEqual(page.problems, [])


class Firefox(Case):
    def test_page_draws_and_plays(self):
        self.export("sample:paper/eel", "--seconds", 0.5, "-o", self.folder / "eel.html")
        page = browser.Firefox(PHONE)
        self.addCleanup(page.close)
        page.open(self.folder / "eel.html")
        self.assertEqual(page.value("document.documentElement.dataset.state"), "ready", page.problems)
        time = page.value("player.time")
        page.wait_for(f"player.drawn > 1 && player.time !== {time}")
        self.assertGreater(page.value(COLORS), 1000)
        self.assert_within_reach(page)
        self.assertEqual(page.problems, [])


if __name__ == "__main__":
    wanted, packages = ((browser.firefox, "firefox-esr xvfb") if sys.argv[2] == "Firefox" else (browser.chromium, "chromium"))
    if not wanted():
        print(f"skipped: there is no such browser (apt install {packages})")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
