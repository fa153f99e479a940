# SPDX-License-Identifier: Apache-2.0
"""Objectives, genomes and algorithms in Python."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError, evolution

SIZE = {"voxels": (4, 3, 2)}
SETTINGS = {"population": 6, "generations": 3, "seconds": 0.5, "dt": 2e-3, "seed": 3, "device": "cpu"}
UNTRIED = {**SETTINGS, "seconds": 0.02, "dt": 1e-2, "trials": 1}  # where only bodies count


def lineage(run):
    return (Path(run.folder) / "lineage.csv").read_text()


# --- Objectives


def cheap(values):
    return values["distance"] - 0.01 * values["work"]


def small(values):
    return -values["masses"]


def test_a_function_gives_the_lineage_of_the_formula(tmp_path):
    formula = evolution.start(tmp_path / "formula", "voxel", SIZE, objective="distance - 0.01 * work", **SETTINGS).go_on()
    function = evolution.start(tmp_path / "function", "voxel", SIZE, objective=cheap, **SETTINGS).go_on()
    assert lineage(function) == lineage(formula)  # the quartiles of three trials included
    assert function.settings["objective"] == ["python:cheap"]


def test_a_function_sees_all_trials_of_a_generation_and_may_take_their_worst(tmp_path):
    shapes = []

    def worst(values):
        shapes.append({name: column.shape for name, column in values.items()})
        with pytest.raises(ValueError, match="read-only"):
            values["distance"][:] = 0
        return values["distance"].min(axis=1)

    run = evolution.start(tmp_path / "swim", "voxel", SIZE, objective=worst, **SETTINGS).go_on()
    assert len(shapes) == 4 and set(shapes[0].values()) == {(6, 3)}
    assert set(shapes[0]) == set(run.individuals()) & set(shapes[0])
    robots = [run.robot(i) for i in range(6)]
    results = mercurysim.evaluate(robots, 0.5, dt=2e-3, trials=3, device="cpu", seed=3)
    smallest = [min(trial.distance for trial in result.trials) for result in results]
    assert run.individuals()["score"][:6] == pytest.approx(smallest, rel=1e-6)


def test_functions_and_formulas_are_objectives_side_by_side(tmp_path):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, objective=["distance", small], **SETTINGS).go_on()
    table = run.individuals()
    assert np.array_equal(table["score"], table["distance"]) and np.array_equal(table["score2"], -table["masses"])
    assert run.settings["objective"] == ["distance", "python:small"] and run.settings["algorithm"] == "nsga2"


def test_a_score_that_is_no_number_makes_a_robot_undefined(tmp_path):
    def root(values):
        return np.sqrt(values["speed_x"])

    with np.errstate(invalid="ignore"):
        run = evolution.start(tmp_path / "swim", "voxel", SIZE, objective=root, **{**SETTINGS, "trials": 1}).go_on()
    table = run.individuals()
    backward = table["speed_x"] < 0
    assert backward.any() and (table["fate"][backward] == "undefined").all()
    assert np.array_equal(table["score"][~backward], np.sqrt(table["speed_x"][~backward]))


def test_a_run_goes_on_with_its_function_alone(tmp_path):
    whole = evolution.start(tmp_path / "whole", "voxel", SIZE, objective=small, **UNTRIED).go_on()
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, objective=small, **UNTRIED)
    run.advance()
    run.close()
    with evolution.resume(tmp_path / "swim") as again, pytest.raises(InputError, match="python:small is a function"):
        again.advance()
    with pytest.raises(InputError, match="objective: the run has python:small, not python:cheap"):
        evolution.resume(tmp_path / "swim", objective=cheap)
    with evolution.resume(tmp_path / "swim", objective=small) as again:
        again.go_on()
    assert lineage(run) == lineage(whole)


def test_exceptions_of_a_function_come_out_and_the_run_is_as_before(tmp_path):
    def broken(values):
        return 1 / 0

    def wide(values):
        return np.zeros(7)

    for function, error, message in ((broken, ZeroDivisionError, "division"), (wide, InputError, "the shape \\(7,\\)")):
        run = evolution.start(tmp_path / function.__name__, "voxel", SIZE, objective=function, **UNTRIED)
        with pytest.raises(error, match=message):
            run.advance()
        assert len(run) == 0 and run.generation == 0


def test_check_asks_for_a_formula(tmp_path, mercury):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, objective=small, **UNTRIED).go_on()
    program = mercury.__closure__[0].cell_contents
    refused = subprocess.run([program, "check", run.folder, "--robot", "best"], capture_output=True, text=True)
    assert refused.returncode == 2 and "python:small is a function of a program; give a formula" in refused.stderr
    checked = subprocess.run([program, "check", run.folder, "--robot", "best", "--objective", "-masses", "--device", "cpu"],
                             capture_output=True, text=True)
    assert "best" in checked.stdout + checked.stderr or "swim-" in checked.stdout


# --- Genomes


class Worm:
    """A row of voxels, of which each has a muscle or tissue."""

    def __init__(self, muscles):
        self.muscles = muscles

    @classmethod
    def random(cls, rng):
        return cls(rng.integers(1, 5, rng.integers(3, 7)).tolist())

    def mutate(self, strength, rng):
        muscles = list(self.muscles)
        for _ in range(round(strength)):
            muscles[rng.integers(len(muscles))] = int(rng.integers(1, 5))
        return Worm(muscles)

    def cross(self, other, rng):
        return Worm(self.muscles[: len(self.muscles) // 2] + other.muscles[len(other.muscles) // 2 :])

    def robot(self):
        if len(self.muscles) > 8:
            raise InputError("a worm has at most 8 voxels")
        return mercurysim.voxel(np.array(self.muscles, np.uint8)[:, None, None], edge=0.2)

    def to_json(self):
        return {"muscles": self.muscles}

    @classmethod
    def from_json(cls, data):
        return cls(data["muscles"])


WORMS = {**SETTINGS, "algorithm": "ga", "crossover": 0.5, "seed": 4}


@pytest.fixture(scope="module")
def worms(tmp_path_factory):
    run = evolution.start(tmp_path_factory.mktemp("runs") / "worms", Worm, **WORMS).go_on()
    run.close()
    return run


def test_objects_of_a_class_evolve(worms):
    table = worms.individuals()
    assert worms.settings["robots"] == "python:Worm" and len(worms) == 24
    assert (table["other_parent"] >= 0).any() and (table["fate"] == "sound").all()
    for id in range(24):
        muscles = worms.genome(id).data["muscles"]
        robot = worms.robot(id)
        assert len(robot.masses) == 4 * len(muscles) + 4 and robot.name == f"worms-{id}"
    child = int(np.flatnonzero(table["other_parent"] >= 0)[0])
    mother, father = (worms.genome(table[name][child]).data["muscles"] for name in ("parent", "other_parent"))
    born = worms.genome(child).data["muscles"]
    crossed = Worm(mother).cross(Worm(father), None).muscles
    assert len(born) == len(crossed) and np.count_nonzero(np.array(born) != crossed) <= 2


def test_a_run_of_a_class_goes_on_as_if_it_had_never_stopped(worms, tmp_path):
    run = evolution.start(tmp_path / "worms", Worm, **WORMS)
    run.advance()
    run.close()
    with evolution.resume(tmp_path / "worms", genomes=Worm) as again:
        again.go_on()
    assert lineage(run) == lineage(worms)


def test_programs_grow_the_robots_of_a_class(worms, mercury):
    best = worms.living()[0]
    rows = mercury("run", worms.folder, "--robot", best, "--device", "cpu", "--csv", "-").splitlines()
    row = dict(zip(rows[0].split(","), rows[1].split(",")))
    assert float(row["distance"]) == pytest.approx(worms.individuals()["distance"][best], rel=1e-6)
    assert "python:Worm robots, which a program makes" in mercury("info", worms.folder)
    program = mercury.__closure__[0].cell_contents
    result = subprocess.run([program, "evolve", worms.folder, "--resume"], capture_output=True, text=True)
    assert result.returncode == 2 and "has the genomes python:Worm of a program in Python" in result.stderr


def test_genomes_of_a_class_are_changed_by_it(worms):
    genomes = evolution.Genomes(Worm)
    worm = genomes.random(seed=1)
    assert worm == genomes.random(seed=1) and worm != genomes.random(seed=1, index=1)
    mutant = worm.mutate(strength=4, seed=2)
    assert genomes.decode(mutant.encode()).data == worm.mutate(strength=4, seed=2).data != worm.data
    assert evolution.Run(worms.folder, genomes=Worm).genome(3).mutate(seed=1).data
    with pytest.raises(InputError, match="python:Worm are made by a program"):
        evolution.Run(worms.folder).genome(3).mutate(seed=1)
    with pytest.raises(InputError, match="is not of a program"):
        evolution.Genomes("voxel").random().data  # noqa: B018


def test_genomes_without_a_robot_fail(tmp_path):
    class Long(Worm):
        @classmethod
        def random(cls, rng):
            return cls([1] * int(rng.integers(7, 11)))

    run = evolution.start(tmp_path / "worms", Long, **{**UNTRIED, "population": 16, "generations": 0}).go_on()
    fates = run.individuals()["fate"].tolist()
    lengths = [len(run.genome(id).data["muscles"]) for id in range(len(run))]
    assert fates == ["failed" if length > 8 else "sound" for length in lengths] and {"failed", "sound"} == set(fates)
    with pytest.raises(InputError, match="a worm has at most 8 voxels"):
        run.robot(fates.index("failed"))


def test_classes_that_are_no_genomes_are_refused(tmp_path):
    class Fish:
        def mutate(self, strength, rng):
            return self

    with pytest.raises(TypeError, match="Fish lacks random, robot, to_json, from_json"):
        evolution.start(tmp_path / "fish", Fish)
    with pytest.raises(InputError, match="genomes: the run has voxel, not python:Worm"):
        evolution.start(tmp_path / "voxels", "voxel", SIZE, **UNTRIED).close()
        evolution.resume(tmp_path / "voxels", genomes=Worm)


def test_exceptions_of_a_class_come_out(tmp_path):
    class Broken(Worm):
        def mutate(self, strength, rng):
            raise ZeroDivisionError("no mutant")

    run = evolution.start(tmp_path / "worms", Broken, **{**UNTRIED, "algorithm": "ga"})
    run.advance()
    with pytest.raises(ZeroDivisionError, match="no mutant"):
        run.advance()
    assert len(run) == 6 and run.generation == 1


# --- Algorithms


class Truncation:
    """The better half are parents, and only children live on."""

    def parents(self, living, children, rng):
        better = living.best_first()[: len(living) // 2]
        return rng.choice(better, children)

    def survivors(self, pool, living, rng):
        order = pool.best_first()
        return order[order >= living][:6]


def test_an_algorithm_says_who_lives_and_who_has_children(tmp_path):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=Truncation, **SETTINGS).go_on()
    table = run.individuals()
    assert run.settings["algorithm"] == "python:Truncation" and len(run) == 24
    for generation in range(1, 4):
        born = np.flatnonzero(table["generation"] == generation)
        before = np.flatnonzero(table["generation"] == generation - 1)
        better = before[np.argsort(-table["score"][before], kind="stable")][:3]
        assert set(table["parent"][born]) <= set(better)
        assert (table["died"][before] == generation).all()
    last = np.flatnonzero(table["generation"] == 3)
    assert run.living() == last[np.argsort(-table["score"][last], kind="stable")].tolist()


def test_an_algorithm_goes_on_as_if_it_had_never_stopped(tmp_path):
    whole = evolution.start(tmp_path / "whole", "voxel", SIZE, algorithm=Truncation(), **UNTRIED).go_on()
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=Truncation(), **UNTRIED)
    run.advance(), run.advance()
    run.close()
    with evolution.resume(tmp_path / "swim") as again, pytest.raises(InputError, match="python:Truncation is a program"):
        again.advance()
    with evolution.resume(tmp_path / "swim", algorithm=Truncation()) as again:
        again.go_on()
    assert lineage(run) == lineage(whole)
    other = evolution.start(tmp_path / "other", "voxel", SIZE, algorithm=Truncation(), **{**UNTRIED, "seed": 4}).go_on()
    assert other.individuals()["parent"].tolist() != whole.individuals()["parent"].tolist()


def test_a_function_chooses_parents_and_the_best_live(tmp_path):
    def oldest(living, children, rng):
        assert living.quantities["masses"].shape == (6,) and living.scores.shape == (6, 1)
        assert living.genomes[0].robot() and living.fates[0] == "sound"
        return [[int(np.argmin(living.ids))]] * (children - 1) + [[]]

    run = evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=oldest, objective="masses", **UNTRIED).go_on()
    table = run.individuals()
    assert (table["parent"][[11, 17, 23]] == -1).all()  # an empty list: a new random robot
    assert sorted(table["score"][run.living()]) == sorted(table["score"])[-6:]


def test_an_algorithm_with_axes_keeps_a_map(tmp_path):
    def any_of(living, children, rng):
        return rng.integers(len(living), size=(children, 2))

    run = evolution.start(tmp_path / "map", "voxel", SIZE, algorithm=any_of, axes=["masses:20:60:4"], **UNTRIED).go_on()
    table = run.individuals()
    cells = {min(3, max(0, int(masses - 20) // 10)) for masses in table["masses"][table["fate"] == "sound"]}
    assert run.generations()["cells"][-1] == len(cells) == len(run.living())
    assert run.generations()["coverage"][-1] == len(cells) / 4


def test_an_algorithm_learns_from_every_generation_also_when_a_run_goes_on(tmp_path):
    class Counting(Truncation):
        def __init__(self):
            self.seen = []

        def learn(self, born, rng):
            self.seen.append((born.ids.tolist(), born.score.tolist(), int(rng.integers(100))))

    first, second = Counting(), Counting()
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=first, **UNTRIED)
    run.advance(), run.advance()
    run.close()
    seen = list(first.seen)
    with evolution.resume(tmp_path / "swim", algorithm=second):
        assert second.seen == seen and len(seen) == 2 and seen[1][0] == list(range(6, 12))


@pytest.mark.parametrize(
    ("parents", "survivors", "message"),
    [
        (lambda living, children, rng: [[0, 1, 2]], None, "a child 3 parents"),
        (lambda living, children, rng: [[6]], None, "parents with the index 6; there are 6 robots"),
        (lambda living, children, rng: [[0]], lambda pool, living, rng: [0, 0], "live on twice"),
        (lambda living, children, rng: [[0]], lambda pool, living, rng: [99], "survivors with the index 99"),
    ],
)
def test_what_an_algorithm_cannot_mean_is_refused(tmp_path, parents, survivors, message):
    class Wrong:
        pass

    Wrong.parents = staticmethod(parents)
    if survivors:
        Wrong.survivors = staticmethod(survivors)
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=Wrong, **UNTRIED)
    with pytest.raises(InputError, match=message):
        run.advance()
        run.advance()


def test_parts_in_python_are_refused_where_they_cannot_work(tmp_path):
    for settings, message in (
        ({"algorithm": "python:"}, "algorithm: .* give python:NAME"),
        ({"objective": "python:a b"}, "objective: .* give python:NAME"),
        ({"objective": small, "racing": True}, "racing: compares robots during their trials"),
        ({"objective": small, "confirm": True}, "confirm: .* does not have the objective python:small"),
        ({"objective": [small, small]}, "two functions have the name small"),
    ):
        with pytest.raises(InputError, match=message):
            evolution.start(tmp_path / "swim", "voxel", SIZE, **settings)
        assert not (tmp_path / "swim").exists()
    with pytest.raises(TypeError, match="object has no parents"):
        evolution.start(tmp_path / "swim", "voxel", SIZE, algorithm=object())
