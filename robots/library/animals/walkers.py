# SPDX-License-Identifier: Apache-2.0
"""Walkers with legs: each foot runs round an ellipse. x points ahead, y to the left, z up."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mesh import Mesh, Muscle, digits, document


def walker(
    name: str,
    *,
    cell: tuple[float, float, float],  # of the lattice [m]
    trunk: tuple[int, int, int],  # cells of the body
    legs: list[tuple[int, bool, float]],  # each: first cell along the body, left, when it steps [turns]
    leg: tuple[int, int],  # cells of a leg: along the body, and down
    swing: float,  # contraction of muscles at the front and the back of a leg
    lift: float,  # of all of a leg
    frequency: float,  # [Hz]
    modulus: float,
    relaxation_time: float,
    taper: float = 0.7,  # of the feet
    nose: float = 0.6,  # of both ends of the body
) -> dict[str, Any]:
    nx, ny, nz = trunk
    wide, down = leg
    solid = np.zeros((nx, ny + 2, nz + down), bool)
    solid[:, 1:-1, down:] = True
    phase = np.full(solid.shape[:2], np.nan)
    for first, left, turn in legs:
        y = ny + 1 if left else 0
        solid[first : first + wide, y, : down + 1] = True
        phase[first : first + wide, y] = turn
    grid = np.stack(np.meshgrid(*[np.arange(n + 1.0) for n in solid.shape], indexing="ij"), axis=-1)
    middle = np.array([nx / 2, ny / 2 + 1, down])
    points = (grid - middle) * cell
    # The body is narrower at both ends.
    at = np.abs(grid[..., 0] - nx / 2) / (nx / 2)
    body = (grid[..., 2] >= down) & (grid[..., 1] >= 1) & (grid[..., 1] <= ny + 1)
    girth = np.where(body, 1 - (1 - nose) * at**3, 1)
    points[..., 2] = np.where(grid[..., 2] > down, points[..., 2] * girth, points[..., 2])
    foot_of = {}
    for first, left, turn in legs:
        y = ny + 1 if left else 0
        center = (first + wide / 2 - nx / 2) * cell[0]
        for i in range(first, first + wide + 1):
            for j in (y, y + 1):
                for l in range(down + 1):
                    foot_of[i, j, l] = (turn, i - first)
                    shrink = 1 - (1 - taper) * (1 - l / down)
                    points[i, j, l, 0] = center + (points[i, j, l, 0] - center) * shrink
    mesh = Mesh.lattice(points, solid)
    index = np.stack(np.unravel_index(mesh.used, grid.shape[:3]), axis=1)

    def muscles(a: int, b: int) -> tuple[Muscle, ...]:
        (ia, ja, la), (ib, jb, lb) = (tuple(int(v) for v in index[p]) for p in (a, b))
        if la == lb or (ia, ja, la) not in foot_of or (ib, jb, lb) not in foot_of or max(la, lb) > down:
            return ()
        if (ia, ja) != (ib, jb):
            across = mesh.points[a] - mesh.points[b]
            share = float(across[2] ** 2 / (across @ across))
        else:
            share = 1.0
        turn, place = foot_of[ia, ja, la]
        side = (place + foot_of[ib, jb, lb][1]) / wide - 1  # -1 at the back, 1 at the front
        # Down and back with cos > 0, forward while it is lifted: L = L0 (1 + swing side sin + lift cos).
        x, y = swing * side * share, lift * share
        amplitude = math.hypot(x, y)
        if amplitude < 1e-3:
            return ()
        angle = round((math.atan2(y, x) / (2 * math.pi) - turn) % 1 * 48) / 48
        return ((round(amplitude / 0.02) * 0.02, 2 * math.pi * frequency, 2 * math.pi * (angle % 1)),)

    return document(name, "land", mesh, muscles, modulus=modulus, relaxation_time=relaxation_time)
