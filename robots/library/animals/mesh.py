# SPDX-License-Identifier: Apache-2.0
"""Bodies of hexahedra, which need not be cubes: an animal has a nose, and a tail that is thin.

Each hexahedron adds to the 28 springs between its corners, as a voxel does in mercury/real_body.h, and rho V / 8 to the
mass of each corner. A spring of length L gets k = share E V / L^2. For a cube the shares are 0.15 for an edge, 0.2 for a
diagonal across a side and 0.45 through the middle; for a box they are those that make it isotropic, as nearly as springs that
only pull and push can.
"""

from __future__ import annotations

import functools
import itertools
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

CORNERS = np.array(list(itertools.product((0, 1), repeat=3)))  # of a hexahedron, in its own three directions
PAIRS = list(itertools.combinations(range(8), 2))
AXES = [int(np.abs(CORNERS[i] - CORNERS[j]) @ (1, 2, 4)) for i, j in PAIRS]  # bits: in which directions a pair extends
# The corners of each side, counter-clockwise seen from outside.
SIDES = []
for axis, end in itertools.product(range(3), (0, 1)):
    turn = [(0, 0), (1, 0), (1, 1), (0, 1)][:: 1 if end else -1]
    corner = np.zeros((4, 3), int)
    corner[:, axis], corner[:, (axis + 1) % 3], corner[:, (axis + 2) % 3] = end, *zip(*turn)
    SIDES.append(list(corner @ (4, 2, 1)))

MOST_MATERIALS = 250


class Mesh:
    """points (n, 3) [m] and cells (m, 8), whose corners are in the order of CORNERS."""

    def __init__(self, points: Any, cells: Any):
        used, cells = np.unique(np.asarray(cells), return_inverse=True)
        self.used = used  # which of the given points
        self.points, self.cells = np.asarray(points, float)[used], cells.reshape(-1, 8)

    @staticmethod
    def lattice(points: Any, solid: Any = None) -> Mesh:
        """From points (nx + 1, ny + 1, nz + 1, 3); solid (nx, ny, nz) says which cells there are."""
        points = np.asarray(points, float)
        shape = np.array(points.shape[:3])
        cells = np.argwhere(np.ones(shape - 1, bool) if solid is None else solid)
        corners = cells[:, None] + CORNERS
        return Mesh(points.reshape(-1, 3), np.ravel_multi_index(tuple(np.moveaxis(corners, 2, 0)), tuple(shape)))

    def faces(self) -> Any:
        """Triangles of the sides that only one cell has."""
        sides: dict[tuple[int, ...], list[int] | None] = {}
        for cell in self.cells:
            for side in SIDES:
                quad = [int(p) for p in cell[side]]
                key = tuple(sorted(quad))
                sides[key] = None if key in sides else quad
        faces = []
        for quad in filter(None, sides.values()):
            across = [np.linalg.norm(self.points[quad[i]] - self.points[quad[i + 2]]) for i in (0, 1)]
            if across[1] < across[0] - 1e-6:
                quad = quad[1:] + quad[:1]
            faces += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
        return np.array(faces)

    def sizes(self) -> Any:
        """Of each cell along its own three directions, as vectors (cells, 3, 3)."""
        corner = self.points[self.cells].reshape(-1, 2, 2, 2, 3)
        return np.stack([np.diff(corner, axis=axis).mean(axis=(1, 2, 3)) for axis in (1, 2, 3)], axis=1)


def shares(size: Any) -> dict[int, float]:
    """K L^2 / (E V) of a box's springs, by the directions in which they extend (AXES)."""
    logs = np.log(np.asarray(size, float))
    return _shares(tuple(round(round(float(x) / 0.04) * 0.04, 3) for x in logs - logs.min()))


@functools.cache
def _shares(logs: tuple[float, ...]) -> dict[int, float]:
    kinds = [4, 2, 1, 6, 3, 5, 7]
    cube = np.array([0.15] * 3 + [0.2] * 3 + [0.45])
    moduli = []  # C_ijkl of four springs of each kind with K L^2 = E V: xxxx, yyyy, zzzz, xxyy, yyzz, zzxx
    for kind in kinds:
        way = np.exp(logs) * [(kind >> axis) & 1 for axis in range(3)]
        n = way**2 / (way @ way)
        moduli.append(4 * np.array([*(n * n), n[0] * n[1], n[1] * n[2], n[2] * n[0]]))
    # Least squares, with a weak pull towards the cube's, since there are seven shares and six moduli.
    matrix = np.vstack([np.array(moduli).T, 0.05 * np.diag(1 / cube)])
    wanted = np.array([1.2] * 3 + [0.4] * 3 + [0.05] * 7)
    least = 0.15 * cube
    best = (math.inf, least)
    for mask in range(127, -1, -1):
        free = [i for i in range(7) if mask >> i & 1]
        found = least.copy()
        if free:
            held = [i for i in range(7) if i not in free]
            found[free] = np.linalg.lstsq(matrix[:, free], wanted - matrix[:, held] @ least[held], rcond=None)[0]
        if (found >= least - 1e-12).all():
            error = float(np.sum((matrix @ found - wanted) ** 2))
            best = min(best, (error, found), key=lambda pair: pair[0])
            if mask == 127:
                break
    return dict(zip(kinds, (float(share) for share in best[1])))


Muscle = tuple[float, float, float]  # amplitude [1], frequency [rad/s], phase [rad]


