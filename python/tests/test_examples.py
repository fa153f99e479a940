# SPDX-License-Identifier: Apache-2.0
"""Runs the examples with short settings."""
import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mercurysim

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples/python"


def needs(*modules):
    for module in modules:
        if importlib.util.find_spec(module) is None:
            pytest.skip(f"there is no {module}")


def run(name, *arguments, folder):
    result = subprocess.run(
        [sys.executable, EXAMPLES / name, *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},  # several tests run at the same time
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


@pytest.mark.parametrize("path", sorted(EXAMPLES.glob("*.py")), ids=lambda path: path.stem)
def test_an_example_has_under_80_lines(path):
    assert len(path.read_text().splitlines()) < 80


def test_cma_finds_phases_that_swim_several_times_as_far(tmp_path):
    needs("cmaes")
    lines = run("cma.py", 20, folder=tmp_path).splitlines()
    medians = [float(re.search(r"median ([\d.]+) m", line)[1]) for line in lines[:20]]
    assert medians[-1] > 4 * medians[0]
    assert lines[20].startswith("phases from tail to head")


def test_the_controller_reaches_targets_that_lie_aside(tmp_path):
    rows = run("closed_loop.py", folder=tmp_path).splitlines()[1:]
    steered, adrift = np.array([[float(row.split()[2]), float(row.split()[4])] for row in rows]).T
    assert len(rows) == 5 and steered.max() < 0.1
    assert adrift[[0, 1, 3, 4]].min() > 0.9  # straight ahead is one of the five


def test_map_elites_fills_cells_and_saves_the_best(tmp_path):
    needs("ribs")
    rows = run("map_elites.py", 4, 32, folder=tmp_path).splitlines()
    found = [re.search(r"(\d+) cells, best ([\d.]+) m, sum ([\d.]+) m", row) for row in rows[:4]]
    cells, best, total = np.array([[float(number) for number in match.groups()] for match in found]).T
    assert (np.diff(cells) >= 0).all() and (np.diff(best) >= 0).all() and total[-1] > 1.2 * total[0]
    robot = mercurysim.load(tmp_path / "map_elites_best.json")
    assert rows[4] == f"{robot.name}: {len(robot.masses)} masses"
    (again,) = mercurysim.evaluate([robot], 10, dt=2e-3)
    assert again.distance == pytest.approx(best[-1], abs=5e-4)


def test_a_recording_is_plotted(tmp_path, mercury):
    needs("h5py", "matplotlib")
    mercury("run", "--random", "voxel:2", "--seconds", 1, "--record", tmp_path / "swim.h5")
    run("plots.py", "swim.h5", "swim.png", folder=tmp_path)
    import matplotlib.image

    picture = matplotlib.image.imread(tmp_path / "swim.png")
    colors = {tuple(color) for color in picture[::2, ::2, :3].reshape(-1, 3).round(2)}
    assert len(colors) > 20  # axes, texts and two paths of different colors
