# SPDX-License-Identifier: Apache-2.0
"""Evolution of robots: run folders, and searches that a program steers itself (docs/evolution.md).

    from mercurysim import evolution

    run = evolution.start("swim", "voxel", population=64, generations=20)
    run.go_on(lambda run: print(run.generations()["best_score"][-1]))
    run.best().save("best.json")

A run folder is that of `mercury evolve`, which goes on with it by --resume, and the reverse. Robots of a run have ids, in
the order of birth.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _mercury
from ._mercury import Environment, Genome, Genomes, InputError, Result, Robot

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Genome", "Genomes", "Run", "Search", "Settings", "Table", "resume", "start"]

_cpp: Any = _mercury  # has classes for this file alone, which its stubs leave out

Table = dict[str, NDArray[Any]]  # columns of equal length by name; pandas.DataFrame(table) makes a frame


class Settings(TypedDict, total=False):
    """How robots are searched: the options of `mercury evolve`, all of them optional."""

    objective: str | Sequence[str]  # formulas of quantities, more is better; default "distance"
    # "afpo" (default), "ga", "alps", "nsga2", "map-elites", "novelty", "cma-es", "sep-cma-es", "cma-me", "random".
    algorithm: str
    # Of map-elites, novelty and cma-me.
    axes: Sequence[str | tuple[str] | tuple[str, float, float] | tuple[str, float, float, int]]
    population: int  # robots that live on after each generation; of cma-es by default 4 + 3 ln n
    children: int  # born in a generation; 0 = as many as the population
    generations: int  # after the first, random one
    mutation: float  # strength of mutations
    tournament: int  # robots among which the best becomes a parent
    elites: float  # ga: share that lives on unconditionally
    crossover: float  # share of the children with two parents
    niches: int  # map-elites: cells of equal size in place of the axes' cells
    neighbors: int  # novelty: nearest robots whose mean distance counts
    archived: int  # novelty: robots of each generation that come into the archive
    age_layers: int  # alps
    age_gap: int  # alps: generations below which robots are in the lowest layer
    islands: int  # ga, afpo, alps, nsga2, random: into which the population is split
    migration_interval: int  # generations from one migration between islands to the next; 0 = none
    migrants: int  # best robots of each island whose copies replace the worst of the next one
    seed: int
    seconds: float  # of a trial, settling included [s]
    settle: float  # at its start; nothing is measured before [s]
    trials: int  # per robot, each with a jitter of its own
    jitter: float  # standard deviation of the masses at the start, per shortest rest length
    delay: float  # trials but the first start at random moments of the movement, up to here [s]
    noise: float  # standard deviation of stiffness and amplitude between trials
    damage: float  # share of the voxels that are missing in a trial
    strain_limit: float  # robots with a spring that is strained more rank after all sound ones
    strained_limit: float
    inverted_limit: float
    overlap_limit: float
    least_masses: float
    median: bool  # of the trials counts, not their mean
    mean: bool  # the mean counts, not the median; all else is as with `median`
    target_radius: float  # each trial starts this far from the target, in a random direction [m]
    target_spread: float  # or nearer by up to this share of it
    target_sphere: bool  # the direction may point up and down, too
    turned: bool  # each trial starts turned about the vertical by a random angle
    noise_per_trial: bool  # senses have other noise in each trial but the first
    folding: bool
    racing: bool  # stop robots early that are clearly behind
    confirm: bool  # best/ waits for checks of champions, which `mercury evolve --resume` makes
    environment: Environment | str | None  # default: the one that the robots are made for
    solver: str  # "force" or "xpbd"
    dt: float  # [s]
    damping: float  # [1/s]
    device: object  # as of Batch
    threads: int


def start(
    folder: str | os.PathLike[str],
    robots: str | Robot | Iterable[Robot] = "voxel",
    parameters: dict[str, Any] | None = None,
    *,
    genes: str = "body",
    force: bool = False,
    **settings: Unpack[Settings],
) -> Run:
    """Makes the folder of a new run, whose first generation go_on() or advance() tries.

    robots, parameters, genes: as of Genomes, what the search begins with and what changes. settings: see Settings.
    force: replaces a run that is in the folder.

    Raises InputError for what cannot be used, also a folder that is not empty.
    """
    search = _cpp._Search(folder, robots, parameters, genes, force, settings)
    return Run(folder, _search=search)


def resume(folder: str | os.PathLike[str], generations: int | None = None, *, device: object = None) -> Run:
    """Opens a run to go on with it, as `mercury evolve --resume` does. `generations` raises how many it has.

    Raises InputError for a folder that is no run, or that another process writes.
    """
    return Run(folder, _search=_cpp._Search.resume(folder, generations, device))


class Run:
    """A run folder, to read it, also while another process or thread adds to it, and to go on with it.

    What it says is as of the last refresh(); advance() and go_on() refresh by themselves.
    """

    def __init__(self, folder: str | os.PathLike[str], *, _search: Any = None) -> None:
        self._folder = os.fspath(folder)
        self._history = _cpp._History(folder)
        self._search = _search

    def __repr__(self) -> str:
        done, wanted = len(self.generations()["generation"]), self.settings["generations"] + 1
        return f"<Run {self._folder!r}: {done} of {wanted} generations, {len(self)} robots>"

    def __len__(self) -> int:
        """How many robots were born."""
        return len(self._history)

    @property
    def folder(self) -> str:
        """Where it is."""
        return self._folder

    @property
    def settings(self) -> dict[str, Any]:
        """What the run was started with."""
        settings: dict[str, Any] = self._history.settings()
        return settings

    @property
    def is_over(self) -> bool:
        """Whether all its generations are there."""
        return len(self.generations()["generation"]) > int(self.settings["generations"])

    def refresh(self) -> bool:
        """Reads generations that were added since. Returns whether there were any."""
        return bool(self._history.refresh())

    def advance(self) -> bool:
        """Makes, tries and selects one generation. Returns False if all are there.

        Ctrl-C ends it, and the run is as it was before.
        """
        if self._search is None:
            self._search = _cpp._Search.resume(self._folder, None, None)
        advanced = bool(self._search.advance())
        self.refresh()
        return advanced

    def go_on(self, callback: Callable[[Run], object] | None = None) -> Run:
        """All generations that are left. After each one `callback(run)` is called; if it returns False, the run stops.

        Charts, champions and tables are in the folder when it returns.
        """
        try:
            while self.advance():
                if callback is not None and callback(self) is False:
                    break
        finally:
            if self._search is not None:
                self._search.write_all()
        return self

    def close(self) -> None:
        """Lets another process go on with the run."""
        self._search = None

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def follow(self, period: float = 1.0, wait: Callable[[float], object] = time.sleep) -> Iterator[Run]:
        """Yields the run now, and again after generations that another process adds, until all are there.

        `period`: how often the folder is read [s]; wait(period) is called in between.
        """
        self.refresh()
        yield self
        while not self.is_over:
            wait(period)
            if self.refresh():
                yield self

    def robot(self, id: int) -> Robot:
        """The robot of an id, with its ancestry in Robot.origin. Raises IndexError, or InputError if it cannot be grown."""
        robot: Robot = self._history.robot(id)
        return robot

    def genome(self, id: int) -> Genome:
        """Its genome."""
        genome: Genome = self._history.genome(id)
        return genome

    def living(self) -> list[int]:
        """Ids of the robots that live after the last generation, the best first; of map-elites, the elites of the map."""
        return list(self._history.living())

    def elites(self, count: int | None = None) -> list[Robot]:
        """The robots that live, the best first, at most `count`; those that cannot be grown are left out."""
        robots: list[Robot] = []
        for id in self.living():
            if count is not None and len(robots) >= count:
                break
            try:
                robots.append(self.robot(id))
            except InputError:
                pass
        return robots

    def best(self) -> Robot:
        """The best robot that lives. Raises IndexError before the first generation."""
        living = self.living()
        if not living:
            raise IndexError(f"{self._folder}: the run has no generation yet")
        return self.robot(living[0])

    def lineage(self, id: int) -> list[int]:
        """The line of first parents, from the oldest ancestor to the robot itself."""
        return list(self._history.line_of(id))

    def individuals(self) -> Table:
        """One element per robot, by id: id, parent, other_parent (-1 = none), generation, died (the last generation in
        which it lived, -1 = it lives), line_began, island (if there are several), fate, score (score2, ... of further objectives), and all quantities.
        """
        table: Table = self._history.individuals()
        return table

    def generations(self) -> Table:
        """One element per generation: generation, born, living, best (an id), best_score, lower_quartile, median,
        upper_quartile and highest of the scores of the living (best_score2, ... of further objectives), how many of
        those born exploded, overstretched, too_small, undefined, stopped, failed; lines, the number of first ancestors of
        the living; of a map cells (filled), coverage and qd_score (the sum of their scores); best_of_island_0 and so on, if
        there are several; and seconds."""
        table: Table = self._history.generations()
        return table

    def frame(self) -> Any:
        """individuals() as a DataFrame of pandas, with the id as its index."""
        import pandas  # type: ignore[import-untyped, import-not-found, unused-ignore]

        return pandas.DataFrame(self.individuals()).set_index("id")

    def generation_frame(self) -> Any:
        """generations() as a DataFrame of pandas, with the generation as its index."""
        import pandas  # type: ignore[import-untyped, import-not-found, unused-ignore]

        return pandas.DataFrame(self.generations()).set_index("generation")


class Search:
    """An evolution in memory, whose robots a program tries itself.

        search = evolution.Search("voxel", population=64, seed=1)
        for _ in range(20):
            robots = [genome.robot() for genome in search.ask()]
            search.tell([result.distance for result in mercurysim.evaluate(robots, 5)])
        best = search.best().robot("best")

    robots, parameters, genes: as of Genomes. settings: `objective` says only how many scores a robot has, and those of
    trials are not used. Raises InputError for what cannot be used.
    """

    def __init__(
        self,
        robots: str | Robot | Iterable[Robot] = "voxel",
        parameters: dict[str, Any] | None = None,
        *,
        genes: str = "body",
        **settings: Unpack[Settings],
    ) -> None:
        self._search = _cpp._Search(None, robots, parameters, genes, False, settings)

    @property
    def generation(self) -> int:
        """How many generations have scores."""
        return int(self._search.next_generation)

    def ask(self) -> list[Genome]:
        """The genomes of the next generation; the same until tell() is called."""
        return list(self._search.ask())

    def tell(self, scores: ArrayLike, results: Sequence[Result] | None = None) -> None:
        """Says how they did, in their order: a score each, or a row of them for several objectives; more is better. NaN
        and infinities are those of robots that failed. `results` are those of evaluate(), where the axes of map-elites,
        novelty and cma-me find their quantities.
        """
        numbers = np.asarray(scores, float)
        rows = np.array(numbers[:, None] if numbers.ndim == 1 else numbers)  # a copy
        if rows.ndim != 2 or rows.shape[1] != self._search.objectives:
            raise InputError(f"scores: the shape {numbers.shape} is not accepted; give a score per genome and objective")
        values: list[list[float]] = []
        if results is not None:
            if len(results) != len(rows):
                raise InputError(f"results: {len(results)} of them and {len(rows)} scores; give one per genome")
            names = _cpp._quantities()
            for row, result in zip(rows, results):
                quantities = result.quantities
                values.append([quantities.get(name, np.nan) for name in names])
                if result.failure is not None or result.exploded:
                    row[:] = np.nan
        elif self._search.needs_values:
            raise InputError("results: map-elites, novelty and cma-me need them, for their axes")
        self._search.tell(rows.tolist(), values)

    def living(self) -> list[tuple[list[float], Genome]]:
        """Scores and genomes of those that live, the best first."""
        return list(self._search.living())

    def best(self) -> Genome:
        """The best genome that lives. Raises IndexError before the first tell()."""
        living = self.living()
        if not living:
            raise IndexError("call ask() and tell() first")
        return living[0][1]
