# SPDX-License-Identifier: Apache-2.0
import copy
import inspect
import json
import pickle
import re

import numpy as np
import pytest

import mercurysim
from mercurysim import Environment, InputError, Land, Ocean, OceanSimple

KINDS = [Ocean, OceanSimple, Land]
OTHERS = {
    Ocean: {"density": 900.5, "drag_tangential": 0.25, "flow": (0.5, 0, -1), "gravity": (0, 0, -1)},
    OceanSimple: {"point_drag": 2.5, "stiffness_scale": 3},
    Land: {"friction": 0.3, "self_collision": False, "gravity": (0, 1, -5)},
}


def test_values_are_those_that_were_given():
    ocean = Ocean(density=900.5, flow=[0.5, 0, -1], lift_coefficient=np.float32(0.3))
    assert (ocean.density, ocean.flow, ocean.lift_coefficient) == (900.5, (0.5, 0, -1), 0.3)
    assert ocean.drag_coefficient == Ocean().drag_coefficient == 1
    assert Land().self_collision is True and Land(self_collision=False).self_collision is False
    assert Land(self_collision=np.bool_(False)).self_collision is False
    assert Ocean(flow=np.array([1, 2, 3], np.float32)).flow == (1, 2, 3)


def test_gravity_takes_a_downward_magnitude():
    assert Land(gravity=9.81) == Land(gravity=(0, 0, -9.81)) == Land()
    assert Ocean(gravity=5).gravity == (0, 0, -5)


@pytest.mark.parametrize("kind", KINDS)
def test_an_environment_is_a_value(kind):
    default, other = kind(), kind(**OTHERS[kind])
    assert default == kind() and hash(default) == hash(kind()) and default != other
    assert other == default.replace(**OTHERS[kind]) and default == kind()
    assert other.__replace__() == other
    assert eval(repr(other)) == other
    assert pickle.loads(pickle.dumps(other)) == other and copy.deepcopy(other) == other
    assert default != 5 and not default == None  # noqa: E711
    for name in OTHERS[kind]:
        with pytest.raises(AttributeError):
            setattr(default, name, 1)
    assert all(default != another() for another in KINDS if another is not kind)


def test_repr_shows_every_parameter():
    assert repr(Land()) == (
        "Land(friction=0.8, static_friction=0.0, self_collision=True, contact_stiffness=100.0, relative_stiffness=0.0, "
        "contact_distance=0.5, gravity=(0.0, 0.0, -9.81), stiffness_scale=200.0, target=(0.0, 0.0, 0.0), "
        "light=(0.0, 0.0, 1.0), reach=0.0, push=(0.0, 0.0, 0.0), push_at=0.0)"
    )


@pytest.mark.parametrize("kind", KINDS)
def test_every_parameter_is_documented_with_its_unit(kind):
    parameters = re.findall(r"(\w+)=", repr(kind()))
    for name in parameters:
        assert re.search(rf"^{name}: \S.*\(default ", kind.__doc__, re.MULTILINE)
        assert inspect.getdoc(getattr(kind, name))
    assert "[N s/m]" in OceanSimple.__doc__ and "[kg/m3]" in inspect.getdoc(Ocean.density)


@pytest.mark.parametrize(
    "kind, values, error, message",
    [
        (Ocean, {"density": "thick"}, TypeError, "^Ocean: density: must be a number, not str$"),
        (Ocean, {"density": None}, TypeError, "^Ocean: density: must be a number, not NoneType$"),
        (Ocean, {"density": True}, TypeError, "^Ocean: density: must be a number, not bool$"),
        (Ocean, {"density": -1}, InputError, "^Ocean: density: -1 is not accepted; give a finite number >= 0 kg/m3$"),
        (Ocean, {"density": float("nan")}, InputError, "^Ocean: density: nan is not accepted; give a finite number"),
        (Ocean, {"density": 1e300}, InputError, "^Ocean: density: inf is not accepted; give a finite number"),
        (Ocean, {"density": 10**400}, InputError, "^Ocean: density: a number this large is not accepted"),
        (Ocean, {"densty": 1}, TypeError, r"^Ocean has no parameter densty; did you mean density\?$"),
        (Ocean, {"friction": 1}, TypeError, "^Ocean has no parameter friction$"),
        (Ocean, {"flow": 1}, TypeError, r"^Ocean: flow: must be three numbers \(x, y, z\), not int$"),
        (Ocean, {"flow": "abc"}, TypeError, r"^Ocean: flow: must be three numbers \(x, y, z\), not str$"),
        (Ocean, {"flow": (1, 2)}, InputError, r"^Ocean: flow: 2 numbers are not accepted; give three numbers \(x, y, z\)$"),
        (Ocean, {"flow": range(10**9)}, InputError, "^Ocean: flow: more than 3 numbers are not accepted; give three"),
        (Ocean, {"flow": (1, 2, "3")}, TypeError, "^Ocean: flow: must be a number, not str$"),
        (Ocean, {"gravity": (0, 0, float("inf"))}, InputError, "^Ocean: gravity: "),
        (Ocean, {"gravity": "down"}, TypeError, "^Ocean: gravity: must be three numbers .* or one number for"),
        (Land, {"self_collision": 1}, TypeError, "^Land: self_collision: must be True or False, not int$"),
    ],
)
def test_bad_values_are_refused_in_one_line(kind, values, error, message):
    for make in (kind, kind().replace):
        with pytest.raises(error, match=message) as caught:
            make(**values)
        assert "\n" not in str(caught.value)


