# SPDX-License-Identifier: Apache-2.0
"""Where robots are to go: each to a point of its own, a new one every episode, or all of them along x."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import Arrays
from ._bodies import Bodies

POOL = 65536  # points that are drawn per seed; episodes take them in turn, without a wait for the device


class Targets:
    def __init__(
        self, arrays: Arrays, bodies: Bodies, wanted: bool, distance: tuple[float, float], angle: float
    ) -> None:
        self.arrays, self.wanted, self.distance, self.angle = arrays, wanted, distance, angle
        self.lengths = bodies.lengths
        self.starts = bodies.centers + 0  # centers of mass at rest
        self.points = self.starts
        self.ahead = arrays.own(np.array([[1, 0, 0]], np.float32))
        self.robot = arrays.own(np.arange(bodies.robots))
        self.offsets = arrays.zeros((POOL, 3), arrays.xp.float32)  # of the points from a start [body lengths]

    def draw(self, random: np.random.Generator) -> None:
        """New points. They have the height of the start, and depend on the generator alone."""
        if not self.wanted:
            return
        angle = random.uniform(-self.angle, self.angle, POOL)
        distance = random.uniform(*self.distance, POOL)
        offsets = np.stack([distance * np.cos(angle), distance * np.sin(angle), np.zeros(POOL)], axis=1)
        self.offsets[:] = self.arrays.own(offsets.astype(np.float32))  # in place, since a graph may read it

    def assign(self, which: Any, episode: Any) -> None:
        """The targets of those episodes, (n,), for the robots of the mask `which`."""
        if not self.wanted:
            return
        offsets = self.offsets[(self.robot * 7919 + episode * 104729) % POOL]  # primes: all points have their turn
        points = self.starts + offsets * self.lengths[:, None]
        self.points = self.arrays.xp.where(which[:, None], points, self.points)

    def remaining(self, center: Any) -> Any:
        """The way to go, (n,) [m]. Along x it begins at 0 and falls."""
        if not self.wanted:
            return self.starts[:, 0] - center[:, 0]
        return self._lengths_of(self.points - center)

    def direction(self, center: Any) -> Any:
        """Unit vectors in the world, (n, 3)."""
        if not self.wanted:
            return self.ahead + 0 * center
        way = self.points - center
        return way / (self._lengths_of(way) + 1e-9)[:, None]

    def _lengths_of(self, vectors: Any) -> Any:
        xp = self.arrays.xp
        return xp.sqrt(xp.sum(vectors * vectors, 1))
