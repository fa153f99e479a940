# SPDX-License-Identifier: Apache-2.0
"""The cases of docs/validation.md in short form."""

import json
import math
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench" / "validation"))

import bodies  # noqa: E402
import cases  # noqa: E402, F401
import page  # noqa: E402
from table import CASES, Result, Row, decaying_sine  # noqa: E402


@pytest.mark.parametrize("name", CASES)
def test_case(name, device, monkeypatch):
    """What holds holds, and what the page calls a failure still is one."""
    monkeypatch.setattr(bodies, "DEVICE", device)
    case = CASES[name]
    rows = case.run(True).rows
    if not rows:
        pytest.skip(f"{name} has no short form")
    for row in rows:
        if row.counts:
            assert case.holds(row) == (not row.fails), f"{row.what}: {row.found:g}, expected {row.expected:g}, {row.fails}"


def test_the_page_says_what_is_recorded():
    recorded = json.loads((ROOT / "bench" / "validation" / "results.json").read_text())
    results = {name: Result.from_json(recorded[name]) for name in CASES}
    assert (ROOT / "docs" / "validation.md").read_text() == page.text(results)


def test_a_decaying_sine_has_its_frequency_and_decay():
    samples = [math.exp(-0.3 * 0.1 * i) * math.sin(2 * 0.1 * i + 1) for i in range(30)]
    assert decaying_sine(samples, 0.1) == pytest.approx((2, 0.3), rel=1e-9)


def test_the_order_of_convergence_is_the_slope_of_the_error():
    rows = [Row("x", 1, 1 + 3 * step**2, step=step) for step in (0.1, 0.05, 0.025)]
    assert Result(rows).orders()["x"] == pytest.approx(2)
    assert not Result(rows[:1]).orders()


def test_a_row_that_is_no_number_fails():
    case = CASES["rod"]
    assert not case.holds(Row("x", 1, float("nan")))
    assert case.holds(Row("x", 1, 1.02)) and not case.holds(Row("x", 1, 1.04))
