# SPDX-License-Identifier: Apache-2.0
"""docs/validation.md and its plots, from the table of cases and what they found."""

from __future__ import annotations

import math
import textwrap
from pathlib import Path
from typing import Any

import numpy as np
from table import CASES, Case, Result, Row

HEAD = """# Validation

How far Mercury is from theory and from experiments. Each case names its formula, its source and the tolerance that was
set before: 1 % where a formula is exact for what Mercury computes, 3 % where a lattice of springs stands for a solid,
10 % where the other side is an experiment. What does not hold stays in the tables and says why. {count} of {all} cases
hold in every row, {rows} of {all_rows} rows hold.

    PYTHONPATH=build/python python3 bench/validation

runs all cases on the CPU, in about two minutes on two cores, and writes this page. The same cases in short form are tests
(`ctest -R python.validation`). [physics.md](physics.md) has the equations.

![the error of every row beside its tolerance](pictures/validation.svg)

| case | largest error | at the finest step | tolerance | order | |
|---|---|---|---|---|---|
"""

TAIL = """
## What is not compared yet

- The shape of a swimming animal along its body. The catsharks' midlines are not in their repository, which holds one number
  per animal and speed (beat, amplitudes, wavelength, largest curvature).
"""


def write(results: dict[str, Result], docs: Path) -> None:
    (docs / "validation.md").write_text(text(results))
    for name, draw in PLOTS.items():
        save(docs / "pictures" / f"{name}.svg", draw, results)


def judged(case: Case, result: Result) -> list[tuple[Row, bool]]:
    return [(row, case.holds(row)) for row in result.rows if row.counts]


def text(results: dict[str, Result]) -> str:
    every = {name: judged(CASES[name], result) for name, result in results.items()}
    page = HEAD.format(
        count=sum(all(good for _, good in rows) for rows in every.values()),
        all=len(every),
        rows=sum(good for rows in every.values() for _, good in rows),
        all_rows=sum(map(len, every.values())),
    )
    for name, result in results.items():
        case, rows = CASES[name], every[name]
        good = sum(holds for _, holds in rows)
        verdict = "holds" if good == len(rows) else f"**{len(rows) - good} of {len(rows)} rows fail**"
        orders = ", ".join(f"{order:.1f}" for order in result.orders().values())
        page += f"| [{case.title}](#{anchor(case.title)}) | {percent(result.worst)} | {percent(result.finest)} | {100 * case.tolerance:g} % | {orders} | {verdict} |\n"
    for name, result in results.items():
        page += section(CASES[name], result)
    return page + TAIL


def section(case: Case, result: Result) -> str:
    lines = ["", f"## {case.title}", ""]
    lines += [f"    {line}" for line in case.formula.splitlines()]
    for paragraph in (f"Source: {case.source}. Tolerance: {100 * case.tolerance:g} %.", case.remark):
        lines += ["", *textwrap.wrap(paragraph, 120, break_on_hyphens=False)] if paragraph else []
    lines.append("")
    stepped = any(row.step for row in result.rows)
    head = ["", *([case.step] if stepped else []), "expected", "found", "error", ""]
    lines += ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    for row in result.rows:
        name = row.what + (f" [{row.unit}]" if row.unit else "")
        verdict = "" if not row.counts else "holds" if case.holds(row) else f"**fails**: {row.fails}" if row.fails else "**fails**"
        cells = [name, *([f"{row.step:.3g}" if row.step else ""] if stepped else []), number(row.expected), number(row.found)]
        cells += [percent(row.error, sign=True), verdict]
        lines.append("| " + " | ".join(cells) + " |")
    orders = [f"{what} {order:.2f}" for what, order in result.orders().items()]
    if orders:
        lines += ["", f"Order of convergence: {', '.join(orders)}."]
    for name, shown in PLOTTED.items():
        if shown and shown[0] == case.name:
            lines += ["", f"![{PLOTS[name].__doc__}](pictures/{name}.svg)"]
    return "\n".join(lines) + "\n"


def anchor(title: str) -> str:
    kept = "".join(letter for letter in title.lower() if letter.isalnum() or letter in " -")
    return kept.replace(" ", "-")


def number(value: float) -> str:
    return f"{value:.5g}" if math.isfinite(value) else "none"


def percent(value: float, sign: bool = False) -> str:
    if not math.isfinite(value):
        return "none"
    digits = 3 if abs(value) < 0.001 else 2 if abs(value) < 0.1 else 0
    return f"{100 * value:{'+' if sign else ''}.{digits}f} %"


# Plots ---------------------------------------------------------------------------------------------------------------

BLUE, ORANGE, GREEN, RED, GRAY = "#2166ac", "#e08214", "#1b9e77", "#c51b4a", "#777777"
STYLE = {
    "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.alpha": 0.25,
    "axes.titlesize": 10, "axes.titlelocation": "left", "legend.frameon": False, "legend.fontsize": 8,
    "svg.hashsalt": "mercury", "lines.linewidth": 1.6, "lines.markersize": 4.5, "figure.facecolor": "white",
}  # fmt: skip