def test_a_broken_pickle_is_refused():
    for state, error in [({"density": "x"}, TypeError), ({"wind": 1}, TypeError), ({1: 1}, TypeError), (5, TypeError)]:
        with pytest.raises(error):
            Ocean.__new__(Ocean).__setstate__(state)


@pytest.mark.parametrize("kind", KINDS)
def test_trajectories_are_those_of_the_program(mercury, kind):
    values = OTHERS[kind]
    options = ["--environment", {Ocean: "ocean", OceanSimple: "ocean-simple", Land: "land"}[kind]]
    for name, value in values.items():
        option = "--" + name.replace("_", "-")
        if isinstance(value, bool):
            options.append("--no-" + option[2:])
        else:
            options.append(f"{option}={','.join(map(str, value)) if isinstance(value, tuple) else value}")
    report = json.loads(mercury("run", "--random", "voxel:3", "--seed", 8, "--seconds", "0.25", *options, "--device", "cpu",
                                "--json", "--quiet"))
    batch = mercurysim.Batch(mercurysim.random_voxel(3, seed=8), environment=kind(**values), device="cpu")
    batch.step(250)
    assert [int(robot["hash"], 16) for robot in report["robots"]] == [batch.hash(i) for i in range(3)]


def test_an_environment_has_any_parts(mercury):
    pool = Environment("ocean+contacts+ground", gravity=2, friction=0.5)
    assert pool.name == "ocean+ground+contacts" and (pool.gravity, pool.friction) == ((0, 0, -2), 0.5)
    assert pool == eval(repr(pool)) == pickle.loads(pickle.dumps(pool)) == copy.deepcopy(pool) == pool.__replace__()
    assert hash(pool) == hash(Environment(pool.name, gravity=2, friction=0.5)) and pool != pool.replace(friction=0.6)
    assert Environment("space+ground").gravity == (0, 0, 0)
    assert Environment("land", friction=0.3) == Land(friction=0.3) and isinstance(Ocean(), Environment)
    with pytest.raises(AttributeError, match="^Environment has no parameter point_drag$"):
        pool.point_drag
    with pytest.raises(TypeError, match=r"^Environment has no parameter frictoin; did you mean friction\?$"):
        Environment("ocean+ground", frictoin=1)
    with pytest.raises(InputError, match="is not an environment; give ocean, ocean-simple, land, water or space, followed by"):
        Environment("ocean+lava")
    batch = mercurysim.Batch(mercurysim.random_voxel(2, seed=8), environment=pool, device="cpu")
    assert batch.environment == pool and type(batch.environment) is Environment
    batch.configure(environment=Land())
    assert type(batch.environment) is Land
    batch.configure(environment=pool)
    batch.reset()
    batch.step(250)
    report = json.loads(mercury("run", "--random", "voxel:2", "--seed", 8, "--seconds", "0.25", "--environment", pool.name,
                                "--gravity", 2, "--friction", 0.5, "--device", "cpu", "--json", "--quiet"))
    assert [int(robot["hash"], 16) for robot in report["robots"]] == [batch.hash(i) for i in range(2)]


def test_robots_fall_by_gravities_of_their_own(robots, device):
    batch = mercurysim.Batch(robots, environment=mercurysim.OceanSimple(point_drag=0), damping=0, device=device)
    start = batch.telemetry()["center_of_mass"]
    batch.set_environments(gravity=[[1], [2], [3], [4]])
    batch.step(200)
    fallen = batch.telemetry()["center_of_mass"] - start
    t, dt = 0.2, 1e-3
    np.testing.assert_allclose(fallen[:, 2], -np.arange(1, 5) * t * (t + dt) / 2, rtol=2e-4)
    assert [batch.environment_of(i).gravity for i in range(4)] == [(0, 0, -g) for g in (1, 2, 3, 4)]


def test_an_environment_of_its_own_lasts_until_configure(robots, device):
    batch = mercurysim.Batch(robots, environment=mercurysim.Land(), device=device)
    batch.set_environments([1, 3], friction=[0.1, 0.2])
    batch.set_environments([3], gravity=(0, 0, -3))
    assert batch.environment_of(3) == mercurysim.Land(friction=0.2, gravity=3)
    batch.keep([3, 0])
    assert [batch.environment_of(i).friction for i in (0, 1)] == pytest.approx([0.2, 0.8])
    batch.configure(environment=mercurysim.Land(friction=0.5))
    assert [batch.environment_of(i) for i in (0, 1)] == [mercurysim.Land(friction=0.5)] * 2


@pytest.mark.parametrize(
    "values, error, message",
    [
        ({"density": 3}, TypeError, "Land has no parameter density"),
        ({"friction": [1, 2]}, mercurysim.InputError, r"friction: the shape \(2,\)"),
        ({"friction": -1}, mercurysim.InputError, "friction: -1"),
        ({"friction": "slippery"}, TypeError, "friction: give numbers"),
        ({"self_collision": False}, mercurysim.InputError, "self_collision: is the same for all"),
        ({"stiffness_scale": 3}, mercurysim.InputError, "stiffness_scale: is the same for all"),
        ({"gravity": [1, 2]}, mercurysim.InputError, r"gravity: the shape \(2,\)"),
    ],
)
def test_what_robots_cannot_have_of_their_own_is_refused(robots, values, error, message):
    batch = mercurysim.Batch(robots, environment=mercurysim.Land(), device="cpu")
    with pytest.raises(error, match=message):
        batch.set_environments(**values)
    assert batch.environment_of(0) == mercurysim.Land()
    with pytest.raises(IndexError):
        batch.set_environments([4], friction=1)
    with pytest.raises(ValueError, match="only one environment"):
        batch.set_environments([3, 3], friction=[0.1, 0.2])