def muscles_for(
    mesh: Mesh,
    pose: Callable[[float], Any],
    frequency: float,
    *,
    harmonics: int = 1,
    step: float = 0.02,
    phases: int = 12,
) -> Callable[[int, int], tuple[Muscle, ...]]:
    """Muscles whose rest lengths follow a motion: pose(t) are the points (n, 3) at t of 0 to 1, over one period [Hz].

    So all springs of a body want to be in the same pose, and none of them buckles. Of the motion of each length they have the
    first harmonics, amplitudes in steps, phases in parts of a turn.
    """
    samples = 32
    poses = np.array([pose(i / samples) for i in range(samples)])

    def muscles(a: int, b: int) -> tuple[Muscle, ...]:
        lengths = np.linalg.norm(poses[:, a] - poses[:, b], axis=1)
        parts = np.fft.rfft(lengths / lengths.mean()) * 2 / samples
        found = []
        for n in range(1, harmonics + 1):
            amplitude = step * round(harmonics * abs(parts[n]) / step)
            turn = (np.angle(parts[n]) / (2 * math.pi) + 0.25) % 1
            turn = round(turn * phases) / phases % 1 if amplitude else 0
            found.append((digits(amplitude, 3), 2 * math.pi * frequency * n if amplitude else 0, 2 * math.pi * turn))
        return tuple(found) if any(amplitude for amplitude, _, _ in found) else ()

    return muscles


def document(
    name: str,
    environment: str,
    mesh: Mesh,
    muscles_of: Callable[[int, int], tuple[Muscle, ...]],
    *,
    modulus: Any,
    relaxation_time: float,
    density: float = 1070,
    softest: float = math.inf,
) -> dict[str, Any]:
    """A robot's file. modulus [Pa]: a number, or one per cell. muscles_of(a, b): the muscles between two points, none for tissue.
    Several act side by side: each has its share of the stiffness, and together they are as long as they are in the mean.

    softest: springs are at most as stiff as this times the smaller mass at their ends [1/s2], so that short springs across a
    thin fin do not limit the time step. Springs are as stiff as others of their kind within some percent: a file has at most
    255 materials.
    """
    moduli = np.broadcast_to(np.asarray(modulus, float), len(mesh.cells))
    mass = np.zeros(len(mesh.points))
    stiffness: dict[tuple[int, int], float] = {}
    for cell, size, own in zip(mesh.cells, mesh.sizes(), moduli):
        volume = abs(float(np.linalg.det(size)))
        mass[cell] += density * volume / 8
        share = shares(np.linalg.norm(size, axis=1))
        for (i, j), axes in zip(PAIRS, AXES):
            a, b = sorted((int(cell[i]), int(cell[j])))
            squared = float(np.sum((mesh.points[a] - mesh.points[b]) ** 2))
            stiffness[a, b] = stiffness.get((a, b), 0) + share[axes] * float(own) * volume / squared
    pairs = sorted(stiffness)
    k = np.array([min(stiffness[a, b], softest * min(mass[a], mass[b])) for a, b in pairs])
    springs = []
    for (a, b), own in zip(pairs, k):
        muscles = muscles_of(a, b) or ((0.0, 0.0, 0.0),)
        springs += [(a, b, own / len(muscles), muscle) for muscle in muscles]
    of_spring = np.array([own for _, _, own, _ in springs])
    for step in np.geomspace(1.04, 3, 24):
        level = np.round(np.log(of_spring) / math.log(step)).astype(int).tolist()
        kinds = [(own, muscle) for own, (_, _, _, muscle) in zip(level, springs)]
        ids = {kind: i + 1 for i, kind in enumerate(sorted(set(kinds)))}
        if len(ids) <= MOST_MATERIALS:
            break
    else:
        raise ValueError(f"{name}: {len(ids)} materials, at most {MOST_MATERIALS}")
    id_of = np.array([ids[kind] for kind in kinds])
    materials: list[dict[str, Any]] = [{"name": "air", "stiffness": 0, "amplitude": 0, "frequency": 0, "phase": 0}]
    for (_, (amplitude, frequency, phase)), i in ids.items():
        material = {"name": "muscle" if amplitude else "tissue", "stiffness": digits(of_spring[id_of == i].mean(), 4),
                    "amplitude": digits(amplitude, 4), "frequency": digits(frequency, 5), "phase": digits(phase, 5),
                    "relaxation_time": relaxation_time}  # fmt: skip
        materials.append(material)
    middle = (mesh.points.min(axis=0) + mesh.points.max(axis=0)) / 2
    # What an isotropic network of these springs would have, as `mercury info` says it: some are softer than `modulus` asks.
    rest = np.array([np.sum((mesh.points[a] - mesh.points[b]) ** 2) for a, b in pairs])
    modulus = digits(float(k @ rest) * density / mass.sum() / 6, 3)
    real = {"modulus": modulus, "density": density, "relaxation_time": relaxation_time}
    return {
        "format": "mercury-robot",
        "version": 1,
        "name": name,
        "origin": {"kind": "designed", "environment": environment, "real": real},
        "materials": materials,
        "masses": [[round(float(x), 5) for x in point] for point in mesh.points - middle],
        "springs": [[a, b, int(i)] for (a, b, _, _), i in zip(springs, id_of)],
        "faces": mesh.faces().tolist(),
        "mass": [digits(m, 5) for m in mass],
    }


def digits(value: float, count: int) -> float:
    return float(f"{float(value):.{count}g}")


def save(folder: Path, robot: dict[str, Any]) -> None:
    """A line per member, so that changes can be read."""
    members = [f"{json.dumps(key)}: {json.dumps(value, separators=(',', ':'))}" for key, value in robot.items()]
    (folder / f"{robot['name']}.json").write_text("{\n" + ",\n".join(members) + "\n}\n")
