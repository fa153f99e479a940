# SPDX-License-Identifier: Apache-2.0
"""Runs the examples with short settings."""
import csv
import importlib.util
import json
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


slow = pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="takes too long under the sanitizer")


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


@slow
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


@slow
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


@slow
def test_a_map_of_elites_is_evolved_in_a_run_folder(tmp_path):
    rows = run("evolve.py", "swim", 2, folder=tmp_path).splitlines()
    elites = [int(re.search(r"(\d+) elites", row)[1]) for row in rows[:3]]
    assert elites == sorted(elites) and elites[0] > 1
    rows = run("evolve.py", "swim", 3, folder=tmp_path).splitlines()
    assert rows[0].startswith("generation   3:") and re.fullmatch(r" *\d+ [\d.]+ m, \d+ masses", rows[-1])
    assert mercurysim.load(tmp_path / "swim_best.json").name.startswith("swim-")


@slow
def test_a_search_takes_scores_of_python(tmp_path):
    rows = run("ask_and_tell.py", 4, folder=tmp_path).splitlines()
    best = [float(row.split()[-1]) for row in rows]
    assert len(best) == 4 and best == sorted(best) and best[-1] > best[0]
    assert mercurysim.load(tmp_path / "light_swimmer.json").name == "light-swimmer"


def test_a_recording_is_plotted(tmp_path, mercury):
    needs("h5py", "matplotlib")
    mercury("run", "--random", "voxel:2", "--seconds", 1, "--record", tmp_path / "swim.h5")
    run("plots.py", "swim.h5", "swim.png", folder=tmp_path)
    import matplotlib.image

    picture = matplotlib.image.imread(tmp_path / "swim.png")
    colors = {tuple(color) for color in picture[::2, ::2, :3].reshape(-1, 3).round(2)}
    assert len(colors) > 20  # axes, texts and two paths of different colors


@slow
def test_ppo_learns_to_swim_nearer(tmp_path):
    needs("gymnasium", "torch")
    table = run("ppo.py", "--robots", 64, "--iterations", 45, folder=tmp_path).splitlines()
    rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(table)]
    assert [row["episodes"] for row in rows[:2]] == [64, 64]  # an untrained eel reaches no target in 20 s
    # Before and after: returns are at most about 2.5, of which 1 is for a target.
    assert rows[0]["reached"] == 0 and rows[0]["return"] < 0.05
    assert np.mean([row["return"] for row in rows[-2:]]) > rows[0]["return"] + 0.1


@slow
def test_the_notebook_runs_and_is_stored_without_outputs(tmp_path, monkeypatch):
    notebook = json.loads((EXAMPLES / "first_steps.ipynb").read_text())
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert all(not cell["outputs"] and cell["execution_count"] is None for cell in cells)
    needs("nbclient", "nbformat", "ipykernel", "matplotlib")
    draws_or_skip()
    import nbclient
    import nbformat

    monkeypatch.setenv("IPYTHONDIR", str(tmp_path))
    page = nbformat.reads(json.dumps(notebook), as_version=4)
    nbclient.NotebookClient(page, timeout=300, resources={"metadata": {"path": tmp_path}}).execute()
    shown = [output for cell in page.cells if cell.cell_type == "code" for output in cell.outputs]
    assert sum("image/png" in output.get("data", {}) for output in shown) == 3  # the robot, the paths, the batch


def draws_or_skip():
    try:
        mercurysim.picture(mercurysim.random_voxel(1), size=(16, 16))
    except mercurysim.DeviceError as error:
        pytest.skip(str(error))
