# SPDX-License-Identifier: Apache-2.0
"""Conditions of trials, drives and racing in evaluate()."""
import numpy as np
import pytest

import mercurysim
from mercurysim import InputError
from mercurysim.bodies import eel


def test_trials_differ_by_noise_damage_and_delay_as_in_a_run(tmp_path):
    from mercurysim import evolution

    for conditions in ({"noise": 0.1}, {"damage": 0.1}, {"delay": 3.0}):
        run = evolution.start(
            tmp_path / str(*conditions), "voxel", {"voxels": (4, 3, 2)}, population=3, generations=0, seconds=0.5, dt=2e-3,
            seed=3, device="cpu", **conditions,
        ).go_on()
        robots = [run.robot(i) for i in range(3)]
        results = mercurysim.evaluate(robots, 0.5, dt=2e-3, seed=3, trials=3, device="cpu", **conditions)
        assert [result.distance for result in results] == pytest.approx(run.individuals()["distance"], rel=1e-6)
        assert len({trial.distance for trial in next(mercurysim.evaluate(robots, 0.5, dt=2e-3, trials=3, device="cpu", **conditions)).trials}) == 3


def wave(periods, actuators, amplitude=0.6):
    times, places = np.arange(periods)[:, None] / periods, np.arange(actuators) / actuators
    return (amplitude * np.sin(2 * np.pi * (times + places))).astype(np.float32)


def test_drives_are_those_of_a_batch(device):
    body, signal, other = eel(), wave(10, 5), wave(7, 5, 0.3)
    batch = mercurysim.Batch([body, body], dt=2e-3, device=device)
    start = batch.telemetry()["center_of_mass"]
    for period in range(25):
        drives = np.stack([signal[period % 10], other[period % 7]])
        drive = batch.actuation.drive
        if device == "cpu":
            np.asarray(drive)[:] = drives
        else:
            torch = pytest.importorskip("torch")
            torch.from_dlpack(drive)[:] = torch.from_numpy(drives).cuda()
        batch.step(20)
    results = list(
        mercurysim.evaluate([body, body], 1, dt=2e-3, device=device, drives=[signal, other], drive_every=0.04, hashes=True)
    )
    assert [result.hash for result in results] == [batch.hash(0), batch.hash(1)]
    moved = np.linalg.norm(batch.telemetry()["center_of_mass"] - start, axis=1)
    assert [result.distance for result in results] == pytest.approx(moved, rel=1e-5)


def test_drives_do_not_depend_on_portions_settling_and_source(device):
    bodies = [eel(), mercurysim.bodies.quadruped(), eel()]

    def signal(index, robot):
        return wave(5 + index, len(robot.actuators))

    usual = {"dt": 2e-3, "device": device, "hashes": True, "settle": 0.3, "drive_every": 0.05}
    expected = [result.hash for result in mercurysim.evaluate(bodies, 1, drives=signal, **usual)]
    listed = [signal(i, robot) for i, robot in enumerate(bodies)]
    for source, drives, more in (
        (bodies, listed, {}),
        (bodies, signal, {"portion": 1}),
        (iter(bodies), signal, {"portion": 2}),
        (lambda i: bodies[i] if i < 3 else None, listed, {"threads": 1}),
    ):
        assert [result.hash for result in mercurysim.evaluate(source, 1, drives=drives, **usual, **more)] == expected
    assert len(set(expected)) == 3


def test_a_column_of_nan_leaves_an_actuator_to_its_sine():
    signal = wave(10, 5)
    signal[:, 1:] = np.nan
    usual = {"dt": 2e-3, "device": "cpu", "hashes": True}
    (partly,) = mercurysim.evaluate(eel(), 1, drives=signal, **usual)
    (free,) = mercurysim.evaluate(eel(), 1, **usual)
    (nothing,) = mercurysim.evaluate(eel(), 1, drives=np.full((1, 5), np.nan), **usual)
    assert nothing.hash == free.hash != partly.hash


