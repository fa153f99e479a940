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


def model(path, nodes, constants, inputs=6, shape=None, more=(), outputs=("y",)):
    graph = helper.make_graph(
        nodes, "test", [helper.make_tensor_value_info("x", TensorProto.FLOAT, shape or [1, inputs]), *more],
        [helper.make_tensor_value_info(name, TensorProto.FLOAT, None) for name in outputs],
        [numpy_helper.from_array(np.asarray(value), name) for name, value in constants.items()])  # fmt: skip
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


CELLS = 4


def policy_with_lstm(path, count, **attributes):
    """Layers before and after an LSTM whose state is explicit."""
    state = [helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, 1, CELLS]) for name in "hc"]
    return model(path, [
        helper.make_node("Gemm", ["x", "w0", "b0"], ["s0"], transB=1), helper.make_node("Tanh", ["s0"], ["h0"]),
        helper.make_node("Unsqueeze", ["h0", "axis"], ["i"]),
        helper.make_node("LSTM", ["i", "w", "r", "b", "", "h", "c"], ["", "nh", "nc"], hidden_size=CELLS, **attributes),
        helper.make_node("Squeeze", ["nh", "axis"], ["l"]), helper.make_node("Gemm", ["l", "w1"], ["y"], transB=1),
    ], {"w0": numbers(5, 6), "b0": numbers(5), "w": numbers(1, 4 * CELLS, 5), "r": numbers(1, 4 * CELLS, CELLS),
        "b": numbers(1, 8 * CELLS), "w1": 0.5 * numbers(count, CELLS), "axis": np.zeros(1, np.int64)},
        more=state, outputs=("y", "nh", "nc"))  # fmt: skip


def expect_the_same(batch, evaluator, names, state_names, thoughts=50):
    """The drives of a robot are what a model with explicit state gives, thought after thought."""
    state = dict.fromkeys(state_names, np.zeros((1, 1, CELLS), np.float32))
    largest = 0
    for _ in range(thoughts):
        batch.step(20)
        drives, *after = evaluator.run(None, {names: batch.brain.senses, **state})
        state = dict(zip(state_names, after, strict=True))
        np.testing.assert_allclose(np.asarray(batch.actuation.drive)[0], np.clip(drives[0], -1, 1), atol=5e-6)
        largest = max(largest, abs(drives).max())
    assert largest > 0.1


def test_an_lstm_between_layers_does_what_onnx_says(tmp_path):
    robot = body()
    path = policy_with_lstm(tmp_path / "lstm.onnx", len(robot.actuators))
    brain = brains.from_onnx(path)
    assert [layer["neurons"] for layer in brain["layers"]] == [5, *[CELLS] * 5, len(robot.actuators)]
    batch = mercurysim.Batch(robot.with_brain(brain, SENSORS), device="cpu")
    expect_the_same(batch, ReferenceEvaluator(str(path)), "x", "hc")


def fifty_thoughts(batch):
    """Its senses (50, 1, senses) and drives (50, actuators)."""
    senses, drives = [], []
    for _ in range(50):
        batch.step(20)
        senses.append(batch.brain.senses)
        drives.append(np.array(batch.actuation.drive)[0])
    return np.stack(senses), np.stack(drives)


def test_an_lstm_reads_a_sequence_of_senses(tmp_path):
    robot = body()
    count = len(robot.actuators)
    constants = {"w": numbers(1, 4 * count, 6), "r": 0.3 * numbers(1, 4 * count, count)}
    path = model(tmp_path / "lstm.onnx", [helper.make_node("LSTM", ["x", "w", "r"], ["y"], hidden_size=count)],
                 constants, shape=["steps", 1, 6])  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    senses, drives = fifty_thoughts(batch)
    expected = ReferenceEvaluator(str(path)).run(None, {"x": senses})[0]
    np.testing.assert_allclose(drives, expected.reshape(50, count), atol=5e-6)


# Of a GRU of ONNX, by its documentation: X (steps, 1, inputs), W and R of the gates z, r, h, B = all of W, then all of R.
def gru_of_onnx(x, w, r, b=None, linear_before_reset=0):
    size = r.shape[2]
    b = np.zeros((1, 6 * size)) if b is None else b
    (wz, wr, wh), (rz, rr, rh) = np.split(w[0].astype(float), 3), np.split(r[0].astype(float), 3)
    wbz, wbr, wbh, rbz, rbr, rbh = np.split(b[0].astype(float), 6)
    h, hidden = np.zeros(size), []
    for senses in x[:, 0].astype(float):
        zt = 1 / (1 + np.exp(-(wz @ senses + rz @ h + wbz + rbz)))
        rt = 1 / (1 + np.exp(-(wr @ senses + rr @ h + wbr + rbr)))
        recalled = rt * (rh @ h + rbh) if linear_before_reset else rh @ (rt * h) + rbh
        h = (1 - zt) * np.tanh(wh @ senses + recalled + wbh) + zt * h
        hidden.append(h)
    return np.array(hidden)


