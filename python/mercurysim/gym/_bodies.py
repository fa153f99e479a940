# SPDX-License-Identifier: Apache-2.0
"""Where the robots of a batch are and how they move, computed on the device from the memory that the batch shares."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import Batch, Robot
from ._arrays import Arrays
from ._markers import body_axes, marker_masses


@dataclass
class Motion:
    """Of n robots with k markers each, float32. Body frame: forward, left and up of the robot as it was made."""

    center: Any  # (n, 3), center of mass [m]
    axes: Any  # (n, 3, 3), forward, left and up in the world; rows
    velocity: Any  # (n, 3), of the center, in the body frame [m/s]
    turning: Any  # (n, 3), angular velocity, in the body frame [rad/s]
    markers: Any  # (n, k, 3), from their middle, in the body frame [m]
    marker_velocities: Any  # (n, k, 3), in the body frame [m/s]


class Bodies:
    def __init__(self, arrays: Arrays, batch: Batch, robots: list[Robot], markers: int) -> None:
        self.arrays = arrays
        self.robots = len(robots)
        self.positions = arrays.view(batch.positions)
        self.velocities = arrays.view(batch.velocities)
        self.centers = arrays.view(batch.centers)
        self.center_velocities = arrays.view(batch.center_velocities)
        known: dict[int, tuple[Any, Any, float]] = {}  # copies of one robot are looked at once
        offsets = np.asarray(batch.offsets)[:-1]
        for robot in robots:
            if id(robot) not in known:
                masses = marker_masses(robot, markers)
                known[id(robot)] = masses, body_axes(robot.masses[masses]), float(np.ptp(robot.masses, axis=0).max())
        all_known = [known[id(robot)] for robot in robots]
        self.marker_index = arrays.own(np.stack([entry[0] for entry in all_known]) + offsets[:, None].astype(np.int64))
        self.weights = arrays.own(np.stack([entry[1] for entry in all_known]).astype(np.float32))
        self.lengths = arrays.own(np.array([entry[2] for entry in all_known], np.float32))  # longest side at rest [m]

    def motion(self) -> Motion:
        """Numbers of a robot that has exploded may be anything finite."""
        xp = self.arrays.xp
        center, velocity, positions, velocities = (
            xp.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
            for values in (
                self.centers,
                self.center_velocities,
                self.positions[self.marker_index],
                self.velocities[self.marker_index],
            )
        )
        markers = positions - positions.mean(1)[:, None]
        axes = self._axes(markers)
        to_body = xp.swapaxes(axes, 1, 2)
        markers = markers @ to_body
        marker_velocities = velocities @ to_body
        relative = marker_velocities - marker_velocities.mean(1)[:, None]
        inertia = xp.sum(markers * markers, (1, 2))
        turning = xp.sum(_cross(xp, markers, relative), 1) / (inertia + 1e-9)[:, None]
        return Motion(center, axes, (velocity[:, None] @ to_body)[:, 0], turning, markers, marker_velocities)

    def _axes(self, markers: Any) -> Any:
        """Forward is the first axis of the fitted affine map, up the third, as far as it is at a right angle."""
        xp = self.arrays.xp
        fitted = xp.swapaxes(self.weights, 1, 2) @ markers
        forward = _unit(xp, fitted[:, 0])
        up = fitted[:, 2] - xp.sum(fitted[:, 2] * forward, 1)[:, None] * forward
        up = _unit(xp, up)
        return xp.stack([forward, _cross(xp, up, forward), up], 1)


def _unit(xp: Any, vectors: Any) -> Any:
    return vectors / (xp.sqrt(xp.sum(vectors * vectors, 1)) + 1e-9)[:, None]


def _cross(xp: Any, a: Any, b: Any) -> Any:
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return xp.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], -1)
