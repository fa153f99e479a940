#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots the output of `mercury bench --csv`: springs per second against springs evaluated (the paper's figure 4), or
against robot size.

    bench/plot.py sweep.csv [more.csv ...] -o sweep.png
    bench/plot.py size5.csv size10.csv ... --against size -o sizes.png
"""
import argparse
import csv
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

# From the paper's figure 4 (RTX 2080 Ti): about 6e9 springs/s from 5e8 springs evaluated on, up to 1e11;
# Titan about 1e9 on the same GPU.
PAPER = [("Mercury as published, 2080 Ti", [5e8, 1e11], [6e9, 6e9]), ("Titan, 2080 Ti", [5e8, 1e11], [1e9, 1e9])]


def read(paths):
    rows = []
    for path in paths:
        with open(path, newline="") as file:
            rows += list(csv.DictReader(file))
    needed = {"device", "solver", "environment", "masses_per_robot", "springs_evaluated", "springs_per_second"}
    if not rows or not needed <= rows[0].keys():
        sys.exit(f"{', '.join(paths)}: not written by mercury bench --csv")
    return rows


def lines(rows, against):
    """One line per device, solver and environment, and for figure 4 per size."""
    groups = defaultdict(list)
    for row in rows:
        label = f"{row['solver']}, {row['environment']}"
        if against == "evaluated":
            label += f", {row['masses_per_robot']} masses"
        x = float(row["springs_evaluated" if against == "evaluated" else "masses_per_robot"])
        groups[(row["device"], label)].append((x, float(row["springs_per_second"])))
    return {key: sorted(points) for key, points in sorted(groups.items())}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    parser.add_argument("--against", choices=["evaluated", "size"], default="evaluated")
    options = parser.parse_args()
    rows = read(options.files)
    figure, axes = plt.subplots(figsize=(8, 5), dpi=120)
    for (device, label), points in lines(rows, options.against).items():
        axes.plot(*zip(*points), marker="o", markersize=4, label=f"{device}: {label}")
    if options.against == "evaluated":
        for label, x, y in PAPER:
            axes.plot(x, y, linestyle="--", color="gray", marker="s", markersize=4)
            axes.annotate(label, (x[0], y[0]), xytext=(0, 5), textcoords="offset points", color="dimgray", fontsize=8)
        axes.set_xlabel("springs evaluated")
    else:
        axes.set_xlabel("masses per robot")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylabel("springs evaluated per second")
    axes.grid(True, which="both", alpha=0.25)
    axes.legend(fontsize=8, loc="best")
    figure.tight_layout()
    figure.savefig(options.output)


if __name__ == "__main__":
    main()
