# SPDX-License-Identifier: Apache-2.0
"""Mercury's algorithms with an objective in Python: light swimmers that get far.

    python ask_and_tell.py [GENERATIONS]

The objective is a function of arrays over the whole generation. Other libraries, such as DEAP and pyribs, may use the
genomes alone: evolution.Genomes makes, mutates and crosses them.
"""
import sys

import numpy as np

import mercurysim
from mercurysim import evolution

generations = int(sys.argv[1]) if len(sys.argv) > 1 else 20
search = evolution.Search("voxel", {"voxels": (6, 3, 3)}, algorithm="afpo", population=32, seed=1)

for _ in range(generations):
    results = list(mercurysim.evaluate([genome.robot() for genome in search.ask()], 5, dt=2e-3))
    moved = np.array([result.end["center_of_mass"] - result.start["center_of_mass"] for result in results])
    masses = np.array([len(result.robot.masses) for result in results])
    scores = np.hypot(moved[:, 0], moved[:, 1]) - 0.001 * masses  # light robots win
    scores[[result.exploded for result in results]] = np.nan
    search.tell(scores)
    print(f"generation {search.generation:3}: best {search.living()[0][0][0]:.3f}")

search.best().robot("light-swimmer").save("light_swimmer.json")
