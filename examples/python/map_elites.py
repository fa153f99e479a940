# SPDX-License-Identifier: Apache-2.0
"""MAP-Elites (Mouret and Clune 2015; the package ribs) on bodies: the farthest swimmer of each size and share of air.

    python map_elites.py [GENERATIONS [ROBOTS]]

Bodies are voxel robots that Mercury mutates. evaluate() tries a generation of robots of different shapes at once.
"""
import sys

import numpy as np
from ribs.archives import GridArchive

import mercurysim

generations, count = (int(text) for text in (sys.argv[1:] + ["20", "64"][len(sys.argv) - 1 :]))


def measure(robot):
    """Number of masses, and the share of air in the box around the robot."""
    info = robot.info()
    return info["masses"], 1 - info["volume"] / np.prod(info["extent"])


archive = GridArchive(solution_dim=1, dims=[8, 8], ranges=[(40, 240), (0.1, 0.6)])
bodies: list[mercurysim.Robot] = []  # a solution is the index of a body
for generation in range(generations):
    if generation == 0:
        children = mercurysim.random_voxel(count, seed=1)
    else:
        parents = archive.sample_elites(count)["solution"][:, 0].astype(int)
        children = [bodies[i].mutate(strength=1, muscles=1, seed=len(bodies) + k) for k, i in enumerate(parents)]
    indices = len(bodies) + np.arange(count)
    bodies += children
    results = mercurysim.evaluate(children, seconds=10, dt=2e-3)
    archive.add(indices[:, None], [trial.distance for trial in results], [measure(robot) for robot in children])
    cells, best, total = archive.stats.num_elites, archive.stats.obj_max, archive.stats.qd_score
    print(f"generation {generation + 1:3}: {cells} cells, best {best:.3f} m, sum {total:.2f} m")

best = bodies[int(archive.best_elite["solution"][0])]
print(f"{best.name}: {best.info()['masses']} masses")
best.save("map_elites_best.json")
