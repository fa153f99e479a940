# SPDX-License-Identifier: Apache-2.0
"""Runs the code of the notebooks in examples/notebooks, and checks that they are stored as they should be."""

import ast
import importlib.util
import json
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).resolve().parents[2] / "examples/notebooks").glob("*.ipynb"))


def code_of(path):
    return ["".join(cell["source"]) for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]


def modules_of(code):
    """What the code imports."""
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module.split(".")[0]


def run_notebook(path):
    """All variables at its end. Runs its cells one after another in this process, which takes less time than a kernel."""
    variables = {"__name__": "__main__"}
    for number, code in enumerate(code_of(path)):
        exec(compile(code, f"{path.name}, code {number}", "exec"), variables)  # noqa: S102
    return variables


@pytest.fixture
def notebook(request, tmp_path, monkeypatch, capsys):
    path = NOTEBOOKS[0].parent / f"{request.param}.ipynb"
    for code in code_of(path):
        for module in modules_of(code):
            if importlib.util.find_spec(module) is None:
                pytest.skip(f"there is no {module}")
    monkeypatch.chdir(tmp_path)
    return run_notebook(path), capsys.readouterr().out


def test_each_has_a_test():
    assert [path.stem for path in NOTEBOOKS] == ["ask_and_tell", "own_parts", "runs", "trials"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_small_and_without_outputs(path):
    cells = json.loads(path.read_text())["cells"]
    assert all(cell["outputs"] == [] and cell["execution_count"] is None for cell in cells if cell["cell_type"] == "code")
    assert path.stat().st_size < 10_000 and all(len(line) <= 140 for code in code_of(path) for line in code.split("\n"))


@pytest.mark.parametrize("notebook", ["runs"], indirect=True)
def test_a_run_is_started_stopped_resumed_and_followed(notebook):
    variables, printed = notebook
    reader = variables["reader"]
    assert reader.is_over and len(reader) == 7 * 8
    assert printed.count("generation ") == 4 and "7 of 7 generations, 56 robots" in printed


@pytest.mark.parametrize("notebook", ["ask_and_tell"], indirect=True)
def test_other_optimizers_drive_runs(notebook, tmp_path):
    from mercurysim import evolution

    gaits = evolution.Run(tmp_path / "gaits")
    scores = gaits.generations()["best_score"]
    assert len(scores) == 12 and scores[-1] > 1.5 * scores[0]
    bodies = evolution.Run(tmp_path / "bodies")
    assert bodies.generations()["cells"][-1] == notebook[0]["archive"].stats.num_elites > 3
    swimmers = evolution.Run(tmp_path / "swimmers")
    assert swimmers.living()[0] == notebook[0]["best"][1]
    parents = swimmers.individuals()["parent"]
    assert (parents[:8] == -1).all() and (parents[8:] >= 0).all()


@pytest.mark.parametrize("notebook", ["own_parts"], indirect=True)
def test_objectives_genomes_and_algorithms_are_python(notebook, tmp_path):
    from mercurysim import evolution

    names = [evolution.Run(tmp_path / name).settings for name in ("worst", "worms", "crowding")]
    assert names[0]["objective"] == ["python:worst_case"]
    assert names[1]["robots"] == "python:Worm" and names[2]["algorithm"] == "python:Crowding"
    medians = evolution.Run(tmp_path / "crowding").generations()["median"]
    assert (medians[1:] >= medians[:-1]).all() and medians[-1] > medians[0]  # who lives is replaced by better ones alone


@pytest.mark.parametrize("notebook", ["trials"], indirect=True)
def test_trials_have_conditions_drives_and_races(notebook):
    variables, printed = notebook
    distances = [result.distance for result in variables["results"]]
    assert len(set(distances)) == 4 and max(distances) > 0.05
    assert 5 < sum(variables["stopped"]) < 40 and "as they are" in printed
