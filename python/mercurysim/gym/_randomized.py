# SPDX-License-Identifier: Apache-2.0
"""Parameters of the environment that differ from episode to episode."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import Batch, InputError
from ._arrays import Arrays

POOL = 4096  # draws per seed, which episodes take in turn
Range = tuple[float, float] | Callable[[np.random.Generator, int], npt.ArrayLike]


class Randomized:
    def __init__(self, arrays: Arrays, batch: Batch, ranges: Mapping[str, Range]) -> None:
        self.arrays, self.batch, self.ranges = arrays, batch, dict(ranges)
        self.pools: dict[str, npt.NDArray[np.float32]] = {}
        self.drawn: dict[str, Any] = {}  # by robot, for infos
        for name, range_ in self.ranges.items():
            if not callable(range_) and (len(range_) != 2 or not range_[0] <= range_[1]):
                raise InputError(f"randomize: {name}: give a range (least, most), or a function of a generator and n")
        self.draw(np.random.default_rng(0))
        self._set(np.arange(len(batch)), np.zeros(len(batch), np.int64))  # names and values are checked at once

    def draw(self, random: np.random.Generator) -> None:
        """New values for all episodes to come, which depend on the generator alone."""
        for name, range_ in self.ranges.items():
            values = range_(random, POOL) if callable(range_) else random.uniform(*range_, POOL)
            pool = np.asarray(values, np.float32)
            if pool.shape not in ((POOL,), (POOL, 3)):
                raise InputError(f"randomize: {name}: shape {pool.shape} is not accepted; n numbers, or (n, 3), are wanted")
            self.pools[name] = pool

    def assign(self, which: Any, episode: Any) -> None:
        """Those of these episodes, (n,), to the robots of the mask `which`."""
        if not self.ranges:
            return
        robots = np.flatnonzero(np.asarray(which.cpu() if self.arrays.is_torch else which))
        if len(robots) > 0:
            self._set(robots, np.asarray(episode.cpu() if self.arrays.is_torch else episode)[robots])

    def infos(self) -> dict[str, Any]:
        return {name: values + 0 for name, values in self.drawn.items()}

    def _set(self, robots: npt.NDArray[np.int64], episodes: npt.NDArray[np.int64]) -> None:
        if not self.ranges:
            return
        turns = (robots * 7919 + episodes * 104729) % POOL  # primes: all draws have their turn
        values = {name: pool[turns] for name, pool in self.pools.items()}
        self.batch.set_environments(
            robots, **{name: value[:, None] if name == "gravity" and value.ndim == 1 else value for name, value in values.items()}
        )
        for name, value in values.items():
            if name not in self.drawn:
                self.drawn[name] = self.arrays.own(np.zeros((len(self.batch), *value.shape[1:]), np.float32))
            self.drawn[name][robots] = self.arrays.own(value)
