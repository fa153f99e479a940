# SPDX-License-Identifier: Apache-2.0
"""Robots by code, to learn with. Their muscles work in opposite pairs: one drive signal bends a part of the body."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import Robot, voxel

PASSIVE, NEAR, FAR = 1, 2, 3  # materials: no muscle; a muscle that the drive makes longer; one that it makes shorter


def eel(
    length: int = 10,
    height: int = 2,
    *,
    segments: int = 5,
    edge: float = 0.1,
    stiffness: float = 6000,
    amplitude: float = 0.3,
    name: str = "eel",
) -> Robot:
    """A swimmer of length x 1 x height voxels of `edge` [m], whose head is at the end of greater x.

    Each segment has one actuator. u > 0 makes the left side (greater y) longer and the right one shorter, by up to
    `amplitude`, so the segment bends to the right. `stiffness` is that of all springs [N/m].
    """
    body = voxel(np.ones((length, 1, height), np.uint8), edge=edge)
    middle, along = _springs(body, edge)
    bends = along[:, 0] & ~along[:, 1] & (np.abs(middle[:, 1]) > edge / 4)
    materials = np.where(bends, np.where(middle[:, 1] > 0, NEAR, FAR), PASSIVE)
    segment = np.clip((middle[:, 0] / (length * edge) + 0.5) * segments, 0, segments - 1).astype(int)
    actuators = {f"segment {i + 1}": np.flatnonzero(bends & (segment == i)) for i in range(segments)}
    return _robot(body, materials, actuators, stiffness, amplitude, name)


def quadruped(
    *, edge: float = 0.1, stiffness: float = 100, amplitude: float = 0.25, name: str = "quadruped"
) -> Robot:
    """A walker for land: a flat body of 6 x 3 x 1 voxels on four legs of 1 x 1 x 2 voxels.

    Each leg has two actuators. "swing" makes its front longer and its back shorter, "lift" makes all of it longer.
    `stiffness` is that of all springs [N/m], before the stiffness scale of the environment.
    """
    grid = np.zeros((6, 3, 3), np.uint8)
    grid[:, :, 2] = 1
    for column, row in ((0, 0), (0, 2), (5, 0), (5, 2)):
        grid[column, row, :2] = 1
    body = voxel(grid, edge=edge)
    middle, along = _springs(body, edge)
    upright = along[:, 2] & ~along[:, 0] & ~along[:, 1] & (middle[:, 2] < 0.5 * edge)
    materials = np.full(len(middle), PASSIVE)
    actuators = {}
    for end, x in (("hind", -2.5), ("fore", 2.5)):
        for side, y in (("right", -1.0), ("left", 1.0)):
            leg = upright & (np.abs(middle[:, 0] - x * edge) < edge) & (np.abs(middle[:, 1] - y * edge) < edge)
            front = leg & (middle[:, 0] > x * edge)
            lower = middle[:, 2] < -0.5 * edge
            materials[leg] = np.where(front[leg] | lower[leg], NEAR, FAR)
            actuators[f"{end} {side} swing"] = np.flatnonzero(leg & ~lower)
            actuators[f"{end} {side} lift"] = np.flatnonzero(leg & lower)
    return _robot(body, materials, actuators, stiffness, amplitude, name)


def _springs(body: Robot, edge: float) -> tuple[Any, Any]:
    """The middle of each spring, and along which axes it extends."""
    a, b = body.masses[body.springs["a"]], body.masses[body.springs["b"]]
    return (a + b) / 2, np.abs(a - b) > edge / 2


def _robot(body: Robot, materials: Any, actuators: dict[str, Any], stiffness: float, amplitude: float, name: str) -> Robot:
    table = [[0, 0, 0, 0]] + [[stiffness, sign * amplitude, 0, 0] for sign in (0, 1, -1)]
    springs = np.stack([body.springs["a"], body.springs["b"], materials], axis=1)
    return Robot(body.masses, springs, body.faces, np.array(table, np.float32), actuators=actuators, name=name)
