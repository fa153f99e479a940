#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Plots what examples/python/ppo.py prints: the share of targets reached and the mean return, against wall time.

    bench/plot_learning.py learning.csv -o learning.png
"""
import argparse
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

COLUMNS = ["seconds", "steps", "episodes", "reached", "return"]


def read(path):
    """{column: values}"""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows or list(rows[0]) != COLUMNS:
        sys.exit(f"{path}: not written by examples/python/ppo.py")
    return {column: np.array([float(row[column]) for row in rows]) for column in COLUMNS}


def smooth(values, episodes, width=9):
    """Mean over neighboring rows, weighted by their episodes."""
    ones = np.ones(min(width, len(values)))
    return np.convolve(values * episodes, ones, "same") / np.convolve(episodes, ones, "same")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="FILE.csv")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.png")
    options = parser.parse_args()
    data = read(options.file)
    figure, left = plt.subplots(figsize=(7, 3.6), constrained_layout=True)
    right = left.twinx()
    left.plot(data["seconds"], 100 * smooth(data["reached"], data["episodes"]), color="tab:blue")
    right.plot(data["seconds"], smooth(data["return"], data["episodes"]), color="tab:orange")
    left.set(xlabel="wall time [s]", xlim=(0, data["seconds"][-1]), ylim=(0, 100))
    left.set_ylabel("targets reached [%]", color="tab:blue")
    right.set_ylabel("mean return", color="tab:orange")
    left.set_title(f"{data['steps'][-1] / 1e6:.1f} million steps of an environment")
    left.grid(True, alpha=0.25)
    figure.savefig(options.output, dpi=150)


if __name__ == "__main__":
    main()
