# SPDX-License-Identifier: Apache-2.0
"""Runs every block of docs/python.md and docs/brains.md, one after another, as a reader would."""
import importlib.util
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import mercurysim

DOCS = Path(__file__).resolve().parents[2] / "docs"
BLOCK = re.compile(r"(?:<!-- needs: (\w+) -->\n)?```python\n(.*?)```", re.DOTALL)


def gpu():
    try:
        mercurysim.Batch([], device="cuda")
    except mercurysim.DeviceError:
        return False
    return importlib.util.find_spec("torch") is not None


def pictures():
    try:
        mercurysim.picture(mercurysim.random_voxel(1), size=(16, 16))
    except mercurysim.DeviceError:
        return False
    return True


def shortened(program):
    """The same, but quick without a GPU: a hero is drawn once per point of its lens."""
    return program.replace('style="hero")', 'style="hero", quality="low")')


def recording():
    """Makes the recording of the page."""
    if program := os.environ.get("MERCURY_PROGRAM"):
        arguments = ["run", "--random", "voxel:4", "--seconds", "1", "--record", "swim.h5", "--force"]
        subprocess.run([program, *arguments], check=True, capture_output=True)
    return bool(program)


NEEDS = {
    "gpu": gpu,
    "gymnasium": lambda: importlib.util.find_spec("gymnasium") is not None,
    "pandas": lambda: importlib.util.find_spec("pandas") is not None,
    "pictures": pictures,
    "recording": recording,
    "torch": lambda: importlib.util.find_spec("torch") is not None,
    "stable_baselines3": lambda: importlib.util.find_spec("stable_baselines3") is not None,
    "film": lambda: pictures() and shutil.which("ffmpeg") is not None,
}


@pytest.mark.parametrize(("page", "least"), [("python.md", 9), ("brains.md", 2)])
def test_every_block_runs(page, least, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    text, names, skipped = (DOCS / page).read_text(), {}, []
    blocks = list(BLOCK.finditer(text))
    assert len(blocks) == text.count("```python") >= least
    for block in blocks:
        needs, program = block.groups()
        if needs and not NEEDS[needs]():
            skipped.append(needs)
            continue
        line = text.count("\n", 0, block.start(2)) + 1
        exec(compile("\n" * (line - 1) + shortened(program), page, "exec"), names)  # errors name the line of the page
    assert set(skipped) <= NEEDS.keys() and len(skipped) < len(blocks) / 2
    capsys.readouterr()


def test_the_examples_are_listed():
    folder = DOCS.parent / "examples/python"
    found = {path.name for path in folder.iterdir() if path.suffix in (".py", ".ipynb")}
    assert found == set(re.findall(r"\(\.\./examples/python/([\w.]+)\)", (DOCS / "python.md").read_text()))
