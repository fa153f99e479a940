# SPDX-License-Identifier: Apache-2.0
"""Senses and brains from Python (docs/brains.md)."""
import json

import numpy as np
import pytest

import mercurysim
from mercurysim import brains


def swimmer(rng=1, senses=({"kind": "clock", "frequency": 6.3}, {"kind": "target_direction"})):
    body = mercurysim.random_voxel(1, voxels=(5, 4, 3), seed=4, frequencies=5)[0]
    assert len(body.actuators) > 2
    weights = np.random.default_rng(rng).normal(size=(len(body.actuators), 5)).tolist()
    layer = {"name": "motor", "neurons": len(body.actuators), "inputs": [{"from": "senses", "weights": weights}]}
    return body.with_brain({"period": 0.02, "layers": [layer]}, sensors=list(senses))


def test_a_robot_says_what_its_file_says(tmp_path):
    robot = swimmer()
    robot.save(tmp_path / "swimmer.json")
    document = json.loads((tmp_path / "swimmer.json").read_text())
    assert robot.sensors == document["sensors"]
    assert robot.brain["layers"][0]["neurons"] == len(robot.actuators)
    assert mercurysim.load(tmp_path / "swimmer.json") == robot
    assert robot.with_brain(robot.brain) == robot
    assert robot.with_brain(None).brain is None
    layout = robot.brain_layout
    assert layout["senses"][:3] == ["clock sine", "clock cosine", "target_direction x"]
    assert layout["weights"] == 5 * len(robot.actuators)


def test_brains_are_arrays_of_a_batch():
    robots = [swimmer(), mercurysim.random_voxel(1, seed=2)[0], swimmer(2)]
    batch = mercurysim.Batch(robots, device="cpu")
    count = robots[0].brain_layout["weights"]
    weights = batch.brain.weights
    assert weights.shape == (3, count)
    assert np.isnan(weights[1]).all()
    np.testing.assert_allclose(weights[0], np.ravel(robots[0].brain["layers"][0]["inputs"][0]["weights"]), rtol=1e-6)

    batch.brain.set_targets([[5, 0, 0], [0, 0, 0], [0, 5, 0]])
    batch.step(1)
    senses, neurons = batch.brain.senses, batch.brain.neurons
    np.testing.assert_allclose(np.linalg.norm(senses[0, 2:5]), 1, rtol=1e-6)
    expected = np.tanh(weights[0].reshape(-1, 5).astype(float) @ senses[0].astype(float))
    np.testing.assert_allclose(neurons[0, :len(expected)], expected, atol=1e-6)

    batch.brain.weights = np.zeros_like(weights)
    batch.step(20)
    assert (batch.brain.neurons[0] == 0).all()
    batch.brain.clamp(0, 1, 0.5)
    batch.step(20)
    assert batch.brain.neurons[0, 1] == 0.5
    assert np.asarray(batch.actuation.drive)[0, 1] == 0.5


def test_a_brain_does_what_a_policy_outside_does():
    robot = swimmer()
    inside = mercurysim.Batch(robot, device="cpu")
    outside = mercurysim.Batch(robot.with_brain(None), device="cpu")
    for _ in range(25):
        inside.step(20)
        np.asarray(outside.actuation.drive)[:] = inside.brain.neurons
        outside.step(20)
    assert inside.hash(0) == outside.hash(0)


@pytest.mark.parametrize(("change", "message"), [
    (lambda brain: brain["layers"][0].update(neurons=1), "/brain/layers/0/inputs/0/weights: "),
    (lambda brain: brain["layers"][0]["inputs"][0].update({"from": "eyes"}), "no layer is named \"eyes\""),
    (lambda brain: brain.update(period=-1), "/brain/period: must be above 0 s"),
    (lambda brain: brain.pop("layers"), "/brain: layers is missing"),
    (lambda brain: brain["layers"][0].update(gate="eyes"), "/brain/layers/0/gate: no layer is named \"eyes\""),
    (lambda brain: brain["layers"][0].update(keep=2), "/brain/layers/0/keep: a keep is 0 to 1"),
])
def test_errors_say_where(change, message):
    robot = swimmer()
    brain = robot.brain
    change(brain)
    with pytest.raises(mercurysim.InputError) as error:
        robot.with_brain(brain)
    assert message in str(error.value)


