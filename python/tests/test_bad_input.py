# SPDX-License-Identifier: Apache-2.0
"""No input from Python crashes the interpreter; what cannot be used is refused in one line."""

import copy
import pickle

import numpy as np
import pytest

import mercurysim


def test_masks_that_do_not_fit_are_refused(batch):
    before = batch.hashes()
    for mask in [[True] * 3, [], np.zeros(5, dtype=bool)]:
        with pytest.raises(mercurysim.InputError, match="the batch has 4 robots"):
            batch.reset(mask)
    for mask in [np.zeros(4), [0, 1, 0, 1], "yes", 3, np.zeros((2, 2), dtype=bool), [None] * 4, object()]:
        with pytest.raises(TypeError, match="one bool per robot"):
            batch.reset(mask)
    assert np.array_equal(batch.hashes(), before)


def test_indices_that_do_not_fit_are_refused(batch):
    for indices in [[4], [-1], [0, 2**40], np.array([-(2**62)])]:
        with pytest.raises(IndexError, match="out of range"):
            batch.keep(indices)
    with pytest.raises(ValueError, match="once"):
        batch.keep([1, 1])
    for indices in [[0.5], 3, "0", [True, False, True, True], [[0]], [None], object()]:
        with pytest.raises(TypeError, match="sequence of integers"):
            batch.keep(indices)
    for index in [-1, 4, 2**60, -(2**60)]:
        for function in [batch.hash, batch.actuators, batch.actuation.names]:
            with pytest.raises(IndexError, match="out of range"):
                function(index)
        with pytest.raises(IndexError):
            batch.set_state(index, np.zeros((1, 3)))
    for index in ["0", 0.0, None, 2**70]:
        with pytest.raises(TypeError):
            batch.hash(index)
    assert len(batch) == 4


def test_states_that_do_not_fit_are_refused(batch):
    masses = len(batch.robots[0].masses)
    for wrong in [np.zeros((masses, 2)), np.zeros((masses + 1, 3)), np.zeros(3 * masses), [], 3.0]:
        with pytest.raises(mercurysim.InputError, match="positions: the shape"):
            batch.set_state(0, wrong)
    with pytest.raises(mercurysim.InputError, match="velocities: the shape"):
        batch.set_state(0, batch.robots[0].masses, np.zeros((1, 3)))
    for wrong in [None, "x", [[None] * 3] * masses, np.zeros((masses, 3), dtype=complex), object()]:
        with pytest.raises(TypeError, match="positions"):
            batch.set_state(0, wrong)


def test_values_that_break_a_rule_are_refused(robots):
    for wrong, message in [
        ({"dt": 0}, "dt"),
        ({"dt": float("nan")}, "dt"),
        ({"damping": -1}, "damping"),
        ({"solver": "verlet"}, "force"),
        ({"environment": "swamp"}, "ocean"),
        ({"device": "tpu"}, "cpu"),
        ({"device": 3}, "cpu"),
        ({"threads": -1}, "threads"),
        ({"threads": 2**31 - 1}, "threads"),
    ]:
        with pytest.raises(mercurysim.InputError, match=message) as error:
            mercurysim.Batch(robots, **{"device": "cpu", **wrong})
        assert "\n" not in str(error.value)
    for wrong in [None, 3, [1], [None], [robots], object()]:
        with pytest.raises(TypeError) as error:
            mercurysim.Batch(wrong, device="cpu")
        assert "\n" not in str(error.value)
    for wrong in [{"dt": "fast"}, {"threads": 2**40}, {"solver": None}, {"environment": 3}, {"speed": 1}]:
        with pytest.raises(TypeError):
            mercurysim.Batch(robots, **{"device": "cpu", **wrong})
    with pytest.raises(mercurysim.DeviceError):
        mercurysim.Batch(robots, device="cuda:99")


def test_numbers_of_steps_that_are_refused(batch):
    for wrong in [-1, -(2**63)]:
        with pytest.raises(mercurysim.InputError, match="0 or more"):
            batch.step(wrong)
    for wrong in [1.5, "1", None, 2**63, [1]]:
        with pytest.raises(TypeError):
            batch.step(wrong)
    batch.step(np.int64(2))
    with pytest.raises(mercurysim.InputError, match="too large"):
        batch.step(2**63 - 1)
    assert batch.steps == 2


def test_batches_cannot_be_pickled_or_copied(batch):
    for function in [pickle.dumps, copy.copy, copy.deepcopy]:
        with pytest.raises(TypeError, match="cannot be pickled"):
            function(batch)


def test_subclasses_and_objects_without_init(robots):
    class Named(mercurysim.Batch):
        def __init__(self, robots, name):
            super().__init__(robots, device="cpu")
            self.name = name

    class Forgetful(mercurysim.Batch):
        def __init__(self):
            pass

    named = Named(robots, "school")
    named.step(3)
    named.mine = [named.positions, named]  # a cycle
    assert (named.name, named.steps) == ("school", 3)
    for empty in [Forgetful(), mercurysim.Batch.__new__(mercurysim.Batch)]:
        for use in [len, repr, lambda batch: batch.step(), lambda batch: batch.positions, lambda batch: batch.hash(0)]:
            with pytest.raises(TypeError), pytest.warns(RuntimeWarning, match="uninitialized"):
                use(empty)


def test_a_batch_whose_init_has_failed_can_be_made_again(robots):
    batch = mercurysim.Batch.__new__(mercurysim.Batch)
    with pytest.raises(mercurysim.InputError):
        batch.__init__(robots, device="cpu", dt=-1)
    with pytest.raises(TypeError), pytest.warns(RuntimeWarning, match="uninitialized"):
        batch.step()
    batch.__init__(robots, device="cpu")
    batch.step(2)
    assert batch.steps == 2
