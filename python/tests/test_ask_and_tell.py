# SPDX-License-Identifier: Apache-2.0
"""Run folders whose robots a program asks for, tries and scores, or makes itself."""

import csv
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError, evolution
from mercurysim.bodies import eel

SIZE = {"voxels": (4, 3, 2)}
SETTINGS = {"population": 6, "generations": 3, "seconds": 0.5, "dt": 2e-3, "seed": 3, "device": "cpu"}


def lineage(folder):
    return (folder / "lineage.csv").read_text()


def hashes_in(folder):
    return [row["hash"] for row in csv.DictReader(lineage(folder).splitlines())]


def asked(folder, **settings):
    """A run whose every generation is asked for, assessed and scored."""
    run = evolution.start(folder, "voxel", SIZE, **{**SETTINGS, **settings})
    while not run.is_over:
        run.ask()
        run.tell(run.assess())
    return run


class Climber:
    """An optimizer of its own: normal numbers around the best so far. Its numbers follow from its seed."""

    def __init__(self, start, seed):
        self.best, self.score, self.rng = np.array(start), -np.inf, np.random.default_rng(seed)

    def ask(self):
        self.asked = self.best + self.rng.normal(size=(4, len(self.best)))
        return self.asked

    def tell(self, scores):
        if max(scores) > self.score:
            self.best, self.score = self.asked[np.argmax(scores)], max(scores)


def climb(run, generations=None):
    """Drives the run, or this number of generations of it."""
    eels = run.genomes.random()
    climber = Climber(eels.numbers(), seed=5)
    while not run.is_over and generations != 0:
        assessed = run.assess([eels.with_numbers(numbers) for numbers in climber.ask()])
        climber.tell(assessed.scores)
        run.tell(assessed)
        generations = None if generations is None else generations - 1
    return climber


CLIMB = {**SETTINGS, "genes": "muscles", "algorithm": "python:climber", "trials": 1}


@pytest.fixture(scope="module")
def climbed(tmp_path_factory):
    run = evolution.start(tmp_path_factory.mktemp("runs") / "eels", eel(), **CLIMB)
    climber = climb(run)
    run.close()
    return run, climber


def test_generations_that_are_asked_for_are_those_of_the_program(tmp_path, mercury):
    mercury("evolve", tmp_path / "other", "--from", "voxel:4x3x2", "--population", 6, "--generations", 3, "--seconds", 0.5,
            "--dt", 0.002, "--seed", 3, "--no-confirm", "--device", "cpu")
    run = asked(tmp_path / "swim")
    assert lineage(tmp_path / "swim") == lineage(tmp_path / "other")
    assert run.generation == 4 and run.is_over
    names = {path.relative_to(tmp_path / "swim") for path in (tmp_path / "swim").rglob("*")}
    assert names == {path.relative_to(tmp_path / "other") for path in (tmp_path / "other").rglob("*")}


def test_an_asked_run_that_was_stopped_goes_on(tmp_path):
    asked(tmp_path / "whole")
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, **SETTINGS)
    run.tell(run.assess())
    genomes = run.ask()
    run.close()  # in the middle of generation 1
    with evolution.resume(tmp_path / "swim") as again:
        assert again.generation == 1 and again.ask() == genomes
        again.go_on()
    assert lineage(tmp_path / "swim") == lineage(tmp_path / "whole")


def test_scores_of_the_program_are_in_the_folder_with_what_evaluate_measured(tmp_path):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, **{**SETTINGS, "objective": "python:light"})
    for _ in range(2):
        robots = [genome.robot() for genome in run.ask()]
        results = list(
            mercurysim.evaluate(robots, 0.5, dt=2e-3, trials=3, seed=3, device="cpu", hashes=True)
        )
        scores = [result.distance / len(result.robot.masses) for result in results]
        run.tell(scores, results)
    asked(tmp_path / "usual")
    mine, usual = run.individuals(), evolution.Run(tmp_path / "usual").individuals()
    assert mine["score"][:6] == pytest.approx(usual["distance"][:6] / usual["masses"][:6], rel=1e-6)
    assert np.allclose(mine["distance"][:6], usual["distance"][:6], rtol=1e-6)
    run.close()
    hashes = [hashes_in(tmp_path / name)[:6] for name in ("swim", "usual")]
    assert hashes[0] == hashes[1] and len(set(hashes[0])) == 6
    assert run.settings["objective"] == ["python:light"]


