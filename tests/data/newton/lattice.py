# SPDX-License-Identifier: Apache-2.0
"""Steps a lattice of Mercury's in Newton 1.8 (pip install newton), on its CPU, and writes what bench/validation compares with.

    python3 lattice.py lattice.json

A block of 3 x 2 x 2 voxels of 0.1 m, stretched, sheared and spinning, in empty space: masses of 1 kg, springs of 50 N/m.
"""

import itertools
import json
import math
import sys

import newton
import numpy as np
import warp as wp

EDGE, STIFFNESS = 0.1, 50.0
SIZE = (3, 2, 2)
TIMES = (0.25, 0.5, 1.0, 2.0)


def lattice():
    points = list(itertools.product(*(range(n + 1) for n in SIZE)))
    index = {point: i for i, point in enumerate(points)}
    springs = set()
    for voxel in itertools.product(*(range(n) for n in SIZE)):
        corners = [index[tuple(a + b for a, b in zip(voxel, corner))] for corner in itertools.product((0, 1), repeat=3)]
        springs |= {tuple(sorted(pair)) for pair in itertools.combinations(corners, 2)}
    return np.array(points, float) * EDGE, sorted(springs)


def start(rest):
    """Positions and velocities: stretched by a fifth, sheared, turning about a skew axis."""
    centered = rest - rest.mean(axis=0)
    deformed = centered @ np.array([[1.2, 0.1, 0], [0, 0.95, 0], [0, 0.05, 0.9]])
    return deformed, np.cross([0.5, 1.0, 1.5], deformed) + [0.1, 0, 0]


def stepped(dt):
    rest, springs = lattice()
    positions, velocities = start(rest)
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    for x, v in zip(rest, velocities):
        builder.add_particle(pos=wp.vec3(*x), vel=wp.vec3(*v), mass=1.0, radius=0.0)
    for a, b in springs:  # their rest lengths are the distances of the particles
        builder.add_spring(a, b, STIFFNESS, 0.0, 0.0)
    model = builder.finalize(device="cpu")
    model.particle_max_velocity = 1e5
    solver = newton.solvers.SolverSemiImplicit(model)
    now, then = model.state(), model.state()
    now.particle_q.assign(positions.astype(np.float32))
    control, found = model.control(), {}
    for step in range(1, round(TIMES[-1] / dt) + 1):
        now.clear_forces()
        solver.step(now, then, control, None, dt)
        now, then = then, now
        if any(step == round(t / dt) for t in TIMES):
            found[step * dt] = now.particle_q.numpy().astype(float)
    return found


def main():
    rest, springs = lattice()
    positions, velocities = start(rest)
    found = stepped(1e-4)
    document = {"newton": newton.__version__, "dt": 1e-4, "stiffness": STIFFNESS, "rest": rest.round(6).tolist(), "springs": springs,
                "positions": positions.round(7).tolist(), "velocities": velocities.round(7).tolist(),
                "found": {f"{t:g}": x.round(6).tolist() for t, x in found.items()}}  # fmt: skip
    assert all(math.isfinite(value) for x in found.values() for value in x.flat)
    with open(sys.argv[1], "w") as file:
        json.dump(document, file, separators=(",", ":"))
        file.write("\n")


if __name__ == "__main__":
    main()
