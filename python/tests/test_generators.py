# SPDX-License-Identifier: Apache-2.0
import inspect
import itertools
import json
import re
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError

KINDS = {"voxel": mercurysim.random_voxel, "shell": mercurysim.random_shell, "cppn": mercurysim.random_painted}


def program_hashes(mercury, *options):
    report = json.loads(mercury("run", *options, "--seconds", "0.25", "--device", "cpu", "--json", "--quiet"))
    return [(robot["name"], int(robot["hash"], 16)) for robot in report["robots"]]


def hashes(robots):
    batch = mercurysim.Batch(robots, device="cpu")
    batch.step(250)
    return [(robot.name, batch.hash(i)) for i, robot in enumerate(robots)]


@pytest.mark.parametrize("kind", KINDS)
def test_robots_and_their_trajectories_are_those_of_the_program(mercury, kind):
    assert hashes(KINDS[kind](4, seed=11)) == program_hashes(mercury, "--random", f"{kind}:4", "--seed", 11)


def test_parameters_mean_what_the_options_mean(mercury):
    robots = mercurysim.random_voxel(2, seed=3, voxels=((3, 2, 2), (5, 4, 3)), edge=0.05)
    options = ["--random", "voxel:2", "--seed", 3, "--voxels", "3x2x2..5x4x3", "--edge", 0.05]
    assert hashes(robots) == program_hashes(mercury, *options)


def test_networks_are_those_of_the_program_or_are_refused(mercury):
    try:
        robots = mercurysim.random_network(2, seed=11)
    except InputError as error:
        assert str(error).endswith("network robots: this program was built without them (MERCURY_NN=OFF)")
    else:
        assert hashes(robots) == program_hashes(mercury, "--random", "nn:2", "--seed", 11)


@pytest.mark.parametrize("kind", KINDS)
def test_a_robot_depends_on_its_seed_and_number_alone(kind):
    four = KINDS[kind](4, seed=2)
    assert [robot.name for robot in four] == [f"{kind}-2-{i}" for i in range(4)]
    assert KINDS[kind](2, seed=2, first=2) == four[2:]
    assert len({robot.body_hash for robot in four}) == 4


def test_sizes_and_lists():
    robot = mercurysim.random_voxel(voxels=(3, 2, 2))[0]
    assert robot == mercurysim.random_voxel(voxels=[[3, 2, 2], [3, 2, 2]])[0]
    assert robot == mercurysim.random_voxel(voxels=np.array([3, 2, 2]))[0]
    assert robot.info()["extent"][0] <= 3 * 0.1 + 1e-6


def test_counts():
    assert mercurysim.random_voxel(0) == []
    robots = mercurysim.random_voxel(600, voxels=(2, 2, 2))
    assert [robot.name for robot in robots] == [f"voxel-1-{i}" for i in range(600)]