def save(path: Path, draw: Any, results: dict[str, Result]) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    needed = PLOTTED[path.stem]
    if not all(name in results for name in needed):
        return
    with plt.rc_context(STYLE):
        figure = draw(plt, results)
        figure.savefig(path, metadata={"Date": None, "Creator": None}, bbox_inches="tight")
        plt.close(figure)


def summary(plt: Any, results: dict[str, Result]) -> Any:
    """the error of every row beside its tolerance"""
    figure, axes = plt.subplots(figsize=(7.6, 0.33 * len(results) + 1))
    for y, (name, result) in enumerate(results.items()):
        tolerance = CASES[name].tolerance
        axes.barh(y, tolerance - 1e-6, left=1e-6, height=0.62, color="#e8eef5", zorder=0)
        axes.plot([tolerance] * 2, [y - 0.31, y + 0.31], color=GRAY, linewidth=1.2)
        for row, good in judged(CASES[name], result):
            axes.plot(max(abs(row.error), 1.2e-6), y, "o", color=BLUE if good else RED, alpha=0.75, markeredgewidth=0)
    axes.set(xscale="log", xlim=(1e-6, 12), ylim=(len(results) - 0.4, -0.6), xlabel="error, relative (to the left: smaller or none)")
    axes.set_yticks(range(len(results)), list(results))
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
    return figure


def beams(plt: Any, results: dict[str, Result]) -> Any:
    """errors of bars over the number of voxels across, and the cantilever's line"""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3), constrained_layout=True)
    series = (("cantilever", "sag over length", "cantilever, sag", BLUE), ("cantilever", "frequency", "cantilever, frequency", ORANGE),
              ("free-free", "frequency", "free bar, frequency", GREEN), ("rod", "frequency", "rod, longitudinal", GRAY),
              ("column", "sinking of the top", "column, sinking", RED))  # fmt: skip
    for name, what, label, color in series:
        rows = [row for row in results[name].rows if row.what == what and row.step]
        left.plot([30 / row.step for row in rows], [100 * abs(row.error) for row in rows], "o-", color=color, label=label)
    left.axhline(3, color=GRAY, linestyle=":", linewidth=1)
    left.set(xscale="log", yscale="log", xlabel="voxels across", ylabel="error [%]", ylim=(8e-3, 50), title="Lattices against theory")
    left.set_yticks([0.01, 0.1, 1, 10], ["0.01", "0.1", "1", "10"])
    left.set_xticks([1, 2, 4, 8, 16], ["1", "2", "4", "8", "16"])
    left.minorticks_off()
    left.legend()
    x, z = np.array(results["cantilever"].curves["profile"])
    fine = np.linspace(0, 1, 100)
    line = (fine**2 * (6 - 4 * fine + fine**2)) / 3
    tip = results["cantilever"].rows[-2].expected
    right.plot(fine, -100 * tip * line, color=GRAY, label="Euler and Bernoulli")
    right.plot(x[::8], 100 * z[::8], "o", color=BLUE, label="16 voxels across")
    right.set(xlabel="x / L", ylabel="sag [% of L]", title="Cantilever under its weight")
    right.legend()
    return figure


def waters(plt: Any, results: dict[str, Result]) -> Any:
    """errors of terminal speeds over three decades, and swimming speeds of waving sheets"""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.3), constrained_layout=True)
    curves = results["terminal-speed"].curves
    for name, color in (("cube", BLUE), ("plate", ORANGE), ("sphere", GREEN)):
        errors = [100 * (found / speed - 1) for speed, found in zip(curves["speeds"], curves[name])]
        left.plot(curves["speeds"], errors, "o-", color=color, label=f"{name}, resistive water")
    rows = results["equation-1"].rows
    left.plot([row.expected for row in rows], [100 * row.error for row in rows], "s--", color=RED, label="cube, equation 1")
    left.axhspan(-1, 1, color="#e8eef5", zorder=0)
    left.set_yscale("symlog", linthresh=1)
    left.set(xscale="log", xlabel="terminal speed [m/s]", ylabel="error [%]", title="Terminal speed")
    left.set_yticks([-1, 0, 1, 10, 100], ["-1", "0", "1", "10", "100"])
    left.legend()

    from water import slip_by_equation_1, slip_by_resistance

    fine = np.linspace(0.02, 1, 120)
    for ratio, color in ((0.1, "#92c5de"), (0.2, "#4393c3"), (0.3, BLUE)):
        found = results["waving-sheet"].curves
        right.plot(fine, [slip_by_equation_1(ratio, a) for a in fine], color=color, label=f"equation 1, $C_L/C_D$ = {ratio}")
        right.plot(found["steepness"], [math.nan if v is None else v for v in found[f"r {ratio}"]], "o", color=color)
    for c_t, color in ((0.02, ORANGE), (0.1, "#b35806")):
        found = results["resistive-sheet"].curves
        right.plot(fine, [slip_by_resistance(1, c_t, a) for a in fine], color=color, label=f"resistive, $C_T/C_N$ = {c_t}")
        right.plot(found["steepness"], found[f"C_T {c_t}"], "o", color=color)
    small = fine[fine < 0.6]
    right.plot(small, small**2 / 2 * (1 - 19 / 16 * small**2), ":", color=GRAY, label="not modeled: Taylor, viscous")
    right.axhline(1, linestyle="--", color=GRAY, linewidth=1, label="not modeled: limit of Lighthill's thrust")
    right.set(xlabel="a = k b", ylabel="U / c", ylim=(0, 1.05), title="Waving sheet")
    right.legend(fontsize=7, loc="center left", bbox_to_anchor=(1, 0.5))
    return figure


