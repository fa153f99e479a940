# SPDX-License-Identifier: Apache-2.0
"""CMA-ES (Hansen 2016; the package cmaes) looks for the phases of an eel's muscles with which it swims farthest.

    python cma.py [GENERATIONS]

A generation is one batch: a copy of the eel per candidate, each with phases of its own.
"""
import sys

import numpy as np
from cmaes import CMA

import mercurysim
from mercurysim.bodies import eel

generations = int(sys.argv[1]) if len(sys.argv) > 1 else 30
robot = eel(segments=10, amplitude=0.2)
search = CMA(mean=np.zeros(len(robot.actuators)), sigma=1.0, population_size=32, seed=1)
batch = mercurysim.Batch([robot] * search.population_size, dt=2e-3, device="cpu")
muscles = batch.actuation  # without a drive signal, muscles follow L0 (1 + amplitude sin(frequency t + phase))
np.asarray(muscles.frequency)[:] = 6  # rad/s

for generation in range(generations):
    candidates = np.array([search.ask() for _ in range(search.population_size)])
    np.asarray(muscles.phase)[:] = candidates
    batch.reset()
    start = np.array(batch.centers)
    batch.step(5000)  # 10 s
    distances = np.linalg.norm(np.asarray(batch.centers) - start, axis=1)
    distances[np.asarray(batch.exploded)] = 0
    search.tell([(phases, -distance) for phases, distance in zip(candidates, distances)])
    print(f"generation {generation + 1:3}: best {distances.max():.3f} m, median {np.median(distances):.3f} m")

print("phases from tail to head [rad]:", np.round(candidates[distances.argmax()], 2).tolist())