@pytest.mark.parametrize("reset", [{}, {"linear_before_reset": 0}, {"linear_before_reset": 1}], ids=str)
@pytest.mark.parametrize("bias", [True, False])
def test_a_gru_reads_a_sequence_of_senses(tmp_path, reset, bias):
    robot = body()
    count = len(robot.actuators)
    constants = {"w": numbers(1, 3 * count, 6), "r": 0.7 * numbers(1, 3 * count, count)}
    if bias:  # of six parts, none of which is another
        constants["b"] = numbers(1, 6 * count)
    path = model(tmp_path / "gru.onnx", [helper.make_node("GRU", ["x", *constants], ["y"], hidden_size=count, **reset)],
                 constants, shape=["steps", 1, 6])  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    senses, drives = fifty_thoughts(batch)
    expected = gru_of_onnx(senses, *constants.values(), **reset)
    np.testing.assert_allclose(drives, expected, atol=5e-6)
    evaluated = ReferenceEvaluator(str(path)).run(None, {"x": senses})[0]
    np.testing.assert_allclose(drives, evaluated.reshape(50, count), atol=5e-6)
    other = gru_of_onnx(senses, *constants.values(), linear_before_reset=1 - reset.get("linear_before_reset", 0))
    assert abs(other - expected).max() > 1e-3  # the two kinds differ here


def test_grus_follow_one_another_between_layers(tmp_path):
    robot = body()
    count = len(robot.actuators)
    state = [helper.make_tensor_value_info(name, TensorProto.FLOAT, [1, 1, CELLS]) for name in "hk"]
    path = model(tmp_path / "grus.onnx", [
        helper.make_node("Gemm", ["x", "w0"], ["s0"], transB=1), helper.make_node("Tanh", ["s0"], ["h0"]),
        helper.make_node("Unsqueeze", ["h0", "axis"], ["i"]),
        helper.make_node("GRU", ["i", "w", "r", "b", "", "h"], ["all", "nh"], hidden_size=CELLS, linear_before_reset=1),
        helper.make_node("GRU", ["nh", "v", "q", "", "", "k"], ["", "nk"], hidden_size=CELLS),
        helper.make_node("Squeeze", ["nk", "axis"], ["l"]), helper.make_node("Gemm", ["l", "w1"], ["y"], transB=1),
    ], {"w0": numbers(5, 6), "w": numbers(1, 3 * CELLS, 5), "r": numbers(1, 3 * CELLS, CELLS), "b": numbers(1, 6 * CELLS),
        "v": numbers(1, 3 * CELLS, CELLS), "q": -numbers(1, 3 * CELLS, CELLS), "w1": 0.5 * numbers(count, CELLS),
        "axis": np.zeros(1, np.int64)}, more=state, outputs=("y", "nh", "nk"))  # fmt: skip
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    expect_the_same(batch, ReferenceEvaluator(str(path)), "x", "hk")


@pytest.mark.parametrize(("name", "function"), [("Relu", lambda x: np.maximum(x, 0)), ("Sigmoid", lambda x: 1 / (1 + np.exp(-x)))])
def test_a_recurrent_layer_may_have_another_activation(tmp_path, name, function):
    robot = body()
    count = len(robot.actuators)
    constants = {"w": numbers(1, count, 6), "r": 0.1 * numbers(1, count, count), "b": numbers(1, 2 * count)}
    node = helper.make_node("RNN", ["x", *constants], ["y"], hidden_size=count, activations=[name])
    path = model(tmp_path / "recurrent.onnx", [node], constants, shape=["steps", 1, 6])
    batch = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    h = np.zeros(count)
    for _ in range(30):
        batch.step(20)
        total = constants["w"][0] @ batch.brain.senses[0] + constants["r"][0] @ h + constants["b"].reshape(2, count).sum(axis=0)
        h = function(total.astype(float))
    np.testing.assert_allclose(batch.brain.neurons[0], h, rtol=1e-5, atol=5e-6)