def test_an_optimizer_of_its_own_drives_a_run(climbed):
    run, climber = climbed
    table = run.individuals()
    assert len(run) == 16 and (table["parent"] == -1).all() and run.is_over
    assert table["score"].max() == climber.score == run.generations()["best_score"][-1]
    # The best six so far live.
    assert sorted(run.living()) == sorted(np.argsort(-table["score"], kind="stable")[:6])
    assert run.genome(run.living()[0]) == run.genomes.random().with_numbers(climber.best)


@pytest.mark.parametrize("stop", [1, 3])
def test_an_optimizer_that_was_stopped_repeats_the_run_and_goes_on(climbed, tmp_path, stop):
    run = evolution.start(tmp_path / "eels", eel(), **CLIMB)
    climb(run, stop)
    run.close()
    with evolution.resume(tmp_path / "eels", repeat=0) as again:
        assert again.generation == 0 and not again.is_over
        climber = climb(again)
    assert climber.score == climbed[1].score
    assert lineage(tmp_path / "eels") == lineage(Path(climbed[0].folder))


def test_a_run_that_is_repeated_tries_no_robot_again_and_refuses_another_one(climbed, tmp_path):
    run = evolution.start(tmp_path / "eels", eel(), **{**CLIMB, "seconds": 2})
    climb(run, 2)
    run.close()
    with evolution.resume(tmp_path / "eels", repeat=0) as again:
        genomes = again.ask()
        assert again.assess(genomes).scores.tolist() == again.individuals()["score"][:4].tolist()
        with pytest.raises(InputError, match="generation 0: 3 genomes, and the run has 4"):
            again.assess(genomes[:3])
        with pytest.raises(InputError, match="generation 0: genome 1 is not that of robot 1"):
            again.assess([genomes[0], genomes[2], genomes[1], genomes[3]])
        with pytest.raises(InputError, match="the score of genome 0"):
            again.tell([1, 2, 3, 4], genomes=genomes)
        again.tell(again.individuals()["score"][:4], genomes=genomes)
        assert again.generation == 1
    for repeat in (-1, 3):
        with pytest.raises(InputError, match="repeat: .* the run has 2 generations"):
            evolution.resume(tmp_path / "eels", repeat=repeat)


def test_every_tool_reads_the_run_of_an_optimizer(climbed, mercury):
    run = climbed[0]
    about = mercury("info", run.folder)
    assert "python:climber, population 6, seed 3" in about and "16" in about
    best = run.living()[0]
    rows = mercury("run", run.folder, "--robot", best, "--device", "cpu", "--csv", "-").splitlines()
    row = dict(zip(rows[0].split(","), rows[1].split(",")))
    assert float(row["distance"]) == pytest.approx(run.individuals()["distance"][best], rel=1e-6)
    assert mercurysim.load(run.folder, robot="best").name == f"eels-{best}" == run.best().name
    assert "born" in (Path(run.folder) / "generations.csv").read_text()
    assert mercurysim.load(run.folder)  # best/


def test_only_the_program_goes_on_with_it(climbed, mercury):
    program = mercury.__closure__[0].cell_contents
    for arguments in (["--resume"], ["--merge"], ["--shard", "1/2"], ["--resume", "--dry-run"]):
        result = subprocess.run([program, "evolve", climbed[0].folder, *arguments], capture_output=True, text=True)
        assert result.returncode == 2 and result.stderr.count("\n") == 1
        assert "has the algorithm python:climber of a program in Python" in result.stderr
    with evolution.resume(climbed[0].folder, generations=5) as run:
        for call in (run.advance, run.ask):
            with pytest.raises(InputError, match="python:climber is a program, which makes the children itself"):
                call()


def cells(rng):
    """A random grid of voxels whose first cell is not air."""
    grid = rng.integers(0, 5, (3, 2, 2)).astype(np.uint8)
    grid[0, 0, 0] = 1
    return grid


