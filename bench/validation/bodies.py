# SPDX-License-Identifier: Apache-2.0
"""Bodies that the cases share."""

from __future__ import annotations

from typing import Any

import numpy as np

import mercurysim

TISSUE_SHARE = 0.8  # modulus of tissue over that of muscle, which --modulus sets


def block(size: tuple[int, int, int], edge: float, *, modulus: float, density: float, relaxation_time: float = 0.0) -> Any:
    """A block of size[0] x size[1] x size[2] voxels of a real material without muscles."""
    return mercurysim.random_voxel(
        1, seed=1, voxels=(size, size), air=0, muscle=0, tissue=1, bone=0, edge=edge, physics="real",
        modulus=modulus / TISSUE_SHARE, body_density=density, relaxation_time=relaxation_time,
    )[0]  # fmt: skip


def changed(robot: Any, **values: Any) -> Any:
    """A copy with other fixed points, masses or velocities."""
    materials = np.column_stack([robot.materials, robot.half_wave, robot.relaxation_time])
    points = {"mass": robot.mass, "velocity": robot.velocity, "fixed": robot.fixed} | values
    return mercurysim.Robot(robot.masses, robot.springs, robot.faces, materials, **points)


def at_end(robot: Any, axis: int, end: int) -> Any:
    """The masses of one end, as a mask; end = -1 or 1."""
    x = robot.masses[:, axis] * end
    return x > x.max() - 1e-4


def rounded(dt: float) -> float:
    """A time step of two digits that is not longer."""
    digits = 10.0 ** (np.floor(np.log10(dt)) - 1)
    return float(np.floor(dt / digits) * digits)


DEVICE = "cpu"  # what steps the robots


def batch_of(robot: Any, environment: Any, dt: float, damping: float = 0) -> Any:
    """A batch of one robot."""
    return mercurysim.Batch([robot], environment, dt=dt, damping=damping, device=DEVICE)
