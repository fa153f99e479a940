# SPDX-License-Identifier: Apache-2.0
"""The table of cases: what a case says of itself, what it measures, and how that is judged."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np

# What a found value may differ from the expected one, by where the latter comes from.
TOLERANCES = {"analytic": 0.01, "lattice": 0.03, "real": 0.10}


@dataclass
class Row:
    """One value beside what it should be."""

    what: str
    expected: float
    found: float
    unit: str = ""
    step: float | None = None  # what is refined: rows of the same `what` with falling steps have an order of convergence
    counts: bool = True  # False: shown for comparison and not judged
    scale: float | None = None  # errors are relative to this instead of `expected`
    tolerance: float | None = None  # in place of the case's [1]
    fails: str = ""  # why it is known to be out of tolerance

    @property
    def error(self) -> float:
        """(found - expected) / scale [1]."""
        return (self.found - self.expected) / (abs(self.expected) if self.scale is None else self.scale)


@dataclass
class Result:
    rows: list[Row]
    curves: dict[str, Any] = field(default_factory=dict)  # for the plots: lists of numbers by name

    @property
    def worst(self) -> float:
        """The largest error of the rows that count [1]."""
        errors = [abs(row.error) for row in self.rows if row.counts]
        return max((error if math.isfinite(error) else math.inf for error in errors), default=math.inf)

    @property
    def finest(self) -> float:
        """The largest error of the rows that count, of refined ones the finest [1]."""
        last = {row.what: row for row in sorted(self.rows, key=lambda row: -(row.step or 0))}
        return Result(list(last.values())).worst

    def orders(self) -> dict[str, float]:
        """The slope of log(error) over log(step), where errors fall as the step does."""
        found = {}
        for what in dict.fromkeys(row.what for row in self.rows if row.step):
            rows = sorted((row for row in self.rows if row.what == what and row.step), key=lambda row: -row.step)
            errors = np.abs([row.error for row in rows])
            if len(rows) > 1 and np.all(errors > 0) and np.all(np.diff(errors) < 0):
                found[what] = float(np.polyfit(np.log([row.step for row in rows]), np.log(errors), 1)[0])
        return found

    def to_json(self) -> dict[str, Any]:
        """Numbers have seven digits, as many as the positions."""
        return _short({"rows": [asdict(row) for row in self.rows], "curves": self.curves})

    @staticmethod
    def from_json(data: dict[str, Any]) -> Result:
        return Result([Row(**row) for row in data["rows"]], data["curves"])


@dataclass
class Case:
    name: str
    title: str
    formula: str  # plain text, as in docs/physics.md
    source: str  # of the formula or the data
    tolerance: float  # [1]
    step: str  # what is refined, "" = nothing
    run: Callable[[bool], Result]  # run(short): the short form takes a second or two
    remark: str = ""

    def holds(self, row: Row) -> bool:
        return abs(row.error) <= (self.tolerance if row.tolerance is None else row.tolerance)  # a NaN does not


CASES: dict[str, Case] = {}


def case(name: str, title: str, *, formula: str, source: str, kind: str, step: str = "", remark: str = ""):
    """Enters a function(short) -> Result into the table."""

    def enter(function: Callable[[bool], Result]) -> Callable[[bool], Result]:
        CASES[name] = Case(name, title, formula, source, TOLERANCES[kind], step, function, remark)
        return function

    return enter


def _short(value: Any) -> Any:
    if isinstance(value, float):
        return float(f"{value:.7g}")
    if isinstance(value, dict):
        return {key: _short(item) for key, item in value.items()}
    return [_short(item) for item in value] if isinstance(value, list) else value


def decaying_sine(samples: Any, interval: float) -> tuple[float, float]:
    """The angular frequency [rad/s] and decay [1/s] of a sampled exp(-decay t) sin(omega t), by Prony's method.

    x(n+1) = a x(n) - b x(n-1) with b = exp(-2 decay interval), a = 2 exp(-decay interval) cos(omega interval).
    """
    x = np.asarray(samples, float)
    (a, b), *_ = np.linalg.lstsq(np.stack([x[1:-1], -x[:-2]], axis=1), x[2:], rcond=None)
    decay = -math.log(b) / (2 * interval)
    return math.acos(a / (2 * math.sqrt(b))) / interval, decay