def test_robots_of_the_program_fill_a_map_and_have_parents(tmp_path, mercury):
    settings = {**SETTINGS, "generations": 1, "algorithm": "python:map", "axes": ["masses:8:36:7", "muscle_share"], "trials": 1}
    run = evolution.start(tmp_path / "map", "python:cells", **settings)
    rng = np.random.default_rng(1)
    first = run.assess([mercurysim.voxel(cells(rng), edge=0.2) for _ in range(8)])
    run.tell(first)
    run.tell(run.assess([mercurysim.voxel(cells(rng), edge=0.2) for _ in range(3)]), parents=[[0], [1, 2], []])
    table = run.individuals()
    assert table["parent"][8:].tolist() == [0, 1, -1] and table["other_parent"][8:].tolist() == [-1, 2, -1]
    assert table["line_began"][8:].tolist() == [0, 0, 1] and run.lineage(8) == [0, 8]
    places = np.stack([np.clip((table["masses"] - 8) // 4, 0, 6), np.clip(table["muscle_share"] * 10 // 1, 0, 9)], 1)
    best = {}
    for id, place in enumerate(map(tuple, places)):
        if table["fate"][id] == "sound":
            best[place] = max(best.get(place, -np.inf), table["score"][id])
    assert run.generations()["cells"][-1] == len(best)
    assert run.generations()["qd_score"][-1] == pytest.approx(sum(best.values()))
    assert np.array_equal(run.robot(3).masses, first.genomes[3].robot().masses)
    assert "map" in (tmp_path / "map/progress.svg").read_text()
    assert "python:cells" in mercury("info", tmp_path / "map")
    with pytest.raises(InputError, match="python:cells are made by a program"):
        run.genome(0).mutate(seed=1)


def test_the_program_says_who_lives(tmp_path):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, **{**SETTINGS, "algorithm": "python:mine"})
    genomes = [run.genomes.random(2, i) for i in range(8)]
    run.tell(range(4), genomes=genomes[:4], living=[1, 3])
    assert run.living() == [1, 3] and run.individuals()["died"].tolist() == [0, -1, 0, -1]
    for living, message in (([0], "robot 0 is not accepted"), ([1, 1], "robot 1"), ([8], "robot 8")):
        with pytest.raises(InputError, match=message):
            run.tell(range(4), genomes=genomes[4:], living=living)
    run.tell(range(4), genomes=genomes[4:], living=[7, 1])
    assert run.living() == [7, 1] and run.best().name == "swim-7"


def test_a_search_in_memory_takes_genomes_of_the_program_too():
    search = evolution.Search("voxel", SIZE, algorithm="ga", population=4, elites=1, seed=2)
    genomes = evolution.Genomes("voxel", SIZE)
    search.tell([1, 2], genomes=[genomes.random(9, 0), genomes.random(9, 1)])
    search.tell([3], genomes=[genomes.random(9, 2)], parents=[[1]])
    assert [scores for scores, _ in search.living()] == [[3], [2], [1]]
    assert search.best() == genomes.random(9, 2)


def test_robots_that_failed_are_asked(tmp_path):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, **{**SETTINGS, "population": 3, "objective": "python:x"})
    run.ask()
    run.tell([1, np.nan, np.inf])
    assert run.individuals()["fate"].tolist() == ["sound", "failed", "failed"]
    assert run.generations()["failed"].tolist() == [2]


@pytest.mark.parametrize(
    ("use", "message"),
    [
        (lambda run, genomes: run.tell([1, 2], genomes=genomes), "2 are not accepted; there are 3 genomes"),
        (lambda run, genomes: run.tell([1], genomes=[]), "give at least one"),
        (lambda run, genomes: run.tell([1], genomes=[run.robot]), "genomes: must be Genomes, not method"),
        (lambda run, genomes: run.tell([1], genomes=[eel()]), "a Robot is not accepted"),
        (lambda run, genomes: run.tell([1, 2, 3], genomes=genomes, parents=[[0]]), "1 are not accepted; give those of 3"),
        (lambda run, genomes: run.tell([1, 2, 3], genomes=genomes, parents=[[7], [], []]), "robot 7 is out of range"),
        (lambda run, genomes: run.tell([1, 2, 3]), "call ask"),
    ],
)
def test_what_cannot_be_scored_is_refused_and_leaves_the_run_as_it_was(tmp_path, use, message):
    run = evolution.start(tmp_path / "swim", "voxel", SIZE, **{**SETTINGS, "algorithm": "python:mine"})
    genomes = [run.genomes.random(2, i) for i in range(3)]
    with pytest.raises((InputError, TypeError), match=message) as raised:
        use(run, genomes)
    assert "\n" not in str(raised.value)
    assert len(run) == 0 and run.generation == 0
    run.tell([1, 2, 3], genomes=genomes)
    assert len(run) == 3


def test_a_run_that_is_over_takes_no_more(tmp_path):
    run = asked(tmp_path / "swim", generations=0)
    with pytest.raises(InputError, match="the run has all its 0 generations"):
        run.tell([1], genomes=[run.genomes.random()])
