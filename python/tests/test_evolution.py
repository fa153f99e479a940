# SPDX-License-Identifier: Apache-2.0

import inspect

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError, evolution

SETTINGS = {"population": 6, "generations": 3, "seconds": 0.5, "dt": 2e-3, "seed": 3, "device": "cpu"}
SIZE = {"voxels": (4, 3, 2)}


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return evolution.start(tmp_path_factory.mktemp("runs") / "swim", "voxel", SIZE, **SETTINGS).go_on()


def same(left, right):
    """Whether two tables are equal, but for the wall time."""
    return left.keys() == right.keys() and all(
        np.array_equal(left[name], right[name], equal_nan=left[name].dtype.kind == "f") for name in left.keys() - {"seconds"}
    )


def test_a_run_is_that_of_the_program(run, tmp_path, mercury):
    mercury("evolve", tmp_path / "other", "--from", "voxel:4x3x2", "--population", 6, "--generations", 3, "--seconds", 0.5,
            "--dt", 0.002, "--seed", 3, "--no-confirm", "--device", "cpu")
    other = evolution.Run(tmp_path / "other")
    assert same(run.individuals(), other.individuals()) and same(run.generations(), other.generations())
    assert [run.genome(id) for id in run.living()] == [other.genome(id) for id in other.living()]
    assert {**run.settings, "program": ""} == {**other.settings, "program": ""}


def test_names_and_types_of_settings_are_those_of_the_tables(run):
    listed = evolution.Settings.__annotations__
    assert set(listed) == set(run.settings) - {"robots", "genes", "program"} | {"device", "threads"}
    types = {name: hint.__forward_arg__ for name, hint in listed.items()}
    of_tables = {name: type(value).__name__ for name, value in run.settings.items() if isinstance(value, (bool, int, float))}
    assert {name: types[name] for name in of_tables} == of_tables
    given = inspect.signature(mercurysim.evaluate).parameters
    for name in given.keys() & of_tables.keys():
        assert given[name].annotation.removesuffix(" | None") == of_tables[name], name


def test_a_run_that_was_stopped_goes_on_as_if_it_had_never_stopped(run, tmp_path):
    seen = []

    def stop_after_two(run):
        seen.append(len(run))
        return len(seen) < 2

    stopped = evolution.start(tmp_path / "swim", "voxel", SIZE, **SETTINGS).go_on(stop_after_two)
    assert seen == [6, 12] and not stopped.is_over and "2 of 4 generations" in repr(stopped)
    with pytest.raises(InputError):  # it is still open
        evolution.resume(tmp_path / "swim")
    stopped.close()
    with evolution.resume(tmp_path / "swim") as again:
        again.go_on()
        assert again.is_over and not again.advance()
        assert same(again.individuals(), run.individuals())
    with evolution.resume(tmp_path / "swim", generations=4) as longer:
        assert longer.advance() and len(longer.generations()["born"]) == 5
        # Tables hold the last generation before the run is closed.
        assert len((tmp_path / "swim" / "lineage.csv").read_text().splitlines()) == 1 + len(longer)


def test_any_robot_of_a_run_can_be_taken_out(run):
    individuals = run.individuals()
    assert individuals["id"].tolist() == list(range(len(run))) and len(run) == 24
    robot = run.robot(17)
    assert robot.name == "swim-17" and robot == run.genome(17).robot("swim-17") or robot.origin["ancestry"]
    assert run.best().name == f"swim-{run.living()[0]}"
    elites = run.elites()
    assert [elite.name for elite in elites] == [f"swim-{id}" for id in run.living()]
    assert [elite.name for elite in run.elites(2)] == [elite.name for elite in elites[:2]]
    (result,) = mercurysim.evaluate(run.robot(0), 0.5, dt=2e-3, trials=3, device="cpu", seed=3)
    assert result.quantities["distance"] == pytest.approx(individuals["distance"][0], rel=1e-6)
    for wrong in (24, -1):
        with pytest.raises(IndexError, match="the run has 24"):
            run.robot(wrong)


def test_a_lineage_is_the_line_of_first_parents(run):
    individuals = run.individuals()
    line = run.lineage(23)
    assert line[-1] == 23 and individuals["parent"][line[0]] == -1
    assert individuals["parent"][line[1:]].tolist() == line[:-1]


def test_tables_agree_with_each_other(run):
    individuals, generations = run.individuals(), run.generations()
    assert np.bincount(individuals["generation"]).tolist() == generations["born"].tolist()
    assert sorted(individuals["id"][individuals["died"] == -1]) == sorted(run.living())
    best = generations["best"][-1]
    assert individuals["score"][best] == generations["best_score"][-1] == individuals["score"][run.living()].max()
    assert individuals["fate"][best] == "sound"


