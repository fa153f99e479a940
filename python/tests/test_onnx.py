# SPDX-License-Identifier: Apache-2.0
"""Brains and ONNX files: the robot does what ONNX's own evaluator computes."""
import numpy as np
import pytest

import mercurysim
from mercurysim import brains

onnx = pytest.importorskip("onnx")
from onnx import TensorProto, helper, numpy_helper  # noqa: E402
from onnx.reference import ReferenceEvaluator  # noqa: E402

SENSORS = [{"kind": "clock", "frequency": 5}, {"kind": "target_direction"}, {"kind": "strain", "gain": 20}]


def body():
    robot = mercurysim.random_voxel(1, voxels=(5, 4, 3), seed=4, frequencies=5)[0]
    assert len(robot.actuators) > 2
    return robot


def model(path, nodes, constants, inputs=6, shape=None):
    graph = helper.make_graph(
        nodes, "test", [helper.make_tensor_value_info("x", TensorProto.FLOAT, shape or [1, inputs])],
        [helper.make_tensor_value_info("y", TensorProto.FLOAT, None)],
        [numpy_helper.from_array(np.asarray(value, np.float32), name) for name, value in constants.items()])  # fmt: skip
    onnx.save(helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8), path)
    return path


def numbers(*shape):
    return np.random.default_rng(sum(shape)).normal(size=shape).astype(np.float32)


def test_a_policy_of_onnx_drives_a_robot_as_onnx_says(tmp_path):
    robot = body()
    count = len(robot.actuators)
    path = model(tmp_path / "policy.onnx", [
        helper.make_node("Gemm", ["x", "w0", "b0"], ["s0"], transB=1), helper.make_node("Tanh", ["s0"], ["h0"]),
        helper.make_node("MatMul", ["h0", "w1"], ["m1"]), helper.make_node("Add", ["m1", "b1"], ["s1"]),
        helper.make_node("Relu", ["s1"], ["h1"]), helper.make_node("Gemm", ["h1", "w2", "b2"], ["s2"]),
        helper.make_node("Sigmoid", ["s2"], ["y"]),
    ], {"w0": numbers(7, 6), "b0": numbers(7), "w1": numbers(7, 5), "b1": numbers(5), "w2": numbers(5, count), "b2": numbers(count)})  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    evaluator = ReferenceEvaluator(str(path))
    for _ in range(20):
        batch.step(20)
        expected = evaluator.run(None, {"x": batch.brain.senses})[0][0]
        np.testing.assert_allclose(np.asarray(batch.actuation.drive)[0], expected, atol=2e-6)


def test_a_recurrent_layer_remembers_as_onnx_says(tmp_path):
    robot = body()
    count = len(robot.actuators)
    constants = {"w": numbers(1, count, 6), "r": 0.5 * numbers(1, count, count), "b": numbers(1, 2 * count)}
    path = model(tmp_path / "recurrent.onnx", [helper.make_node("RNN", ["x", "w", "r", "b"], ["y"], hidden_size=count)],
                 constants, shape=["steps", 1, 6])  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    senses = []
    for _ in range(15):
        batch.step(20)
        senses.append(batch.brain.senses)
    expected = ReferenceEvaluator(str(path)).run(None, {"x": np.stack(senses)})[0]
    np.testing.assert_allclose(batch.brain.neurons[0], expected.reshape(15, count)[-1], atol=5e-6)


def test_a_brain_is_written_and_read_again(tmp_path):
    robot = body()
    brain = brains.perceptron([(numbers(8, 6), numbers(8)), (numbers(len(robot.actuators), 8), None)], output="tanh")
    thinking = robot.with_brain(brain, SENSORS)
    brains.to_onnx(thinking.brain, 6, tmp_path / "brain.onnx")
    again = brains.from_onnx(tmp_path / "brain.onnx")
    for layer, same in zip(brain["layers"], again["layers"], strict=True):
        assert layer["activation"] == same["activation"]
        np.testing.assert_allclose(layer["inputs"][0]["weights"], same["inputs"][0]["weights"], rtol=1e-6)
    batch = mercurysim.Batch(thinking, device="cpu")
    batch.step(1)
    expected = ReferenceEvaluator(str(tmp_path / "brain.onnx")).run(None, {"senses": batch.brain.senses})[0][0]
    np.testing.assert_allclose(np.asarray(batch.actuation.drive)[0], expected, atol=2e-6)


def test_what_is_no_brain_is_refused(tmp_path):
    lstm = model(tmp_path / "lstm.onnx", [helper.make_node("LSTM", ["x", "w", "r"], ["y"], hidden_size=3)],
                 {"w": numbers(1, 12, 6), "r": numbers(1, 12, 3)}, shape=["steps", 1, 6])  # fmt: skip
    with pytest.raises(mercurysim.InputError, match=r"lstm.onnx: node 0 \(LSTM\): is no layer of a brain; there are Gemm"):
        brains.from_onnx(lstm)
    (tmp_path / "text.onnx").write_text("no model at all")
    with pytest.raises(mercurysim.InputError, match="text.onnx: "):
        brains.from_onnx(tmp_path / "text.onnx")
    with pytest.raises(mercurysim.InputError, match=r"layers\[1\]: 4 inputs, the layer before has 8 neurons"):
        brains.perceptron([(numbers(8, 6), None), (numbers(2, 4), None)])
    memory = {"layers": [{"name": "a", "neurons": 2, "alpha": 0.5, "inputs": [{"from": "senses", "weights": numbers(2, 3).tolist()}]}]}
    with pytest.raises(mercurysim.InputError, match="/brain/layers/0: ONNX takes layers in a row"):
        brains.to_onnx(memory, 3, tmp_path / "memory.onnx")