def test_what_does_not_fit_a_batch_is_refused():
    batch = mercurysim.Batch(swimmer(), device="cpu")
    with pytest.raises(mercurysim.InputError):
        batch.brain.weights = np.zeros((2, 3))
    with pytest.raises(mercurysim.InputError):
        batch.brain.weights = np.full_like(batch.brain.weights, np.nan)
    with pytest.raises(IndexError):
        batch.brain.clamp(0, 1000, 1)
    with pytest.raises(IndexError):
        batch.brain.clamp(3, 0, 1)
    batch.brain.set_targets(None)


def test_gates_are_part_of_a_robot(tmp_path):
    robot = swimmer()
    count = len(robot.actuators)
    weights = np.random.default_rng(2).normal(size=(4 * count, 5)), np.random.default_rng(3).normal(size=(4 * count, count))
    robot = robot.with_brain({"layers": brains.lstm(*weights)})
    robot.save(tmp_path / "lstm.json")
    assert json.loads((tmp_path / "lstm.json").read_text())["requires"] == ["brain", "gates"]
    assert mercurysim.load(tmp_path / "lstm.json") == robot
    cell, hidden = robot.brain["layers"][3:]
    assert (cell["gate"], cell["keep"]) == ("lstm input", "lstm forget")
    assert (hidden["gate"], hidden["keep"]) == ("lstm output", 0)
    assert robot.brain_layout["neurons"][3 * count] == "lstm cell 0"


def test_a_gru_is_four_layers():
    """Cho et al. 2014, as PyTorch has it: h = (1 - z) n + z h, n = tanh(W s + b + r (R h + c))."""
    robot = swimmer()
    count, rng = len(robot.actuators), np.random.default_rng(4)
    W, R, b = rng.normal(size=(3, count, 5)), 0.5 * rng.normal(size=(3, count, count)), rng.normal(size=(3, count))
    c = rng.normal(size=count)

    def gate(name, sign, k):
        inputs = [{"from": source, "weights": (sign * array[k]).tolist()} for source, array in (("senses", W), ("h", R))]
        return {"name": name, "neurons": count, "activation": "sigmoid", "bias": (sign * b[k]).tolist(), "inputs": inputs}

    layers = [
        gate("reset", 1, 0), gate("change", -1, 1),  # 1 - sigmoid(x) = sigmoid(-x)
        {"name": "recall", "neurons": count, "activation": "linear", "gate": "reset", "keep": 0, "bias": c.tolist(),
         "inputs": [{"from": "h", "weights": R[2].tolist()}]},
        {"name": "h", "neurons": count, "gate": "change", "bias": b[2].tolist(),
         "inputs": [{"from": "senses", "weights": W[2].tolist()}, {"from": "recall", "edges": [[i, i, 1] for i in range(count)]}]},
    ]  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain({"layers": layers}), device="cpu")
    h = np.zeros(count)
    for _ in range(50):
        batch.step(20)
        s = batch.brain.senses[0].astype(float)
        r, z = (1 / (1 + np.exp(-(W[k] @ s + R[k] @ h + b[k]))) for k in (0, 1))
        h = (1 - z) * np.tanh(W[2] @ s + b[2] + r * (R[2] @ h + c)) + z * h
        np.testing.assert_allclose(np.asarray(batch.actuation.drive)[0], h, atol=5e-6)
    assert abs(h).max() > 0.1


def test_arrays_are_the_brains_themselves(device):
    robots = [swimmer(i) for i in range(3)]
    batch, same = (mercurysim.Batch([robots[0]] * 3, device=device) for _ in range(2))
    arrays = batch.brain.arrays
    assert arrays is batch.brain.arrays
    assert arrays.weights.shape == (3, robots[0].brain_layout["weights"])
    weights = np.stack([mercurysim.Batch(robot, device="cpu").brain.weights[0] for robot in robots])
    if device == "cpu":
        np.asarray(arrays.weights)[:] = weights
    else:
        torch = pytest.importorskip("torch")
        torch.from_dlpack(arrays.weights)[:] = torch.from_numpy(weights).cuda()
        torch.cuda.synchronize()
    same.brain.weights = weights
    for each in (batch, same):
        each.step(100)
    np.testing.assert_array_equal(batch.hashes(), same.hashes())
    np.testing.assert_array_equal(batch.brain.weights, weights)
    if device == "cpu":
        np.testing.assert_array_equal(np.asarray(arrays.neurons), batch.brain.neurons)
        batch.reset()
        assert (np.asarray(arrays.neurons) == 0).all()
    batch.add(mercurysim.random_voxel(1, seed=2))
    with pytest.raises(mercurysim.InputError, match="brains"):
        batch.brain.arrays
