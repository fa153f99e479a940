# SPDX-License-Identifier: Apache-2.0
"""Walkers with legs: each foot runs round an ellipse. x points ahead, y to the left, z up."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from mesh import Mesh, Muscle, digits, document

Point = tuple[int, int, int]  # of a lattice


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
    """Legs of one cell beside the body."""
    nx, ny, nz = trunk
    wide, down = leg
    solid = np.zeros((nx, ny + 2, nz + down), bool)
    solid[:, 1:-1, down:] = True
    for first, left, _ in legs:
        solid[first : first + wide, ny + 1 if left else 0, : down + 1] = True
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
    muscles = leg_muscles(mesh, index, foot_of, wide, down, swing, lift, frequency)
    return document(name, "land", mesh, muscles, modulus=modulus, relaxation_time=relaxation_time)


def leg_muscles(
    mesh: Mesh,
    index: Any,  # of the mesh's points in the lattice
    foot_of: dict[Point, tuple[float, int]],  # when a point's leg steps [turns], and cells from its leg's back
    wide: int,
    down: int,
    swing: float,
    lift: float,
    frequency: float,
) -> Callable[[int, int], tuple[Muscle, ...]]:
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

    return muscles


def four_legged(
    name: str,
    *,
    cell: tuple[float, float, float],  # of the lattice [m]
    trunk: tuple[int, int],  # cells between tail and neck: along and up
    down: int,  # cells of a leg
    gait: tuple[float, float, float, float],  # when legs step: hind left, hind right, fore left, fore right [turns]
    swing: float,  # contraction of muscles at the front and the back of a leg
    lift: float,  # of all of a leg
    frequency: float,  # [Hz]
    modulus: float,
    relaxation_time: float,
    taper: float = 1.0,  # of the feet
    waist: float = 0.85,  # of the body between the legs
    head: int = 2,  # cells along
    tail: int = 3,
    softest: float = 0.35,  # `softest` of document(), over E / (rho h^2)
) -> dict[str, Any]:
    """A back on four legs of 2 x 2 cells, with a tail and a head above it. Five cells across."""
    nx, nz = trunk
    first_leg, last_leg = tail, tail + nx - 2
    shape = (tail + nx + head, 5, down + nz + 1)
    solid = np.zeros(shape, bool)
    solid[tail : tail + nx, :, down : down + nz] = True
    for i in (first_leg, last_leg):
        for j in (0, 3):
            solid[i : i + 2, j : j + 2, :down] = True
    solid[tail + nx - 1 :, 1:4, down + nz] = True  # neck and head
    solid[tail + nx :, 1:4, down + nz - 1] = True
    solid[:tail, 1:4, down + nz - 1] = True
    grid = np.stack(np.meshgrid(*[np.arange(n + 1.0) for n in shape], indexing="ij"), axis=-1)
    i, j, l = np.moveaxis(grid, -1, 0)
    x = (i - tail - nx / 2) * cell[0]
    y = (j - 2.5) * cell[1]
    z = l * cell[2]
    # The back is round, its middle is slimmer than shoulders and hips.
    middle = np.cos(np.clip((i - tail - nx / 2) / nx, -0.5, 0.5) * math.pi) ** 2
    y *= np.where(l >= down, 1 - (1 - waist) * middle, 1)
    top = (l == down + nz) & (np.abs(j - 2.5) == 2.5)
    y *= np.where(top, 0.8, 1)
    z -= np.where(top, 0.25 * cell[2], 0)
    belly = (l == down) & (i > first_leg + 2) & (i < last_leg)
    z += np.where(belly, (1 - waist) * middle * cell[2], 0)
    # The tail gets thinner and sinks, the snout is smaller than the neck.
    back = np.clip((tail - i) / tail, 0, 1)
    root = (down + nz - 0.5) * cell[2]
    z = np.where(back > 0, root + (z - root) * (1 - 0.4 * back) - 0.8 * cell[2] * back, z)
    y *= 1 - 0.4 * back
    snout = np.clip((i - tail - nx) / head, 0, 1)
    face = (down + nz) * cell[2]
    z = np.where(snout > 0, face + (z - face) * (1 - 0.35 * snout**2), z)
    y *= 1 - 0.35 * snout**2
    points = np.stack([x, y, z], axis=-1)
    foot_of: dict[Point, tuple[float, int]] = {}
    for turn, (first, side) in zip(gait, [(first_leg, 3), (first_leg, 0), (last_leg, 3), (last_leg, 0)]):
        for a in range(first, first + 3):
            for b in range(side, side + 3):
                for c in range(down + 1):
                    share = 1 - (1 - taper) * (1 - c / down)
                    center = np.array([(first + 1 - tail - nx / 2) * cell[0], (side - 1.5) * cell[1]])
                    foot_of[a, b, c] = (turn, a - first)
                    if c < down:
                        points[a, b, c, :2] = center + (points[a, b, c, :2] - center) * share
    mesh = Mesh.lattice(points, solid)
    index = np.stack(np.unravel_index(mesh.used, grid.shape[:3]), axis=1)
    muscles = leg_muscles(mesh, index, foot_of, 2, down, swing, lift, frequency)
    return document(
        name, "land", mesh, muscles, modulus=modulus, relaxation_time=relaxation_time,
        softest=softest * modulus / (1070 * cell[0] ** 2),
    )  # fmt: skip
