# SPDX-License-Identifier: Apache-2.0
"""A map of elites in a run folder: the farthest swimmer of each size and share of muscles, and its ancestors.

    python evolve.py [RUN] [GENERATIONS]

A run that is there already goes on. `mercury view RUN` watches it meanwhile.
"""
import os
import sys

from mercurysim import evolution

folder = sys.argv[1] if len(sys.argv) > 1 else "swim"
generations = int(sys.argv[2]) if len(sys.argv) > 2 else 20


def report(run: evolution.Run) -> None:
    table = run.generations()
    print(f"generation {table['generation'][-1]:3}: {table['living'][-1]} elites, best {table['best_score'][-1]:.3f} m")


if os.path.exists(os.path.join(folder, "run.toml")):
    run = evolution.resume(folder, generations)
else:
    run = evolution.start(
        folder,
        "voxel",
        {"voxels": (6, 3, 3)},
        axes=["masses:40:120:6", "muscle_share"],
        population=32,
        generations=generations,
        seconds=5,
        dt=2e-3,
    )
run.go_on(report)

individuals = run.individuals()
for id in run.lineage(run.living()[0]):
    print(f"{id:6} {individuals['score'][id]:.3f} m, {individuals['masses'][id]:.0f} masses")
run.best().save("swim_best.json")