def test_an_lstm_is_written_and_read_again(tmp_path):
    robot = body()
    brain = brains.from_onnx(policy_with_lstm(tmp_path / "policy.onnx", len(robot.actuators)))
    thinking = robot.with_brain(brain, SENSORS)
    path = tmp_path / "brain.onnx"
    brains.to_onnx(thinking.brain, 6, path)
    written = onnx.load(path)
    assert [node.op_type for node in written.graph.node].count("LSTM") == 1
    states = [value.name for value in written.graph.input][1:]
    assert states == ["layer 1 hidden", "layer 1 cell"]
    batch = mercurysim.Batch(thinking, device="cpu")
    expect_the_same(batch, ReferenceEvaluator(str(path)), "senses", states)
    same = mercurysim.Batch(robot.with_brain(brains.from_onnx(path), SENSORS), device="cpu")
    same.step(1000)
    np.testing.assert_allclose(same.brain.neurons, batch.brain.neurons, atol=1e-6)


def test_lstms_follow_one_another(tmp_path):
    robot = body()
    count = len(robot.actuators)
    stacked = [
        *brains.lstm(numbers(4 * CELLS, 6), numbers(4 * CELLS, CELLS), numbers(4 * CELLS), name="first"),
        *brains.lstm(numbers(4 * CELLS, CELLS), numbers(4 * CELLS, CELLS), name="second", source="first"),
        {"name": "motor", "neurons": count, "inputs": [{"from": "second", "weights": numbers(count, CELLS).tolist()}]},
    ]
    batch = mercurysim.Batch(robot.with_brain({"layers": stacked}, SENSORS), device="cpu")
    brains.to_onnx(batch.robots[0].brain, 6, tmp_path / "stacked.onnx")
    states = [f"{name} {part}" for name in ("first", "second") for part in ("hidden", "cell")]
    expect_the_same(batch, ReferenceEvaluator(str(tmp_path / "stacked.onnx")), "senses", states)


def test_an_lstm_does_what_pytorch_says():
    torch = pytest.importorskip("torch")
    robot = body()
    count = len(robot.actuators)
    torch.manual_seed(1)
    net = torch.nn.LSTM(6, count)
    bias = (net.bias_ih_l0 + net.bias_hh_l0).detach()
    layers = brains.lstm(net.weight_ih_l0.detach(), net.weight_hh_l0.detach(), bias)
    batch = mercurysim.Batch(robot.with_brain({"layers": layers}, SENSORS), device="cpu")
    state = None
    for _ in range(50):
        batch.step(20)
        with torch.no_grad():
            drives, state = net(torch.from_numpy(batch.brain.senses), state)
        np.testing.assert_allclose(np.asarray(batch.actuation.drive)[0], drives[0].numpy(), atol=5e-6)


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
    convolution = model(tmp_path / "conv.onnx", [helper.make_node("Conv", ["x", "w"], ["y"])], {"w": numbers(1, 1, 3)})
    with pytest.raises(mercurysim.InputError, match=r"conv.onnx: node 0 \(Conv\): is no layer of a brain; there are Gemm"):
        brains.from_onnx(convolution)
    (tmp_path / "text.onnx").write_text("no model at all")
    with pytest.raises(mercurysim.InputError, match="text.onnx: "):
        brains.from_onnx(tmp_path / "text.onnx")
    with pytest.raises(mercurysim.InputError, match=r"layers\[1\]: 4 inputs, the layer before has 8 neurons"):
        brains.perceptron([(numbers(8, 6), None), (numbers(2, 4), None)])
    memory = {"layers": [{"name": "a", "neurons": 2, "alpha": 0.5, "inputs": [{"from": "senses", "weights": numbers(2, 3).tolist()}]}]}
    with pytest.raises(mercurysim.InputError, match="/brain/layers/0: ONNX takes layers in a row"):
        brains.to_onnx(memory, 3, tmp_path / "memory.onnx")
    for gates in ({"gate": "a"}, {"keep": 0.5}):
        layer = {"name": "a", "neurons": 2, "inputs": [{"from": "senses", "weights": numbers(2, 3).tolist()}], **gates}
        with pytest.raises(mercurysim.InputError, match="/brain/layers/0: ONNX takes layers in a row"):
            brains.to_onnx({"layers": [layer]}, 3, tmp_path / "gated.onnx")
    with pytest.raises(mercurysim.InputError, match=r"lstm: weights must be \(4 cells, inputs\) and \(4 cells, cells\), not \(8, 3\) and \(9, 2\)"):
        brains.lstm(numbers(8, 3), numbers(9, 2))