def test_tables_are_frames_of_pandas(run):
    pytest.importorskip("pandas")
    frame = run.frame()
    assert frame.index.name == "id" and frame.loc[run.living()[0], "score"] == run.individuals()["score"].max()
    assert frame.groupby("generation")["score"].count().tolist() == run.generation_frame()["born"].tolist()


def test_a_run_is_followed_while_another_one_adds_to_it(tmp_path):
    writer = evolution.start(tmp_path / "swim", "voxel", SIZE, **SETTINGS)
    reader = evolution.Run(tmp_path / "swim")
    seen = [len(run) for run in reader.follow(0.5, wait=lambda period: writer.advance())]
    assert seen == [0, 6, 12, 18, 24]
    with pytest.raises(IndexError, match="no generation"):
        evolution.start(tmp_path / "empty", "voxel", SIZE, **SETTINGS).best()


def test_elites_of_a_map_are_the_best_of_their_cells(tmp_path):
    settings = {**SETTINGS, "axes": ["masses:20:60:4", ("muscle_share", 0, 1, 2)]}
    run = evolution.start(tmp_path / "map", "voxel", SIZE, **settings).go_on()
    assert run.settings["algorithm"] == "map-elites"
    assert run.settings["axes"] == [("masses", 20, 60, 4), ("muscle_share", 0, 1, 2)]
    table = run.individuals()
    cells = np.stack([np.clip((table["masses"] - 20) / 10, 0, 3).astype(int), table["muscle_share"] >= 0.5], axis=1)
    best = {}
    for id in np.flatnonzero(table["fate"] == "sound"):
        best[tuple(cells[id])] = max(best.get(tuple(cells[id]), -np.inf), table["score"][id])
    assert sorted(table["score"][run.living()]) == sorted(best.values())
    last = {name: column[-1] for name, column in run.generations().items()}
    assert (last["cells"], last["coverage"]) == (len(best), len(best) / 8)
    assert last["qd_score"] == pytest.approx(sum(best.values()))


def test_children_have_parents_of_their_own_island_but_for_migrants(tmp_path):
    settings = {**SETTINGS, "population": 6, "generations": 4, "islands": 2, "migration_interval": 2, "migrants": 1}
    run = evolution.start(tmp_path / "islands", "voxel", SIZE, **settings).go_on()
    table = run.individuals()
    has_parent = table["parent"] >= 0
    came = has_parent & (table["island"] != table["island"][table["parent"]])
    assert table["generation"][came].tolist() == [2, 2, 4, 4]
    living = run.living()
    for island in range(2):
        best = max(table["score"][id] for id in living if table["island"][id] == island)
        assert run.generations()[f"best_of_island_{island}"][-1] == best
    with pytest.raises(mercurysim.InputError, match="islands: cma-es learns from all robots"):
        evolution.start(tmp_path / "refused", "voxel", SIZE, algorithm="cma-es", islands=2)


def test_steps_of_muscles_are_settings(tmp_path):
    settings = {**SETTINGS, "generations": 1, "muscle_adaptation": True, "muscle_tail": 1}
    run = evolution.start(tmp_path / "steps", "voxel", SIZE, genes="both", **settings).go_on()
    assert run.settings["muscle_adaptation"] is True and run.settings["muscle_tail"] == 1
    with pytest.raises(mercurysim.InputError, match="muscle_adaptation: the muscles do not change"):
        evolution.start(tmp_path / "body", "voxel", SIZE, **settings)


def test_growth_of_brains_is_a_setting(tmp_path):
    settings = {**SETTINGS, "generations": 3, "algorithm": "neat", "brain_growth": True, "new_neurons": 0.5}
    run = evolution.start(tmp_path / "grown", "voxel", SIZE, genes="body,brain", **settings).go_on()
    assert run.settings["brain_growth"] is True and run.settings["new_neurons"] == 0.5
    assert run.settings["species"] == 12
    species = run.generations()["species"]
    assert len(species) == 4 and (species >= 1).all() and (species <= 12).all()
    layers = [len(run.robot(id).brain["layers"]) for id in range(len(run)) if run.robot(id).brain]
    assert min(layers) == 1 and max(layers) > 1
    with pytest.raises(mercurysim.InputError, match="brain_growth: brains do not change"):
        evolution.start(tmp_path / "body", "voxel", SIZE, **{**settings, "algorithm": "ga"})


def test_robots_that_are_given_are_the_first(tmp_path):
    founders = mercurysim.random_voxel(2, seed=5, voxels=(4, 3, 2))
    run = evolution.start(tmp_path / "swim", founders, genes="muscles", **{**SETTINGS, "generations": 0}).go_on()
    assert np.array_equal(run.robot(1).masses, founders[1].masses)
    assert run.settings["genes"] == "muscles"


