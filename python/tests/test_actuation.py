# SPDX-License-Identifier: Apache-2.0
"""The muscle law with numbers that a program writes."""

import numpy as np
import pytest

import mercurysim


@pytest.fixture
def batch(device):
    return mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device=device)


def write(array, values):
    """Into the array, on any device."""
    if array.device == "cpu":
        array[:] = values
    else:
        torch = pytest.importorskip("torch")
        torch.from_dlpack(array)[:] = torch.as_tensor(values, device=array.device)


def test_arrays_have_a_column_per_actuator(batch):
    actuation = batch.actuation
    names = [batch.actuators(i) for i in range(3)]
    assert names == [actuation.names(i) for i in range(3)]
    columns = max(len(some) for some in names)
    assert columns > 1
    for array in [actuation.amplitude, actuation.frequency, actuation.phase, actuation.drive]:
        assert array.shape == (3, columns)
        assert array.dtype == np.float32
    assert np.isnan(actuation.drive.numpy()).all()
    frequency = actuation.frequency.numpy()
    for i in range(3):
        assert (frequency[i, : len(names[i])] > 0).all()
        assert np.isnan(frequency[i, len(names[i]) :]).all()


def test_arrays_that_nobody_writes_change_nothing(batch, device):
    other = mercurysim.Batch(batch.robots, device=device)
    batch.actuation
    batch.step(100)
    other.step(100)
    assert np.array_equal(batch.hashes(), other.hashes())


def test_drives_act_from_the_next_step_on_and_on_one_robot(batch, device):
    other = mercurysim.Batch(batch.robots, device=device)
    batch.step(50)
    other.step(50)
    drive = np.full(batch.actuation.drive.shape, np.nan, dtype=np.float32)
    drive[1] = 1
    write(batch.actuation.drive, drive)
    assert not batch.actuation.driven.numpy().any()
    batch.step(50)
    other.step(50)
    same = batch.hashes() == other.hashes()
    assert same.tolist() == [True, False, True]
    count = len(batch.actuators(1))
    assert batch.actuation.driven.dtype == bool
    assert batch.actuation.driven.numpy().sum(axis=1).tolist() == [0, count, 0]


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -np.inf])
def test_a_policy_that_diverges_explodes_its_robot_and_no_other(batch, device, wrong):
    other = mercurysim.Batch(batch.robots, device=device)
    drive = np.full(batch.actuation.drive.shape, 0.5, dtype=np.float32)
    for each in (batch, other):
        write(each.actuation.drive, drive)
        each.step(30)
    before = batch.hash(1)
    drive[1, 0] = wrong
    write(batch.actuation.drive, drive)
    batch.step(20)
    other.step(20)
    assert batch.exploded.numpy().tolist() == [False, True, False]
    assert batch.hash(1) == before  # it stays as it was before the step
    assert batch.telemetry()[1]["exploded_at"] == pytest.approx(0.03)
    assert [batch.hash(i) for i in (0, 2)] == [other.hash(i) for i in (0, 2)]
    batch.reset([False, True, False])
    assert not batch.exploded.numpy().any()
    batch.step(1)
    assert batch.exploded.numpy().tolist() == [False, True, False]  # the drive is still wrong


def test_nan_from_the_first_step_on_is_seen_where_driven_is_set(batch):
    driven = np.zeros(batch.actuation.driven.shape, bool)
    driven[2] = True
    write(batch.actuation.driven, driven)
    batch.step(1)
    assert batch.exploded.numpy().tolist() == [False, False, True]


def test_an_actuator_follows_the_sine_again(batch, device):
    other = mercurysim.Batch(batch.robots, device=device)
    write(batch.actuation.drive, np.float32(0.5))
    batch.step(30)
    batch.reset()
    write(batch.actuation.drive, np.float32(np.nan))
    write(batch.actuation.driven, np.zeros(batch.actuation.driven.shape, bool))
    batch.step(30)
    other.step(30)
    assert np.array_equal(batch.hashes(), other.hashes())


def test_a_constant_drive_is_the_sine_at_frequency_zero(batch, device):
    """L0 (1 + amplitude drive) equals L0 (1 + amplitude sin(phase)) for drive = sin(pi / 2) = 1."""
    other = mercurysim.Batch(batch.robots, device=device)
    write(batch.actuation.drive, np.float32(1))
    write(other.actuation.frequency, np.float32(0))
    write(other.actuation.phase, np.float32(np.pi / 2))
    batch.step(200)
    other.step(200)
    assert np.allclose(batch.positions.numpy(), other.positions.numpy(), atol=2e-5)
    still = mercurysim.Batch(batch.robots, device=device)
    still.step(200)
    assert not np.allclose(batch.positions.numpy(), still.positions.numpy(), atol=1e-3)


def test_drives_beyond_one_are_limited_and_nan_is_none(batch, device):
    limited = mercurysim.Batch(batch.robots, device=device)
    write(batch.actuation.drive, np.float32(1))
    write(limited.actuation.drive, np.float32(1e30))
    batch.step(50)
    limited.step(50)
    assert np.array_equal(batch.hashes(), limited.hashes())
    sine = mercurysim.Batch(batch.robots, device=device)
    endless = mercurysim.Batch(batch.robots, device=device)
    for array in [endless.actuation.amplitude, endless.actuation.frequency, endless.actuation.phase]:
        write(array, np.float32(np.nan))
    sine.step(50)
    endless.step(50)
    assert np.array_equal(sine.hashes(), endless.hashes())


def test_settings_stay_with_their_robots(batch):
    drive = np.arange(batch.actuation.drive.size, dtype=np.float32).reshape(batch.actuation.drive.shape) / 100
    write(batch.actuation.drive, drive)
    old = batch.actuation.drive
    batch.keep([2, 0])
    columns = batch.actuation.drive.shape[1]
    kept = batch.actuation.drive.numpy()
    names = [batch.actuators(i) for i in range(2)]
    for row, robot in enumerate([2, 0]):
        assert np.array_equal(kept[row, : len(names[row])], drive[robot, : len(names[row])])
    assert columns == max(len(some) for some in names)
    batch.add(mercurysim.random_voxel(1, seed=8))
    assert np.isnan(batch.actuation.drive.numpy()[2]).all()
    assert np.array_equal(old.numpy(), drive)


def test_what_is_not_an_array_of_the_shape_is_refused():
    batch = mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device="cpu")
    drive = batch.actuation.drive
    with pytest.raises(ValueError):
        drive[:] = np.zeros((7, 7, 7))
    with pytest.raises(ValueError):
        drive[0, 0] = "fast"
    with pytest.raises(IndexError):
        drive[3, 0] = 1
    with pytest.raises(AttributeError):
        batch.actuation.drive = 1
    assert np.isnan(drive.numpy()).all()
