# SPDX-License-Identifier: Apache-2.0
"""The sample animals: the claims of docs/library.md in short form."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

import mercurysim

ROOT = Path(__file__).resolve().parents[2]
LIBRARY = ROOT / "robots" / "library"
sys.path[:0] = [str(LIBRARY / "animals"), str(ROOT / "bench")]

from animals import ANIMALS  # noqa: E402
from brains import STARTS  # noqa: E402
from measure_animals import environment_of, gait  # noqa: E402

FILES = {file.stem: file for file in sorted(LIBRARY.glob("*.json"))}
WITH_BRAIN = [name for name, file in FILES.items() if mercurysim.load(file).brain]


def test_every_animal_has_a_file_and_a_maker():
    """The others are made by a generator; tests/robots/tapered_test.cpp compares them."""
    designed = [name for name, file in FILES.items() if mercurysim.load(file).origin["kind"] == "designed"]
    assert sorted(ANIMALS) == [name for name in designed if name not in WITH_BRAIN]


@pytest.mark.parametrize("name", ANIMALS)
def test_the_file_is_what_the_script_makes(name):
    """Within the last digit that is written."""
    made, written = ANIMALS[name](), json.loads(FILES[name].read_text())
    assert made.keys() == written.keys()
    for key in ("name", "origin", "springs", "faces"):
        assert made[key] == written[key]
    assert made["mass"] == pytest.approx(written["mass"], rel=1e-3)
    for point, same in zip(made["masses"], written["masses"], strict=True):
        assert point == pytest.approx(same, abs=2e-5)
    for material, same in zip(made["materials"], written["materials"], strict=True):
        assert material.keys() == same.keys()
        for key, value in material.items():
            assert value == (same[key] if isinstance(value, str | bool) else pytest.approx(same[key], rel=2e-3, abs=1e-6))


@pytest.mark.parametrize("name", FILES)
def test_an_animal_is_one_body_with_a_closed_skin(name):
    robot = mercurysim.load(FILES[name])
    info = robot.info()
    assert info["closed"] and info["components"] == 1 and info["euler_characteristic"] == 2
    assert info["volume"] > 0 and info["loose_masses"] == 0
    assert info["density"] == pytest.approx(robot.origin["real"]["density"], rel=0.02)
    if robot.origin["kind"] == "designed":
        assert info["modulus"] == pytest.approx(robot.origin["real"]["modulus"], rel=0.02)
    else:  # springs of thin parts are softer than the material (docs/tapered-robots.md)
        assert 0.4 * robot.origin["real"]["modulus"] < info["modulus"] < robot.origin["real"]["modulus"]
    # The default step of 1 ms is safe; what a designer leaves as a margin, evolution uses.
    assert info["largest_dt"] > (1e-3 if "ancestry" in robot.origin else 1.2e-3)


@pytest.mark.parametrize("name", [name for name in FILES if name not in WITH_BRAIN])  # which go to a target
def test_check_confirms_an_animal(name, mercury):
    options = ("--seconds", 8, "--trials", 3, "--device", "cpu", "--json", "--quiet")
    report = json.loads(mercury("check", FILES[name], *options))
    assert [robot["verdict"] for robot in report["robots"]] == ["confirmed"]


def test_the_eel_evolves(tmp_path, mercury):
    """A child of two generations is faster than the sample, of the same mass."""
    run = tmp_path / "run"
    mercury("evolve", run, "--from", FILES["eel"], "--genes", "both", "--algorithm", "ga", "--population", 8, "--generations", 2,
            "--seconds", 3, "--objective", "cruise_lengths", "--trials", 1, "--device", "cpu", "--quiet")  # fmt: skip
    eel = mercurysim.load(FILES["eel"])
    champions = [mercurysim.load(file) for file in sorted((run / "best").glob("*.json"))]
    speeds = [gait(robot, 3).speed / gait(robot, 3).length for robot in (eel, champions[-1])]
    assert speeds[1] > speeds[0]
    assert champions[-1].mass.sum() == pytest.approx(eel.mass.sum(), rel=1e-4)


def test_the_bell_closes_faster_than_it_opens():
    """Less than 0.45 of a pulse; a symmetric one has 0.5. And it shrinks by a tenth of its width or more."""
    robot = mercurysim.load(FILES["jellyfish"])
    batch = mercurysim.Batch([robot], "water", damping=0, device="cpu")
    rim = robot.masses[:, 2] < robot.masses[:, 2].min() + 0.05
    widths = []
    for _ in range(400):
        batch.step(10)
        widths.append(float(np.ptp(batch.positions.numpy()[rim, 0])))
    widths = np.array(widths[-200:])  # two seconds, three pulses
    assert np.mean(np.diff(widths) < 0) < 0.45
    assert np.ptp(widths) > 0.1 * widths.max()


def test_the_dog_steps_with_each_of_its_four_legs():
    """Each foot is off the ground at times and on it at others, and the body gets 0.25 of its length far per second."""
    robot = mercurysim.load(FILES["dog"])
    batch = mercurysim.Batch([robot], environment_of(robot), damping=0, device="cpu")
    x, y, z = robot.masses.T
    ground = z < z.min() + 1e-4
    feet = [ground & (side * y > 0) & (end * x > 0) for side in (-1, 1) for end in (-1, 1)]
    assert sum(feet).tolist() == ground.tolist() and min(map(sum, feet)) == 9
    batch.step(1000)
    begin, heights = batch.centers.numpy()[0, 0], []
    for _ in range(400):
        batch.step(10)
        heights.append([float(batch.positions.numpy()[foot, 2].min()) for foot in feet])
    lifted = np.array(heights) > 0.004
    assert (lifted.mean(axis=0) > 0.05).all() and (lifted.mean(axis=0) < 0.8).all()
    assert batch.centers.numpy()[0, 0] - begin > 4 * 0.25 * np.ptp(x)


def test_the_hunter_reaches_targets_in_every_direction():
    robot = mercurysim.load(FILES["hunter"])
    angles = np.linspace(0, 2 * np.pi, 8, endpoint=False) + 0.1
    targets = 3 * np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    batch = mercurysim.Batch([robot] * len(targets), "water", damping=0, device="cpu")
    batch.brain.set_targets(targets)
    nearest = np.full(len(targets), np.inf)
    for _ in range(100):
        batch.step(100)
        nearest = np.minimum(nearest, np.linalg.norm(batch.centers.numpy() - targets, axis=1))
    assert (nearest < 0.3).all()


@pytest.mark.parametrize("name, radius", [("hunter", 7.8), ("seeker", 7.8), ("chaser", 4.8)])
def test_swimmers_with_a_brain_reach_random_targets(name, radius, mercury):
    """At 2 to 4 body lengths, which the search did not use. docs/library.md has 98 to 100 of 100."""
    report = mercury("run", FILES[name], "--target-radius", radius, "--target-spread", 0.5, "--turned", "--trials", 20, "--seed",
                     5, "--seconds", 10, "--device", "cpu", "--json", "--quiet")  # fmt: skip
    assert json.loads(report)["robots"][0]["reached"] >= 0.9


def share_of_trials(robot, seconds, of_trial, trials, *, settle=0, **environment):
    land = environment_of(robot).replace(**environment)
    options = dict(environment=land, damping=0, settle=settle, trials=trials, turned=True, seed=5, device="cpu")
    radius = 0 if environment else 3
    result = next(iter(mercurysim.evaluate([robot], seconds, target_radius=radius, **options)))
    return np.mean([of_trial(trial) for trial in result.trials])


def start_of(name, tmp_path):
    """The robot with which the search for a brain began."""
    (tmp_path / "start.json").write_text(json.dumps(STARTS[name]()))
    return mercurysim.load(tmp_path / "start.json")


def test_the_moth_goes_to_the_light_and_did_not_before_its_search(tmp_path):
    reached = [share_of_trials(robot, 16, lambda trial: trial.quantities["reached"], 12)
               for robot in (mercurysim.load(FILES["moth"]), start_of("moth", tmp_path))]  # fmt: skip
    assert reached[0] >= 0.6 and reached[1] <= 0.3


def test_the_surefoot_walks_on_after_pushes_that_topple_it_without_its_senses(tmp_path):
    robot, ant = mercurysim.load(FILES["surefoot"]), start_of("ant", tmp_path)
    numb = json.loads(FILES["surefoot"].read_text())
    for sensor in numb["sensors"]:
        sensor["gain"] = 1 if sensor["kind"] == "clock" else 0
    (tmp_path / "numb.json").write_text(json.dumps(numb))
    twin = mercurysim.load(tmp_path / "numb.json")
    walks = [share_of_trials(each, 7, lambda trial: trial.distance > 1, 24, settle=3, push=(1.8, 0, 0), push_at=2)
             for each in (robot, twin, ant)]  # fmt: skip
    assert walks[0] > walks[1] > walks[2]


@pytest.mark.parametrize("name, brainless", [("seeker", "eel"), ("moth", "ant"), ("surefoot", "ant")])
def test_a_learned_brain_has_the_structure_of_its_start_and_the_body_stayed(name, brainless):
    begun, learned = STARTS["moth" if name == "moth" else brainless](), json.loads(FILES[name].read_text())
    assert learned["sensors"] == [pytest.approx(sensor) if sensor["kind"] == "clock" else sensor for sensor in begun["sensors"]]
    assert np.allclose(learned["masses"], begun["masses"], atol=1e-6)
    layers = [[(layer["name"], layer["neurons"]) for layer in each["brain"]["layers"]] for each in (begun, learned)]
    assert layers[0] == layers[1]


def test_evolved_animals_beat_those_made_by_hand_of_the_same_mass():
    """In body lengths per second: `pike` the fish, also by its cost of transport, and `looper` the inchworm."""
    for evolved, designed, faster, cost in (("pike", "fish", 1.3, 0.9), ("looper", "inchworm", 1.5, np.inf)):
        robots = [mercurysim.load(FILES[name]) for name in (evolved, designed)]
        assert robots[0].mass.sum() == pytest.approx(robots[1].mass.sum(), rel=0.01)
        found, beaten = (gait(robot, 6) for robot in robots)
        assert found.speed / found.length > faster * beaten.speed / beaten.length
        assert found.cost < cost * beaten.cost


@pytest.mark.parametrize("name", {"eel", "fish"} & FILES.keys())
def test_eel_and_fish_swim_as_animals_do(name):
    """The Strouhal number of swimming animals, and 0.6 body lengths per second or more."""
    swim = gait(mercurysim.load(FILES[name]), 12)
    assert 0.2 <= swim.strouhal <= 0.4
    assert swim.speed / swim.length >= 0.6