def test_trials_of_a_driven_robot_have_its_signal():
    usual = {"dt": 2e-3, "device": "cpu", "drives": lambda index, robot: wave(10, 5, 0.2 * (index + 1))}
    results = list(mercurysim.evaluate([eel()] * 3, 1, trials=3, **usual))
    (alone,) = mercurysim.evaluate([eel()], 1, trials=3, **{**usual, "drives": wave(10, 5, 0.6)})
    assert [trial.distance for trial in results[2].trials] == [trial.distance for trial in alone.trials]
    assert results[0].distance != results[1].distance


@pytest.mark.parametrize(
    ("drives", "error", "message"),
    [
        (np.zeros(5), InputError, "drives: the shape .5,. is not accepted"),
        (np.zeros((0, 5)), InputError, "drives: the shape .0, 5."),
        (np.full((3, 5), 1.5), InputError, "actuator 0 in period 0 is not from -1 to 1"),
        (np.array([[0, 0, 0, 0, 0], [0, 0, np.nan, 0, 0]]), InputError, "actuator 2 in period 1"),
        (np.zeros((3, 4)), InputError, "robot 0 has 5 actuators, and 4 signals"),
        ([], InputError, "an empty list"),
        (lambda index, robot: 1 / 0, ZeroDivisionError, "division"),
        (lambda index, robot: np.zeros(5), InputError, "drives: robot 0: the shape"),
    ],
)
def test_signals_that_drive_nothing_are_refused(drives, error, message):
    with pytest.raises(error, match=message):
        list(mercurysim.evaluate(eel(), 0.2, dt=2e-3, device="cpu", drives=drives))


def test_a_race_ends_trials_where_a_function_says_so():
    robots = mercurysim.random_voxel(12, seed=2, voxels=(4, 3, 2))
    usual = {"dt": 2e-3, "device": "cpu", "hashes": True}
    whole = list(mercurysim.evaluate(robots, 2, **usual))
    half = list(mercurysim.evaluate(robots, 1, **usual))
    limit = float(np.median([result.distance for result in half]))
    seen = []

    def goes_on(so_far):
        seen.append((so_far.index, so_far.steps, so_far.quantities["distance"] == pytest.approx(so_far.distance)))
        return so_far.distance > limit

    raced = list(mercurysim.evaluate(robots, 2, checks=[1], goes_on=goes_on, **usual))
    assert sorted(seen) == [(i, 500, True) for i in range(12)]
    for i, result in enumerate(raced):
        expected = whole[i] if half[i].distance > limit else half[i]
        assert (result.steps, result.hash, result.distance) == (expected.steps, expected.hash, expected.distance)
    assert {result.steps for result in raced} == {500, 1000}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"checks": [1]}, "checks: go with goes_on"),
        ({"goes_on": bool}, "checks: go with goes_on"),
        ({"checks": [1, 0.5], "goes_on": bool}, "checks: give times in ascending order"),
        ({"checks": [2], "goes_on": bool}, "before the end"),
        ({"checks": [0], "goes_on": bool}, "after the start"),
        ({"checks": [1], "goes_on": bool, "trials": 3}, "one trial per robot"),
        ({"noise": -1}, "noise: -1"),
        ({"damage": 1}, "damage: 1"),
        ({"drives": np.zeros((1, 1)), "drive_every": 1e-4}, "drive_every: is less than a step"),
    ],
)
def test_conditions_that_cannot_be_are_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        mercurysim.evaluate(mercurysim.random_voxel(1), 2, dt=2e-3, device="cpu", **arguments)


def test_exceptions_of_a_race_come_out():
    def broken(so_far):
        raise ZeroDivisionError("no race")

    with pytest.raises(ZeroDivisionError, match="no race"):
        list(mercurysim.evaluate(mercurysim.random_voxel(3), 1, dt=2e-3, device="cpu", checks=[0.5], goes_on=broken))


def test_driven_results_cannot_be_shown():
    results = list(mercurysim.evaluate(eel(), 0.2, dt=2e-3, device="cpu", drives=np.zeros((1, 5))))
    with pytest.raises(InputError, match="driven by signals"):
        mercurysim.show(results).html()