@pytest.mark.parametrize(("change", "message"), [
    ({"inputs": ["x", "w", "r", "", "", "", "", "p"]}, "has peepholes"),
    ({"inputs": ["x", "w", "r", "", "lengths"]}, "has sequence_lens"),
    ({"inputs": ["x", "w", "r", "", "", "one"]}, "has a state at the start that is not 0"),
    ({"direction": "reverse"}, "must run forward, with Sigmoid, Tanh, Tanh"),
    ({"activations": ["Sigmoid", "Tanh", "Relu"]}, "must run forward, with Sigmoid, Tanh, Tanh"),
    ({"clip": 3.0}, "has neither clip nor input_forget"),
    ({"shape": [50, 1, 6]}, "give sequences and batches of 1"),
    ({"shape": [1, 8, 6]}, "give sequences and batches of 1"),
    ({"outputs": ["", "", "y"], "last": "Tanh"}, "must read what the node before it gives"),
    ({"outputs": ["", "", "y"]}, "its output is not what its last layer gives"),
])  # fmt: skip
def test_other_lstms_are_refused_in_one_line(tmp_path, change, message):
    given = {"inputs": ["x", "w", "r"], "outputs": ["y"], "shape": ["steps", 1, 6], **change}
    last = given.pop("last", None)
    shape, inputs, outputs = (given.pop(name) for name in ("shape", "inputs", "outputs"))
    nodes = [helper.make_node("LSTM", inputs, outputs, hidden_size=3, **given)]
    if last:
        nodes.append(helper.make_node(last, ["y"], ["z"]))
    constants = {"w": numbers(1, 12, 6), "r": numbers(1, 12, 3), "p": numbers(1, 9), "one": np.ones((1, 1, 3), np.float32),
                 "lengths": np.ones(1, np.int32)}  # fmt: skip
    path = model(tmp_path / "lstm.onnx", nodes, constants, shape=shape, outputs=("z" if last else "y",))
    expect_refusal(path, message)


def expect_refusal(path, message):
    with pytest.raises(mercurysim.InputError) as error:
        brains.from_onnx(path)
    assert message in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(("kind", "change", "message"), [
    ("GRU", {"activations": ["Sigmoid", "Relu"]}, "node 0 (GRU): must run forward, with Sigmoid, Tanh"),
    ("GRU", {"direction": "bidirectional"}, "node 0 (GRU): must run forward, with Sigmoid, Tanh"),
    ("GRU", {"clip": 3.0}, "node 0 (GRU): a brain has neither clip nor input_forget"),
    ("GRU", {"inputs": ["x", "w", "r", "", "lengths"]}, "node 0 (GRU): has sequence_lens"),
    ("GRU", {"inputs": ["x", "w", "r", "", "", "one"]}, "node 0 (GRU): has a state at the start that is not 0"),
    ("GRU", {"shape": [50, 1, 6]}, "node 0 (GRU): a robot thinks once at a time"),
    ("GRU", {"inputs": ["x", "lengths", "r"]},
     "node 0 (GRU): W and R must be (1, 3 neurons, inputs) and (1, 3 neurons, neurons), not (1,) and (1, 9, 3)"),
    ("GRU", {"inputs": ["x", "w", "unknown"]}, "node 0 (GRU): unknown is no constant of the file"),
    ("GRU", {"inputs": ["x", "w"]}, "node 0 (GRU): needs W and R"),
    ("GRU", {"inputs": ["x", "w", "r", "one"]}, "node 0 (GRU): B must be (1, 18), not (1, 1, 3)"),
    ("RNN", {}, "node 0 (RNN): W and R must be (1, neurons, inputs) and (1, neurons, neurons), not (1, 9, 6) and (1, 9, 3)"),
    ("RNN", {"activations": ["Elu"]}, "node 0 (RNN): must run forward, with Tanh or Relu or Sigmoid"),
])  # fmt: skip
def test_other_recurrent_layers_are_refused_in_one_line(tmp_path, kind, change, message):
    given = {"inputs": ["x", "w", "r"], "shape": ["steps", 1, 6], **change}
    shape, inputs = given.pop("shape"), given.pop("inputs")
    constants = {"w": numbers(1, 9, 6), "r": numbers(1, 9, 3), "one": np.ones((1, 1, 3), np.float32), "lengths": np.ones(1, np.int32)}
    node = helper.make_node(kind, inputs, ["y"], hidden_size=3, **given)
    expect_refusal(model(tmp_path / "recurrent.onnx", [node], constants, shape=shape), message)