def test_a_search_with_the_same_scores_is_the_same_search(run):
    search = evolution.Search("voxel", SIZE, **{**SETTINGS, "seconds": 10})
    individuals, first = run.individuals(), 0
    for generation in range(4):
        genomes = search.ask()
        assert genomes == search.ask() == [run.genome(first + i) for i in range(len(genomes))]
        scores = individuals["score"][first : first + len(genomes)]
        assert np.isfinite(scores).all()
        search.tell(scores)
        first += len(genomes)
    assert search.generation == 4
    assert [genome for _, genome in search.living()] == [run.genome(id) for id in run.living()]
    assert search.best() == run.genome(run.living()[0])


def test_a_search_maximizes_a_function_of_python():
    search = evolution.Search("voxel", {"voxels": (4, 4, 4)}, algorithm="ga", population=16, seed=2)
    medians = []
    for _ in range(12):
        filled = [len(genome.robot().masses) for genome in search.ask()]
        search.tell(filled)
        medians.append(np.median([scores[0] for scores, _ in search.living()]))
    assert medians[-1] > medians[0] and (np.diff(medians) >= 0).all()


def test_robots_that_fail_come_last():
    search = evolution.Search("voxel", SIZE, algorithm="ga", population=4, elites=1, crossover=0)
    search.ask()
    search.tell([np.nan, 3, np.inf, 1])
    scores = [scores[0] for scores, _ in search.living()]
    assert scores[:2] == [3, 1] and scores[2:] == [-np.inf] * 2


def test_several_objectives_and_maps():
    search = evolution.Search("voxel", SIZE, objective=["distance", "-work"], population=4)
    search.ask()
    search.tell([[1, 0], [0, 1], [0.5, 0.5], [0, 0]])
    assert [0, 0] not in [scores for scores, _ in search.living()[:3]]
    elites = evolution.Search("voxel", SIZE, axes=["masses"], population=4)
    robots = [genome.robot() for genome in elites.ask()]
    with pytest.raises(InputError, match="map-elites, novelty and cma-me need them"):
        elites.tell([1, 2, 3, 4])
    results = list(mercurysim.evaluate(robots, 0.2, device="cpu"))
    elites.tell([1, 2, 3, 4], results)
    assert elites.living()[0][0] == [4]


def test_genomes_are_made_changed_and_written():
    genomes = evolution.Genomes("voxel", {"voxels": (5, 3, 3)})
    genome, other = genomes.random(seed=1), genomes.random(seed=1, index=1)
    assert genome == genomes.random(1, 0) != other and hash(genome) == hash(genomes.random(1, 0))
    child = genome.mutate(seed=4)
    assert child != genome and child == genome.mutate(seed=4)
    assert genomes.decode(child.encode()) == child
    assert genome.cross(other, seed=1).robot("x").name == "x"
    assert genome.robot().masses.tolist() == mercurysim.random_voxel(1, seed=1, voxels=(5, 3, 3))[0].masses.tolist()
    with pytest.raises(InputError):
        genomes.decode(b"no genome")


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"populaton": 3}, TypeError, "there is no setting populaton; did you mean population?"),
        ({"population": "many"}, TypeError, "population: must be a whole number"),
        ({"population": 0}, InputError, "population: 0 is not accepted"),
        ({"objective": "distanse"}, InputError, "distance"),
        ({"environment": "ocean-simple"}, InputError, "objective"),
        ({"algorithm": "sa"}, InputError, "algorithm"),
        ({"axes": ["mass"]}, InputError, "is no quantity"),
        ({"robots": "fish"}, InputError, '"fish" is no kind of robots'),
        ({"parameters": {"voxel": 3}}, TypeError, "has no parameter voxel"),
        ({"genes": "wings"}, InputError, "genes"),
        ({"robots": []}, InputError, "there is none"),
    ],
)
def test_what_cannot_be_used_is_refused_in_one_line(tmp_path, arguments, error, message):
    with pytest.raises(error, match=message) as raised:
        evolution.start(tmp_path / "swim", **arguments)
    assert "\n" not in str(raised.value) and not (tmp_path / "swim").exists()


def test_scores_of_another_number_are_refused():
    search = evolution.Search("voxel", SIZE, population=4)
    with pytest.raises(InputError, match="call ask"):
        search.tell([1, 2, 3, 4])
    with pytest.raises(IndexError):
        search.best()
    search.ask()
    with pytest.raises(InputError, match="3 are not accepted; ask.. gave 4"):
        search.tell([1, 2, 3])
    with pytest.raises(InputError, match="the shape"):
        search.tell(np.zeros((4, 2)))
    search.tell([1, 2, 3, 4])


def test_folders_that_hold_something_are_kept(run, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with pytest.raises(InputError):
        evolution.start(tmp_path, "voxel", SIZE, **SETTINGS)
    with pytest.raises(InputError):
        evolution.Run(tmp_path)
    assert (tmp_path / "notes.txt").read_text() == "mine"
    with pytest.raises(InputError):
        evolution.start(run.folder, "voxel", SIZE, **SETTINGS)
