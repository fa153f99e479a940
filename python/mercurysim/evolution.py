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
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _mercury
from ._custom import PREFIX, Kind, Population, Scoring, Selection, Values, name_of
from ._mercury import Assessed, Environment, Genome, Genomes, InputError, Result, Robot

if TYPE_CHECKING:
    from typing_extensions import Unpack

__all__ = ["Assessed", "Genome", "Genomes", "Population", "Run", "Search", "Settings", "Table", "resume", "start"]

_cpp: Any = _mercury  # has classes for this file alone, which its stubs leave out

Table = dict[str, NDArray[Any]]  # columns of equal length by name; pandas.DataFrame(table) makes a frame


Function = Callable[[Values], ArrayLike]  # an objective: scores of arrays (robots, trials)


class Settings(TypedDict, total=False):
    """How robots are searched: the options of `mercury evolve`, all of them optional."""

    # Formulas of quantities, or functions of them (docs/python.md), more is better; default "distance". "python:NAME" is
    # an objective whose scores come by tell().
    objective: str | Function | Sequence[str | Function]
    # "afpo" (default), "ga", "alps", "nsga2", "map-elites", "novelty", "neat", "cma-es", "sep-cma-es", "cma-me", "random"; an
    # object, a class or a function (docs/python.md); "python:NAME" for an optimizer that gives its genomes.
    algorithm: str | object
    # Of map-elites, novelty, cma-me, and of algorithms in Python that keep a map.
    axes: Sequence[str | tuple[str] | tuple[str, float, float] | tuple[str, float, float, int]]
    population: int  # robots that live on after each generation; of cma-es by default 4 + 3 ln n
    children: int  # born in a generation; 0 = as many as the population
    generations: int  # after the first, random one
    mutation: float  # strength of mutations
    muscle_adaptation: bool  # each robot has a step of its own for its muscles, which adapts itself
    muscle_tail: int  # steps of muscles are of Student's t with that many degrees of freedom; 1 = Cauchy, 0 = normal
    brain_growth: bool  # neurons and connections come and go (NEAT); else weights alone change
    new_neurons: float  # share of the mutations that split a connection by a neuron, where brains grow
    new_connections: float  # share of the mutations that add a connection
    recurrence: float  # share of these that feed back
    first_connections: float  # share of the senses to which each output of a minimal brain is connected
    tournament: int  # robots among which the best becomes a parent
    elites: float  # ga: share that lives on unconditionally
    crossover: float  # share of the children with two parents
    niches: int  # map-elites: cells of equal size in place of the axes' cells
    neighbors: int  # novelty: nearest robots whose mean distance counts
    archived: int  # novelty: robots of each generation that come into the archive
    age_layers: int  # alps
    age_gap: int  # alps: generations below which robots are in the lowest layer
    islands: int  # ga, afpo, alps, nsga2, neat, random: into which the population is split
    migration_interval: int  # generations from one migration between islands to the next; 0 = none
    migrants: int  # best robots of each island whose copies replace the worst of the next one
    species_distance: float  # neat: distance of brains below which robots are of one species
    species: int  # neat: at most
    stagnation: int  # neat: generations without a better robot after which a species dies out; 0 = none does
    pipelined: bool  # children of a generation are made while the one before is tried
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
    upright: bool
    racing: bool  # stop robots early that are clearly behind
    confirm: bool  # best/ waits for checks of champions, which `mercury evolve --resume` makes
    environment: Environment | str | None  # default: the one that the robots are made for
    solver: str  # "force" or "xpbd"
    dt: float  # [s]
    damping: float  # [1/s]
    device: object  # as of Batch
    threads: int


def _functions(objective: Any) -> dict[str, Function]:
    """Those of the objectives that are functions, by their names in files."""
    given = [objective] if isinstance(objective, str) or callable(objective) else list(objective or [])
    functions: dict[str, Function] = {}
    for function in given:
        if not callable(function):
            continue
        if name_of(function) in functions:
            raise InputError(f"objective: two functions have the name {function.__name__}; give them different ones")
        functions[name_of(function)] = function
    return functions


def _named(settings: Mapping[str, Any]) -> tuple[dict[str, Any], Selection | None, Scoring | None]:
    """Settings in which functions and objects have the names that files have, and what they stand for."""
    named = dict(settings)
    objectives = named.get("objective", "distance")
    functions = _functions(objectives)
    if isinstance(objectives, str) or callable(objectives):
        objectives = [objectives]
    objectives = [objective if isinstance(objective, str) else name_of(objective) for objective in objectives]
    if "objective" in named:
        named["objective"] = objectives
    scoring = Scoring(objectives, functions) if any(name.startswith(PREFIX) for name in objectives) else None
    algorithm = named.get("algorithm", "")
    selection = None
    if not isinstance(algorithm, str):
        selection = Selection(algorithm, int(named.get("seed", 1)))
        named["algorithm"] = selection.name
    return named, selection, scoring


def _require_names(what: str, given: Iterable[str], known: Iterable[str]) -> None:
    for name in given:
        if name not in known:
            raise InputError(f"{what}: the run has {', '.join(known) or 'none of a program'}, not {name}")