def times(plt: Any, results: dict[str, Result]) -> Any:
    """changes of energy and momenta over a million steps, and a bounce at two steps of time"""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 2.8), constrained_layout=True)
    curves = results["conservation"].curves
    for name, label, color in (("energy", "energy", BLUE), ("spin", "angular momentum", ORANGE), ("momentum", "momentum", GREEN)):
        left.plot(curves["steps"], 100 * np.array(curves[name]), color=color, label=label, linewidth=1)
    left.set(xlabel="steps [millions]", ylabel="change [%]", title="What should stay")
    left.legend()
    curves = results["bounce"].curves
    right.plot(curves["times"], np.array(curves["reference"]) * 1000, color=GRAY, label="dt / 16")
    right.plot(curves["coarse times"], np.array(curves["coarse"]) * 1000, "o", markersize=2.5, color=BLUE, label="dt = 5 ms")
    right.set(xlabel="time [s]", ylabel="height of the center [mm]", title="Drop and bounce")
    right.legend()
    return figure


def experiments(plt: Any, results: dict[str, Result]) -> Any:
    """Strouhal numbers of catsharks and of two sample robots over speed, sags of a silicone beam, and speeds of a robot fish"""
    figure, (left, right, last) = plt.subplots(1, 3, figsize=(10.6, 2.8), constrained_layout=True)
    curves = results["animals"].curves
    left.axhspan(0.2, 0.4, color="#e8eef5", zorder=0, label="0.2 to 0.4")
    left.plot(*curves["catshark"], "o-", color=BLUE, label="catsharks")
    for name, marker in (("eel", "s"), ("fish", "D")):
        left.plot(*curves[name], marker, color=RED, label=f"sample {name}")
    left.set(xscale="log", yscale="log", xlabel="speed [body lengths/s]", ylabel="f A / U", title="Strouhal number")
    left.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
    left.set_yticks([0.1, 0.2, 0.5, 1, 2], ["0.1", "0.2", "0.5", "1", "2"])
    left.minorticks_off()
    left.legend(fontsize=7)
    rows = [row for row in results["silicone-beam"].rows if row.unit == "mm" and row.step]
    whats = list(dict.fromkeys(row.what for row in rows))
    steps = sorted({row.step for row in rows}, reverse=True)
    measured = [next(row.expected for row in rows if row.what == what) for what in whats]
    bars = [("measured", GRAY, measured)]
    for step, color in zip(steps, ("#c6dbef", "#6baed6", BLUE)):
        found = [row.found for row in rows if row.step == step]
        bars.append((f"{30 / step:.0f} voxels across", color, found))
    for i, (label, color, heights) in enumerate(bars):
        right.bar(np.arange(3) + 0.2 * (i - 1.5), heights, 0.18, color=color, label=label)
    right.set_xticks(range(3), ["own weight", "+ 52 g", "+ 101 g"])
    right.set(ylabel="sag [mm]", title="Silicone beam")
    right.grid(axis="x", visible=False)
    right.legend()
    curves = results["filmed-fish"].curves
    last.plot(curves["motor"], curves["filmed"], "o-", color=GRAY, label="filmed, within 10 %")
    last.fill_between(curves["motor"], *(share * np.array(curves["filmed"]) for share in (0.9, 1.1)), color="#e8eef5", zorder=0)
    last.plot(curves["motor"], curves["found"], "s", color=BLUE, label="here")
    last.set(xlabel="motor [1/s]", ylabel="speed [m/s]", ylim=(0, None), title="Robot fish")
    last.legend()
    return figure


PLOTS = {"validation": summary, "validation-beams": beams, "validation-time": times, "validation-water": waters,
         "validation-experiments": experiments}  # fmt: skip
# The cases that a plot needs; it is shown at the first.
PLOTTED: dict[str, tuple[str, ...]] = {
    "validation": (),
    "validation-beams": ("cantilever", "free-free", "rod", "column"),
    "validation-time": ("conservation", "bounce"),
    "validation-experiments": ("silicone-beam", "animals", "filmed-fish"),
    "validation-water": ("waving-sheet", "resistive-sheet", "terminal-speed", "equation-1"),
}
