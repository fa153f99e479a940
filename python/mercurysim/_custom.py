# SPDX-License-Identifier: Apache-2.0
"""Custom parts of an evolution: objectives, genomes and algorithms in Python (docs/python.md), as the module in C++ calls
them. Files name a part by the name of its class or function, as "python:Worm".
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _mercury
from ._mercury import Genome, InputError, Robot

_cpp: Any = _mercury

PREFIX = "python:"

Values = dict[str, NDArray[np.float64]]  # (robots, trials) by the name of the quantity


def name_of(part: object) -> str:
    """The name by which files know a class, a function, or an object by its class."""
    name = getattr(part, "__name__", None) or type(part).__name__
    return PREFIX + (re.sub(r"[^A-Za-z0-9._-]", "", name)[:100] or "part")


class Kind:
    """Genomes that are objects of a class."""

    def __init__(self, genome_class: Any) -> None:
        wanted = ("random", "mutate", "robot", "to_json", "from_json")
        missing = [name for name in wanted if not callable(getattr(genome_class, name, None))]
        if missing:
            raise TypeError(
                f"{name_of(genome_class)[len(PREFIX):]} lacks {', '.join(missing)}; genomes have random(rng) and "
                "from_json(data) as class methods, mutate(strength, rng), robot() and to_json()"
            )
        self.genome_class = genome_class
        self.name = name_of(genome_class)

    def random(self, seed: int, index: int) -> tuple[str, Robot | None, str]:
        """The genome as text, its robot, and why it has none."""
        return self._written(self.genome_class.random(np.random.default_rng([seed, index])))

    def mutate(self, text: str, strength: float, seed: int) -> tuple[str, Robot | None, str]:
        return self._written(self._read(text).mutate(strength, np.random.default_rng(seed)))

    def cross(self, text: str, other: str, seed: int) -> tuple[str, Robot | None, str]:
        genome = self._read(text)
        if hasattr(genome, "cross"):
            genome = genome.cross(self._read(other), np.random.default_rng(seed))
        return self._written(genome)

    def _read(self, text: str) -> Any:
        return self.genome_class.from_json(json.loads(text))

    def _written(self, genome: Any) -> tuple[str, Robot | None, str]:
        """The robot is that of the text, so that a run that goes on has no other one."""
        text = json.dumps(genome.to_json(), allow_nan=False, separators=(",", ":"))
        try:
            robot = self._read(text).robot()
        except InputError as error:
            return text, None, str(error) or "has no robot"
        if not isinstance(robot, Robot):
            raise TypeError(f"{self.name[len(PREFIX):]}.robot() gave a {type(robot).__name__}; give a Robot")
        return text, robot, ""


class Scoring:
    """Objectives, some of which are functions."""

    def __init__(self, names: Sequence[str], functions: Mapping[str, Callable[[Values], Any]]) -> None:
        self.names = list(names)
        self.functions = dict(functions)

    def __call__(
        self, values: NDArray[np.float64], mean: bool
    ) -> list[tuple[list[float], list[float], list[float]] | None]:
        """Scores and quartiles per robot, for each objective that is a function. values: (robots, trials, quantities)."""
        values.flags.writeable = False
        columns = {name: values[:, :, q] for q, name in enumerate(_cpp._quantities())}
        return [self._scores(name, columns, values.shape[:2], mean) if name.startswith(PREFIX) else None for name in self.names]

    def _scores(
        self, name: str, columns: Values, shape: tuple[int, ...], mean: bool
    ) -> tuple[list[float], list[float], list[float]]:
        if name not in self.functions:
            raise InputError(f"objective: {name} is a function of a program; give it to resume(), as objective=")
        scores = np.asarray(self.functions[name](columns), float)
        if scores.shape == shape[:1]:
            return scores.tolist(), [], []
        if scores.shape != shape:
            raise InputError(
                f"objective: {name} gave an array of the shape {scores.shape}; give one of {shape}, or of {shape[:1]}"
            )
        if shape[1] == 1:
            return scores[:, 0].tolist(), [], []
        spread = np.full((3, shape[0]), np.nan)
        known = np.isfinite(scores).all(axis=1)
        rows = scores[known]
        if mean:
            error = rows.std(axis=1, ddof=1) / np.sqrt(shape[1])
            spread[:, known] = rows.mean(axis=1), rows.mean(axis=1) - error, rows.mean(axis=1) + error
        elif len(rows) > 0:
            spread[:, known] = np.quantile(rows, [0.5, 0.25, 0.75], axis=1)
        return spread[0].tolist(), spread[1].tolist(), spread[2].tolist()


@dataclass(frozen=True, eq=False)
class Population:
    """Robots of a run, as an algorithm in Python sees them: arrays and lists with one element per robot."""

    ids: NDArray[np.int64]
    generations: NDArray[np.int64]  # in which they were born
    line_began: NDArray[np.int64]  # the generation in which the oldest ancestor was drawn
    scores: NDArray[np.float64]  # (robots, objectives), more is better; -inf for robots that are not sound
    fates: list[str]  # "sound", ...
    parents: list[list[int]]  # ids
    genomes: list[Genome | None]  # None in what learn() is given when a run goes on
    values: NDArray[np.float64]  # (robots, quantities)

    def __len__(self) -> int:
        return len(self.ids)

    @property
    def score(self) -> NDArray[np.float64]:
        """Of the first objective."""
        return self.scores[:, 0]

    @property
    def quantities(self) -> dict[str, NDArray[np.float64]]:
        """An array per quantity, of all trials together; NaN where a robot has none."""
        return {name: self.values[:, q] for q, name in enumerate(_cpp._quantities())}

    def best_first(self) -> NDArray[np.intp]:
        """Indices of the robots, a higher first score before a lower one, then the older robot."""
        order: NDArray[np.intp] = np.lexsort((self.ids, -self.score))
        return order


class Selection:
    """An algorithm: an object, a class without arguments, or a function that chooses parents."""

    def __init__(self, algorithm: Any, seed: int) -> None:
        self.name = name_of(algorithm)
        self.algorithm = algorithm() if isinstance(algorithm, type) else algorithm
        self.seed = seed
        self._parents = getattr(self.algorithm, "parents", self.algorithm)
        if not callable(self._parents):
            raise TypeError(f"algorithm: {self.name[len(PREFIX):]} has no parents(living, children, rng)")

    def parents(self, living: Population, children: int, seed: int) -> list[list[int]]:
        rows: list[list[int]] = []
        for row in self._parents(living, children, np.random.default_rng(seed)):
            indices = [int(index) for index in np.atleast_1d(np.asarray(row, dtype=np.int64))]
            if len(indices) > 2:
                raise InputError(f"algorithm: {self.name} gave a child {len(indices)} parents; give at most two")
            rows.append(self._checked(indices, len(living), "parents"))
        return rows

    def survivors(self, pool: Population, living: int) -> list[int] | None:
        if not hasattr(self.algorithm, "survivors"):
            return None
        rng = np.random.default_rng([self.seed, int(pool.generations.max(initial=0)), 1])
        chosen = np.asarray(self.algorithm.survivors(pool, living, rng))
        indices = self._checked([int(index) for index in chosen], len(pool), "survivors")
        if len(set(indices)) < len(indices):
            raise InputError(f"algorithm: {self.name} lets a robot live on twice")
        return indices

    def learn(self, born: Population, seed: int) -> None:
        if hasattr(self.algorithm, "learn"):
            self.algorithm.learn(born, np.random.default_rng(seed))

    def _checked(self, indices: list[int], size: int, what: str) -> list[int]:
        for index in indices:
            if not 0 <= index < size:
                raise InputError(f"algorithm: {self.name} gave {what} with the index {index}; there are {size} robots")
        return indices
