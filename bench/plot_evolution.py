#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots the output of `bench_evolution --csv`: the best distance against the number of tried robots. A line is the
median of all seeds, a band its quartiles. One panel per kind of robot and environment.

    bench/plot_evolution.py evolution.csv -o evolution.png
"""
import argparse
import csv
import math
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLUMNS = {"kind", "environment", "algorithm", "seed", "evaluations", "best"}
NAMES = {"voxel": "voxel robots", "cppn": "painted voxel robots", "nn": "network robots", "shell": "shells"}


def read(path):
    """{(kind, environment): {algorithm: {seed: [(evaluations, best)]}}}, in the order of the file."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or not COLUMNS <= rows[0].keys():
        sys.exit(f"{path}: not written by bench_evolution --csv")
    panels = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    for row in rows:
        course = panels[row["kind"], row["environment"]][row["algorithm"]][row["seed"]]
        course.append((int(row["evaluations"]), max(0.0, float(row["best"]))))
    return panels


def at(course, evaluations):
    """The best score of one run after that many robots."""
    return max((best for count, best in course if count <= evaluations), default=0.0)


def draw(axes, algorithms):
    for color, (algorithm, runs) in zip(plt.get_cmap("tab10").colors, algorithms.items()):
        steps = sorted({count for course in runs.values() for count, _ in course})
        scores = np.array([[at(course, count) for count in steps] for course in runs.values()])
        low, median, high = np.quantile(scores, [0.25, 0.5, 0.75], axis=0)
        style = "--" if algorithm == "random" else "-"
        axes.plot(steps, median, style, color=color, label=algorithm)
        axes.fill_between(steps, low, high, color=color, alpha=0.15, linewidth=0)
    axes.grid(True, alpha=0.25)
    axes.set_ylim(bottom=0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    options = parser.parse_args()
    panels = read(options.file)
    columns = min(len({environment for _, environment in panels}), len(panels))
    rows = math.ceil(len(panels) / columns)
    figure, grid = plt.subplots(rows, columns, figsize=(5 * columns, 3.2 * rows), dpi=120, squeeze=False)
    for axes in grid.flat[len(panels):]:
        axes.axis("off")
    for axes, ((kind, environment), algorithms) in zip(grid.flat, panels.items()):
        draw(axes, algorithms)
        axes.set_title(f"{NAMES.get(kind, kind)}, {environment}", fontsize=10)
    for axes in grid[-1]:
        axes.set_xlabel("robots tried")
    for axes in grid[:, 0]:
        axes.set_ylabel("best distance [m]")
    grid.flat[0].legend(fontsize=8, loc="upper left")
    figure.tight_layout()
    figure.savefig(options.output)


if __name__ == "__main__":
    main()