def start(
    folder: str | os.PathLike[str],
    robots: str | type | Robot | Iterable[Robot] = "voxel",
    parameters: dict[str, Any] | None = None,
    *,
    genes: str = "body",
    force: bool = False,
    **settings: Unpack[Settings],
) -> Run:
    """Makes the folder of a new run, whose first generation go_on(), advance(), or ask() and tell() try.

    robots, parameters, genes: as of Genomes, what the search begins with and what changes. settings: see Settings.
    force: replaces a run that is in the folder.

    Raises InputError for what cannot be used, also a folder that is not empty.
    """
    named, selection, scoring = _named(settings)
    search = _cpp._Search(folder, robots, parameters, genes, force, named, selection, scoring)
    return Run(folder, genomes=robots if isinstance(robots, type) else None, _search=search)


def resume(
    folder: str | os.PathLike[str],
    generations: int | None = None,
    *,
    device: object = None,
    repeat: int | None = None,
    genomes: type | None = None,
    algorithm: object = None,
    objective: Function | Sequence[str | Function] | None = None,
) -> Run:
    """Opens a run to go on with it, as `mercury evolve --resume` does. `generations` raises how many it has.

    genomes, algorithm, objective: those in Python that the run was started with.
    repeat: the generation from which ask(), assess() and tell() repeat what the run has, without trying a robot again. A
    program that does the same as before, as an optimizer with a seed does, comes so to where it was; 0 = all of it.

    Raises InputError for a folder that is no run, or that another process writes, and for parts that the run does not
    have.
    """
    settings = _cpp._History(folder, None).settings()
    kind = None if genomes is None else Kind(genomes)
    if kind is not None:
        _require_names("genomes", [kind.name], [settings["robots"]])
    selection = None if algorithm is None else Selection(algorithm, settings["seed"])
    if selection is not None:
        _require_names("algorithm", [selection.name], [settings["algorithm"]])
    functions = _functions(objective)
    custom = [name for name in settings["objective"] if name.startswith(PREFIX)]
    _require_names("objective", functions, custom)
    scoring = Scoring(settings["objective"], functions) if custom else None
    search = _cpp._Search.resume(folder, generations, device, repeat, kind, selection, scoring)
    return Run(folder, genomes=genomes, _search=search)


def _hash_of(result: Result) -> int:
    """Of its trials, as in lineage.csv."""
    hashes = [trial.hash or 0 for trial in result.trials]
    return hashes[0] if len(hashes) == 1 else int(_cpp._hash_of_trials(hashes))


class _Asked:
    """What runs in a folder and searches in memory share: genomes are asked for, tried by the program, and scored."""

    def _opened(self) -> Any:
        raise NotImplementedError

    @property
    def generation(self) -> int:
        """How many generations have scores: the number of the one that ask(), assess() and tell() are about."""
        return int(self._opened().next_generation)

    def ask(self) -> list[Genome]:
        """The genomes of the next generation, by the algorithm of the settings; the same until tell() is called."""
        return list(self._opened().ask())

    def assess(self, genomes: Iterable[Genome | Robot] | None = None) -> Assessed:
        """Tries genomes, of ask() or of your own, as the settings say; None = those of ask(). tell() takes the result.

        Robots are genomes where the robots of the search are "python:NAME". Ctrl-C ends it.
        """
        assessed: Assessed = self._opened().assess(None if genomes is None else list(genomes))
        return assessed

    def tell(
        self,
        scores: ArrayLike | Assessed,
        results: Sequence[Result] | None = None,
        *,
        genomes: Iterable[Genome | Robot] | None = None,
        parents: Sequence[Sequence[int]] | None = None,
        living: Sequence[int] | None = None,
    ) -> None:
        """Says how robots did, which ends the generation: those of ask(), or `genomes` that another optimizer made.

        scores: what assess() gave, or in the order of the genomes a score each, or a row of them for several objectives;
        more is better. NaN and infinities are those of robots that failed.
        results: of evaluate(), where tables and the axes of a map find their quantities.
        parents: of genomes that were not asked for, at most two ids each; None = they have none.
        living: ids of those that live on, the best first; None = those that the algorithm chooses. Ids count all robots
        in the order of their birth, these included.

        Of a run, the generation is in its folder when this returns.
        """
        search = self._opened()
        assessed = scores if isinstance(scores, Assessed) else self._assessed(scores, results, genomes)
        lines = None if parents is None else [[int(parent) for parent in row] for row in parents]
        search.tell(assessed, lines, None if living is None else [int(id) for id in living])

    def _assessed(
        self, scores: ArrayLike, results: Sequence[Result] | None, genomes: Iterable[Genome | Robot] | None
    ) -> Assessed:
        search = self._opened()
        numbers = np.asarray(scores, float)
        rows = np.array(numbers[:, None] if numbers.ndim == 1 else numbers)  # a copy
        if rows.ndim != 2 or rows.shape[1] != search.objectives:
            raise InputError(f"scores: the shape {numbers.shape} is not accepted; give a score per genome and objective")
        values: list[list[float]] = []
        hashes: list[int] = []
        fates, problems = ["failed"] * len(rows), ["its score is not a finite number"] * len(rows)
        if results is not None:
            if len(results) != len(rows):
                raise InputError(f"results: {len(results)} of them and {len(rows)} scores; give one per genome")
            names = _cpp._quantities()
            for i, result in enumerate(results):
                quantities = result.quantities
                values.append([quantities.get(name, np.nan) for name in names])
                if result.failure is not None or result.exploded:
                    rows[i] = np.nan
                    fates[i], problems[i] = ("failed", result.failure) if result.failure else ("exploded", "")
            if any(result.hash is not None for result in results):
                hashes = [_hash_of(result) if result.failure is None else 0 for result in results]
        elif search.needs_values:
            raise InputError("results: map-elites, novelty and cma-me need them, and what else has axes")
        assessed: Assessed = search.scored(
            None if genomes is None else list(genomes), rows.tolist(), values, fates, problems, hashes
        )
        return assessed


