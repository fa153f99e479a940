# SPDX-License-Identifier: Apache-2.0
"""Marker masses: some masses of a robot, spread over its body, from which an environment sees its shape."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import Robot


def marker_masses(robot: Robot, count: int) -> Any:
    """Indices of `count` masses, from the least x at rest to the greatest.

    The first is the mass farthest from the center at rest, each further one the mass farthest from those that are
    chosen; of equal ones, the first. A robot of fewer masses has some of them twice.
    """
    places = np.round(robot.masses.astype(float), 6)
    nearest = np.linalg.norm(places - places.mean(axis=0), axis=1)
    chosen: list[int] = []
    for _ in range(count):
        chosen.append(int(np.argmax(np.round(nearest, 6))))
        distance = np.linalg.norm(places - places[chosen[-1]], axis=1)
        nearest = np.minimum(nearest, distance) if len(chosen) > 1 else distance
    return np.array(sorted(chosen, key=lambda mass: (places[mass][0], mass)))


def body_axes(rest: Any) -> Any:
    """Weights w (markers, 3) so that w.T @ positions are the axes of the body, as rows.

    They are the columns of the affine map that fits the markers best: the axes x, y, z while the robot is at rest. They
    turn with the body, whatever its shape. `rest`: positions of the markers (markers, 3), as the robot was made.
    """
    centered = rest - rest.mean(axis=0)
    return np.linalg.pinv(centered, rcond=1e-4).T