@pytest.mark.parametrize(
    "values, error, message",
    [
        ({"count": -1}, InputError, "^count: -1 is not accepted; give 0 or more$"),
        ({"count": 2**70}, InputError, "^count: 1180591620717411303424 is not accepted; give 0 or more$"),
        ({"count": 1.0}, TypeError, "^count: must be a whole number, not float$"),
        ({"count": "four"}, TypeError, "^count: must be a whole number, not str$"),
        ({"seed": -1}, InputError, "^seed: -1 is not accepted"),
        ({"first": None}, TypeError, "^first: must be a whole number, not NoneType$"),
        ({"edge": 0}, InputError, "^edge: 0 is not accepted; give "),
        ({"edge": float("nan")}, InputError, "^edge: nan is not accepted; give "),
        ({"edge": 1e300}, InputError, "^edge: inf is not accepted; give "),
        ({"edge": "large"}, TypeError, "^edge: must be a number, not str$"),
        ({"edge": True}, TypeError, "^edge: must be a number, not bool$"),
        ({"voxels": 5}, TypeError, r"^voxels: must be sizes \(x, y, z\), or a range \(\(x, y, z\), \(x, y, z\)\), not int$"),
        ({"voxels": "3x2x2"}, TypeError, r"^voxels: must be sizes \(x, y, z\), or a range .*, not str$"),
        ({"voxels": (3, 2)}, TypeError, "^voxels: must be sizes .*, not int$"),
        ({"voxels": (1, 2, 3, 4)}, InputError, "^voxels: 4 sizes are not accepted; give sizes"),
        ({"voxels": (3, 2, 0)}, InputError, "^voxels: 0 is not accepted; give 1 "),
        ({"voxels": (3, 2, 2.5)}, TypeError, "^voxels: must be a whole number, not float$"),
        ({"voxels": (3, 2, 2**33)}, InputError, "^voxels: 8589934592 is not accepted; give "),
        ({"voxels": ((4, 4, 4), (3, 5, 5))}, InputError, "^voxels: 4 to 3 is not accepted; the first size must not be above"),
        ({"egde": 0.1}, TypeError, r"^random_voxel\(\) has no parameter egde; did you mean edge\?$"),
        ({"wings": 2}, TypeError, r"^random_voxel\(\) has no parameter wings$"),
    ],
)
def test_bad_values_are_refused_in_one_line(values, error, message):
    with pytest.raises(error, match=message) as caught:
        mercurysim.random_voxel(**values)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("function", [*KINDS.values(), mercurysim.random_network])
def test_every_parameter_of_a_generator_is_documented(function):
    """The signature, the docstring and what is accepted agree: each default can be given."""
    documented = re.findall(r"^(\w+): .*\(default .*\)$", function.__doc__, re.MULTILINE)
    text = str(inspect.signature(function))
    names = re.findall(r"(\w+): ", text)
    assert names == ["count", "seed", "first", "lively", *documented]
    defaults = dict(re.findall(r"^(\w+): .*\(default (.*?); .*\)$", function.__doc__, re.MULTILINE))
    values = {name: eval(default) for name, default in defaults.items()}
    try:
        robots = function(2, **values)
    except InputError as error:
        assert "MERCURY_NN=OFF" in str(error)
    else:
        assert robots == function(2)


def test_words_and_lists_are_checked():
    with pytest.raises(InputError, match='^symmetry: "sideways" is not accepted; give none, x, y or z$'):
        mercurysim.random_voxel(symmetry="sideways")
    with pytest.raises(TypeError, match="^symmetry: must be a text, not int$"):
        mercurysim.random_voxel(symmetry=1)
    with pytest.raises(InputError, match="^hidden: 16 numbers are not accepted; give at most 15$"):
        mercurysim.random_network(hidden=[8] * 16)
    with pytest.raises(InputError, match="^hidden: more than 100 values are not accepted"):
        mercurysim.random_network(hidden=itertools.count(8))
    with pytest.raises(TypeError, match="^hidden: must be a sequence of whole numbers, not int$"):
        mercurysim.random_network(hidden=8)


def test_threads_make_the_same_robots():
    alone = [mercurysim.random_voxel(4, seed=seed) for seed in range(16)]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(lambda seed: mercurysim.random_voxel(4, seed=seed), range(16))) == alone


def test_lively_robots_are_those_that_get_farthest():
    lively = mercurysim.random_voxel(2, seed=3, lively=True)
    assert [robot.name for robot in lively] == [robot.name for robot in mercurysim.random_voxel(2, seed=3, lively=True)]
    tried = mercurysim.random_voxel(20, seed=3)
    names = [robot.name for robot in tried]
    results = list(mercurysim.evaluate(tried, 4, trials=1, jitter=1e-3, seed=3, device="cpu"))
    ranking = sorted(results, key=lambda result: -result.distance)
    assert [robot.name for robot in lively] == [names[result.index] for result in ranking[:2]]
    with pytest.raises(TypeError, match="lively"):
        mercurysim.random_voxel(2, lively=3)


def test_more_robots_than_memory_holds_are_refused_before_it_is_taken():
    with pytest.raises(MemoryError, match="of memory are needed"):
        mercurysim.random_voxel(10**12)
    with pytest.raises(MemoryError):
        mercurysim.random_voxel(2**63 - 1)