class Run(_Asked):
    """A run folder, to read it, also while another process or thread adds to it, and to go on with it.

    What it says is as of the last refresh(); advance(), go_on() and tell() refresh by themselves. genomes: the class of
    the genomes, if that is one of yours.
    """

    def __init__(self, folder: str | os.PathLike[str], *, genomes: type | None = None, _search: Any = None) -> None:
        self._folder = os.fspath(folder)
        self._kind = None if genomes is None else Kind(genomes)
        self._history = _cpp._History(folder, self._kind)
        self._search = _search

    def _opened(self) -> Any:
        if self._search is None:
            self._search = _cpp._Search.resume(self._folder, None, None, None, self._kind, None, None)
        return self._search

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
    def genomes(self) -> Genomes:
        """The genomes among which it searches."""
        genomes: Genomes = self._history.genomes(self._kind)
        return genomes

    @property
    def is_over(self) -> bool:
        """Whether all its generations are there; of a run that is repeated, whether they are all repeated."""
        if self._search is not None:
            return bool(self._search.is_over)
        return len(self.generations()["generation"]) > int(self.settings["generations"])

    def refresh(self) -> bool:
        """Reads generations that were added since. Returns whether there were any."""
        return bool(self._history.refresh())

    def advance(self) -> bool:
        """Makes, tries and selects one generation. Returns False if all are there.

        Ctrl-C ends it, and the run is as it was before. After the last one, charts, champions and tables are in the folder.
        """
        advanced = self._advance()
        if advanced and self.is_over:
            self._search.write_all()
        return advanced

    def _advance(self) -> bool:
        advanced = bool(self._opened().advance())
        self.refresh()
        return advanced

    def tell(
        self,
        scores: ArrayLike | Assessed,
        results: Sequence[Result] | None = None,
        *,
        genomes: Iterable[Genome | Robot] | None = None,
        parents: Sequence[Sequence[int]] | None = None,
        living: Sequence[int] | None = None,
    ) -> None:
        super().tell(scores, results, genomes=genomes, parents=parents, living=living)
        self.refresh()
        if self.is_over:
            self._search.write_all()

    tell.__doc__ = _Asked.tell.__doc__

    def go_on(self, callback: Callable[[Run], object] | None = None) -> Run:
        """All generations that are left. After each one `callback(run)` is called; if it returns False, the run stops.

        Charts, champions and tables are in the folder when it returns.
        """
        try:
            while self._advance():
                if callback is not None and callback(self) is False:
                    break
        finally:
            if self._search is not None:
                self._search.write_all()
        return self

    def close(self) -> None:
        """Writes charts and tables, and lets another process go on with the run."""
        if self._search is not None:
            self._search.write_all()
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
        the living; of neat species, the number of those into which the living are divided; of a map cells (filled), coverage
        and qd_score (the sum of their scores); best_of_island_0 and so on, if there are several; and seconds."""
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


class Search(_Asked):
    """An evolution in memory, whose robots a program tries itself.

        search = evolution.Search("voxel", population=64, seed=1)
        for _ in range(20):
            robots = [genome.robot() for genome in search.ask()]
            search.tell([result.distance for result in mercurysim.evaluate(robots, 5)])
        best = search.best().robot("best")

    robots, parameters, genes: as of Genomes. settings: with scores of tell(), `objective` says only how many a robot has,
    and those of trials are not used. Raises InputError for what cannot be used.
    """

    def __init__(
        self,
        robots: str | type | Robot | Iterable[Robot] = "voxel",
        parameters: dict[str, Any] | None = None,
        *,
        genes: str = "body",
        **settings: Unpack[Settings],
    ) -> None:
        named, selection, scoring = _named(settings)
        self._search = _cpp._Search(None, robots, parameters, genes, False, named, selection, scoring)

    def _opened(self) -> Any:
        return self._search

    def living(self) -> list[tuple[list[float], Genome]]:
        """Scores and genomes of those that live, the best first."""
        return list(self._search.living())

    def best(self) -> Genome:
        """The best genome that lives. Raises IndexError before the first tell()."""
        living = self.living()
        if not living:
            raise IndexError("call ask() and tell() first")
        return living[0][1]
