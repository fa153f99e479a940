# SPDX-License-Identifier: Apache-2.0
"""Brains from the weights of networks, from modules of PyTorch, and ONNX files, for Robot.with_brain() (docs/brains.md)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import InputError

ACTIVATIONS = {"Tanh": "tanh", "Sigmoid": "sigmoid", "Relu": "relu", "Sin": "sine", "Identity": "linear"}
# Of ONNX: how many matrices they stack, and the activations that they may have.
RECURRENT: dict[str, tuple[int, list[list[str]]]] = {
    "RNN": (1, [["Tanh"], ["Relu"], ["Sigmoid"]]),
    "LSTM": (4, [["Sigmoid", "Tanh", "Tanh"]]),
    "GRU": (3, [["Sigmoid", "Tanh"]]),
}
LAYERS = ["Gemm", "MatMul", "Add", *RECURRENT]
# Of one element, they change nothing. Drives are limited to [-1, 1] in any case.
PASSING = ["Flatten", "Squeeze", "Unsqueeze", "Reshape", "Transpose", "Clip"]


def perceptron(
    layers: Sequence[tuple[ArrayLike, ArrayLike | None]],
    *,
    activation: str = "tanh",
    output: str = "linear",
    period: float = 0.02,
) -> dict[str, Any]:
    """A brain of layers in a row, given as (weights, bias) with weights of (neurons, inputs), as PyTorch's Linear has them.

    The first reads the senses, the last, with the activation `output`, drives the actuators. `period` [s] is how often it
    thinks. Raises InputError for shapes that do not go together.

        perceptron([(layer.weight.detach(), layer.bias.detach()) for layer in policy if isinstance(layer, torch.nn.Linear)])
    """
    made: list[dict[str, Any]] = []
    for number, (weights, bias) in enumerate(layers):
        last = number == len(layers) - 1
        name = "motor" if last else f"layer {number}"
        made.append(_layer(made, weights, bias, output if last else activation, name))
    if not made:
        raise InputError("layers: a brain needs at least one layer")
    return {"period": period, "layers": made}


def lstm(
    weights: ArrayLike,
    recurrent: ArrayLike,
    bias: ArrayLike | None = None,
    *,
    name: str = "lstm",
    source: str = "senses",
) -> list[dict[str, Any]]:
    """The five layers of an LSTM, for the `layers` of a brain: its gates, its cell, and what others read, named `name`.

    Weights (4 cells, inputs), recurrent weights (4 cells, cells) and bias (4 cells,) are in PyTorch's order: input gate,
    forget gate, cell, output gate. `source` is "senses" or the layer that it reads. Raises InputError for shapes that do
    not go together.

        lstm(net.weight_ih_l0.detach(), net.weight_hh_l0.detach(), (net.bias_ih_l0 + net.bias_hh_l0).detach())
    """
    return _lstm(weights, recurrent, bias, name, source, "lstm")


def from_torch(*modules: Any, period: float = 0.02) -> dict[str, Any]:
    """The brain of modules of PyTorch in a row, each of which reads the one before, the first the senses: Linear, each with
    an activation after it (Tanh, Sigmoid, ReLU, or none), RNN, LSTM and GRU, Sequential of such, and Identity, Flatten and
    Dropout, which change nothing in use. Each thought is one element of a sequence, and the state is 0 at the start.

    The weights are copied. Raises InputError, which names the module, for others, and for recurrent ones that run in both
    directions or project their output.

        from_torch(net.lstm, net.head)
    """
    import torch  # type: ignore[import-untyped, import-not-found, unused-ignore]

    activations = {torch.nn.Tanh: "tanh", torch.nn.Sigmoid: "sigmoid", torch.nn.ReLU: "relu"}
    passing = (torch.nn.Identity, torch.nn.Flatten, torch.nn.Dropout)
    named = [(f"modules[{number}]", module) for number, module in enumerate(modules)]
    layers: list[dict[str, Any]] = []
    while named:
        place, module = named.pop(0)
        if isinstance(module, torch.nn.Sequential):
            named[:0] = [(f"{place}.{name}", child) for name, child in module.named_children()]
            continue
        place = f"{place} ({type(module).__name__})"
        if isinstance(module, torch.nn.Linear):
            weights, bias = _numbers(module, "weight"), _numbers(module, "bias")
            layers.append(_layer(layers, weights, bias, "linear", f"layer {len(layers)}", place))
        elif isinstance(module, (torch.nn.RNN, torch.nn.LSTM, torch.nn.GRU)):
            if module.bidirectional or module.proj_size:
                raise InputError(f"{place}: must run forward, without a projection (bidirectional, proj_size)")
            for level in range(module.num_layers):
                layers += _torch_recurrent(layers, module, level, place)
        elif activation := next((name for kind, name in activations.items() if isinstance(module, kind)), None):
            _activate(layers, activation, place)
        elif not isinstance(module, passing):
            known = "Linear, RNN, LSTM, GRU, Tanh, Sigmoid, ReLU, Sequential, Identity, Flatten and Dropout"
            raise InputError(f"{place}: is no layer of a brain; there are {known}")
    if not layers:
        raise InputError("modules: a brain needs at least one layer")
    return {"period": period, "layers": layers}


def from_onnx(path: str | os.PathLike[str], *, period: float = 0.02) -> dict[str, Any]:
    """The brain of an ONNX file: layers in a row (Gemm, or MatMul and Add), each with an activation (Tanh, Sigmoid, Relu,
    Sin, or none), and recurrent layers: RNN with Tanh, Relu or Sigmoid, and LSTM (without peepholes) and GRU with their
    default activations. Each thought is one element of their sequence, and their state is 0 at the start. Needs the package
    onnx.

    Raises InputError, which names the node, for others.
    """
    import onnx
    from onnx import numpy_helper

    try:
        model = onnx.load(os.fspath(path))
    except Exception as error:  # protobuf has many
        reason = (str(error).splitlines() or ["it is empty"])[0]
        raise InputError(f"{os.fspath(path)}: is no ONNX file: {reason}") from None
    graph = model.graph
    constants = {tensor.name: numpy_helper.to_array(tensor) for tensor in graph.initializer}
    shapes = {
        value.name: [dimension.dim_value for dimension in value.type.tensor_type.shape.dim]  # 0 = any
        for value in graph.input
        if value.name not in constants
    }
    current, first = set(shapes), ""  # the values that are what the last layer gives; the input that is the senses
    layers: list[dict[str, Any]] = []
    for number, node in enumerate(graph.node):
        place = f"{os.fspath(path)}: node {number} ({node.op_type})"
        given = {attribute.name: onnx.helper.get_attribute_value(attribute) for attribute in node.attribute}
        if node.op_type == "Constant":
            constants[node.output[0]] = numpy_helper.to_array(given["value"])
            continue
        if node.op_type not in LAYERS + PASSING and node.op_type not in ACTIVATIONS:
            known = ", ".join([*LAYERS, *ACTIVATIONS])
            raise InputError(f"{place}: is no layer of a brain; there are {known}")
        read = [name for name in node.input[: 2 if node.op_type == "Add" else 1] if name not in constants]
        if len(read) != 1 or read[0] not in current:
            raise InputError(f"{place}: must read what the node before it gives; a brain has its layers in a row")
        first = first or read[0]
        current = set(node.output[: 2 if node.op_type in RECURRENT else 1]) - {""}
        name = f"layer {len(layers)}"
        if node.op_type == "Gemm":
            weights = _constant(constants, node.input[1], place)
            weights = given.get("alpha", 1.0) * (weights if given.get("transB", 0) else weights.T)
            bias = given.get("beta", 1.0) * _constant(constants, node.input[2], place) if len(node.input) > 2 else None
            layers.append(_layer(layers, weights, bias, "linear", name, place))
        elif node.op_type == "MatMul":
            layers.append(_layer(layers, _constant(constants, node.input[1], place).T, None, "linear", name, place))
        elif node.op_type == "Add":
            if not layers:
                raise InputError(f"{place}: adds to the senses, not to a layer")
            constant = node.input[1] if node.input[0] == read[0] else node.input[0]
            bias = np.broadcast_to(_constant(constants, constant, place), layers[-1]["neurons"])
            layers[-1]["bias"] = (np.asarray(layers[-1].get("bias", 0.0)) + bias).tolist()
        elif node.op_type in RECURRENT:
            if any(size > 1 for size in shapes[first][:-1]):
                raise InputError(f"{place}: a robot thinks once at a time; give sequences and batches of 1")
            layers += _recurrent(layers, node, given, constants, name, place)
        elif node.op_type in ACTIVATIONS and node.op_type != "Identity":
            _activate(layers, ACTIVATIONS[node.op_type], place)
    if not layers:
        raise InputError(f"{os.fspath(path)}: holds no layer")
    if not any(value.name in current for value in graph.output):
        raise InputError(f"{os.fspath(path)}: its output is not what its last layer gives")
    return {"period": period, "layers": layers}


def to_onnx(brain: dict[str, Any], senses: int, path: str | os.PathLike[str]) -> None:
    """Writes a brain of layers in a row, as Robot.brain has it, as an ONNX file: from "senses" (batch, senses) to "drives"
    (batch, actuators). Layers that are an LSTM, as lstm() makes them, become an LSTM node, whose state is explicit: inputs
    "NAME hidden" and "NAME cell" (1, batch, cells), which are 0 at the start, and outputs "next NAME hidden" and "next NAME
    cell". Needs the package onnx.

    Raises InputError for a brain with other memory: one whose layers have an alpha below 1, learn, or read themselves or
    later ones."""
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    operators = {name: operator for operator, name in ACTIVATIONS.items()}
    nodes, value, size, before = [], "senses", senses, "senses"
    constants: dict[str, NDArray[Any]] = {}
    inputs: list[tuple[str, list[Any]]] = [("senses", ["batch", senses])]
    outputs: list[tuple[str, list[Any]]] = []
    layers = brain["layers"]
    number = 0
    while number < len(layers):
        if weights := _lstm_at(layers[number : number + 5], before, size):
            layer = layers[number + 4]
            name, size = layer["name"], layer["neurons"]
            constants["first"] = np.zeros(1, np.int64)
            constants.update({f"{name} {part}": array[None] for part, array in zip("WRB", weights, strict=True)})
            state = [f"{name} hidden", f"{name} cell"]
            inputs += [(part, [1, "batch", size]) for part in state]
            outputs += [(f"next {part}", [1, "batch", size]) for part in state]
            nodes += [
                helper.make_node("Unsqueeze", [value, "first"], [f"{name} input"]),
                helper.make_node(
                    "LSTM",
                    [f"{name} input", *(f"{name} {part}" for part in "WRB"), "", *state],
                    ["", *(f"next {part}" for part in state)],
                    hidden_size=size,
                ),
                helper.make_node("Squeeze", [f"next {name} hidden", "first"], [f"value {number + 4}"]),
            ]
            number += 4
        else:
            layer = layers[number]
            matrices = _matrices(layer, {before: size})
            if matrices is None or len(matrices) != 1 or "gate" in layer or "keep" in layer:
                raise InputError(
                    f"/brain/layers/{number}: ONNX takes layers in a row, each of alpha 1, without memory other than that of an LSTM"
                )
            constants[f"weights {number}"] = matrices[before]
            constants[f"bias {number}"] = _bias(layer)
            operands = [value, f"weights {number}", f"bias {number}"]
            nodes += [
                helper.make_node("Gemm", operands, [f"sum {number}"], transB=1),
                helper.make_node(operators[layer.get("activation", "tanh")], [f"sum {number}"], [f"value {number}"]),
            ]
        value, size, before = f"value {number}", layer["neurons"], layer["name"]
        number += 1
    nodes.append(helper.make_node("Identity", [value], ["drives"]))
    outputs.insert(0, ("drives", ["batch", size]))
    graph = helper.make_graph(
        nodes, "brain",
        [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape) for name, shape in inputs],
        [helper.make_tensor_value_info(name, TensorProto.FLOAT, shape) for name, shape in outputs],
        [numpy_helper.from_array(array, name) for name, array in constants.items()],
    )  # fmt: skip
    model = helper.make_model(graph, producer_name="mercury", opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    onnx.save(model, os.fspath(path))


def _layer(
    before: list[dict[str, Any]], weights: ArrayLike, bias: ArrayLike | None, activation: str, name: str, place: str = ""
) -> dict[str, Any]:
    matrix = np.asarray(weights, np.float32)
    place = place or f"layers[{len(before)}]"
    if matrix.ndim != 2:
        raise InputError(f"{place}: weights must be (neurons, inputs), not {matrix.shape}")
    if before and matrix.shape[1] != before[-1]["neurons"]:
        raise InputError(f"{place}: {matrix.shape[1]} inputs, the layer before has {before[-1]['neurons']} neurons")
    source = before[-1]["name"] if before else "senses"
    layer: dict[str, Any] = {"name": name, "neurons": matrix.shape[0], "activation": activation}
    if bias is not None:
        numbers = np.asarray(bias, np.float32)
        if numbers.shape != (matrix.shape[0],):
            raise InputError(f"{place}: a bias must be ({matrix.shape[0]},), not {numbers.shape}")
        layer["bias"] = numbers.tolist()
    layer["inputs"] = [{"from": source, "weights": matrix.tolist()}]
    return layer


def _activate(layers: list[dict[str, Any]], activation: str, place: str) -> None:
    if not layers or layers[-1].get("activation") != "linear":
        raise InputError(f"{place}: follows no layer that is without an activation")
    layers[-1]["activation"] = activation


def _numbers(module: Any, name: str) -> Any:
    """A parameter of a module of PyTorch; None if it has none of that name."""
    values = getattr(module, name, None)
    return None if values is None else np.asarray(values.detach().cpu().tolist(), np.float32)


def _torch_recurrent(before: list[dict[str, Any]], module: Any, level: int, place: str) -> list[dict[str, Any]]:
    """The layers of one level of an RNN, LSTM or GRU of PyTorch."""
    weights, own, bias, own_bias = (
        _numbers(module, f"{part}_l{level}") for part in ("weight_ih", "weight_hh", "bias_ih", "bias_hh")
    )
    if weights is None or own is None:
        raise InputError(f"{place}: has no weights")
    name, source = f"layer {len(before)}", before[-1]["name"] if before else "senses"
    if before and weights.shape[1] != before[-1]["neurons"]:
        raise InputError(f"{place}: {weights.shape[1]} inputs, the layer before has {before[-1]['neurons']} neurons")
    if module.mode == "GRU":
        return _gru(weights, own, bias, own_bias, name, source)
    sums = None if bias is None or own_bias is None else bias + own_bias
    if module.mode == "LSTM":
        return _lstm(weights, own, sums, name, source, place)
    layer = _layer(before, weights, sums, "relu" if module.mode == "RNN_RELU" else "tanh", name, place)
    layer["inputs"].append({"from": name, "weights": own.tolist()})
    return [layer]


def _gru(
    weights: NDArray[Any],
    own: NDArray[Any],
    bias: NDArray[Any] | None,
    own_bias: NDArray[Any] | None,
    name: str,
    source: str,
    *,
    reset_after: bool = True,
) -> list[dict[str, Any]]:
    """h = (1 - z) n + z h, with n = tanh(W s + b + r (R h + c)), or n = tanh(W s + b + R (r h) + c) without `reset_after`;
    weights in PyTorch's order: r, z, n."""
    count = own.shape[1]
    of_source, of_hidden = weights.reshape(3, count, -1), own.reshape(3, count, count)
    b, c = (np.zeros((3, count), np.float32) if part is None else part.reshape(3, count) for part in (bias, own_bias))

    def gate(part: str, sign: int, k: int) -> dict[str, Any]:
        return {
            "name": f"{name} {part}", "neurons": count, "activation": "sigmoid", "bias": (sign * (b[k] + c[k])).tolist(),
            "inputs": [{"from": source, "weights": (sign * of_source[k]).tolist()},
                       {"from": name, "weights": (sign * of_hidden[k]).tolist()}],
        }  # fmt: skip

    product, one_to_one = {"weights": of_hidden[2].tolist()}, {"edges": [[i, i, 1] for i in range(count)]}
    recalled, read = (product, one_to_one) if reset_after else (one_to_one, product)
    recall = {"name": f"{name} recall", "neurons": count, "activation": "linear", "gate": f"{name} reset", "keep": 0}
    recall["inputs"] = [{"from": name, **recalled}]
    hidden = {"name": name, "neurons": count, "gate": f"{name} change"}
    hidden["inputs"] = [{"from": source, "weights": of_source[2].tolist()}, {"from": f"{name} recall", **read}]
    if reset_after:
        recall["bias"], hidden["bias"] = c[2].tolist(), b[2].tolist()
    else:
        hidden["bias"] = (b[2] + c[2]).tolist()
    return [gate("reset", 1, 0), gate("change", -1, 1), recall, hidden]  # 1 - sigmoid(x) = sigmoid(-x)


def _constant(constants: dict[str, Any], name: str, place: str) -> Any:
    if name not in constants:
        raise InputError(f"{place}: {name} is no constant of the file")
    return constants[name].astype(np.float32)


def _recurrent(
    before: list[dict[str, Any]], node: Any, given: dict[str, Any], constants: dict[str, Any], name: str, place: str
) -> list[dict[str, Any]]:
    """The layers of an RNN, LSTM or GRU node."""
    inputs = [*node.input, *[""] * 8][:8]  # X, W, R, B, sequence_lens, initial_h, initial_c, P
    stacked, accepted = RECURRENT[node.op_type]
    activations = [text.decode() for text in given.get("activations", [])] or accepted[0]
    if given.get("direction", b"forward") != b"forward" or activations not in accepted:
        raise InputError(f"{place}: must run forward, with {' or '.join(', '.join(names) for names in accepted)}")
    if "clip" in given or given.get("input_forget", 0):
        raise InputError(f"{place}: a brain has neither clip nor input_forget")
    if inputs[7]:
        raise InputError(f"{place}: has peepholes (P), which a brain has not; train it without them")
    if inputs[4]:
        raise InputError(f"{place}: has sequence_lens; a brain has one sequence, which goes on")
    if any(np.any(constants[state]) for state in inputs[5:7] if state in constants):
        raise InputError(f"{place}: has a state at the start that is not 0")
    if not inputs[1] or not inputs[2]:
        raise InputError(f"{place}: needs W and R, its weights")
    given_weights, given_own = (_constant(constants, part, place) for part in inputs[1:3])
    size = given_own.shape[-1] if given_own.ndim == 3 else 0
    rows = stacked * size
    if given_weights.ndim != 3 or given_weights.shape[:2] != (1, rows) or given_own.shape != (1, rows, size):
        count = f"{stacked} neurons" if stacked > 1 else "neurons"
        sizes = f"(1, {count}, inputs) and (1, {count}, neurons)"
        raise InputError(f"{place}: W and R must be {sizes}, not {given_weights.shape} and {given_own.shape}")
    given_bias = _constant(constants, inputs[3], place) if inputs[3] else np.zeros((1, 2 * rows), np.float32)
    if given_bias.shape != (1, 2 * rows):
        raise InputError(f"{place}: B must be (1, {2 * rows}), not {given_bias.shape}")
    weights, own, bias, own_bias = given_weights[0], given_own[0], given_bias[0, :rows], given_bias[0, rows:]
    if before and weights.shape[1] != before[-1]["neurons"]:
        raise InputError(f"{place}: {weights.shape[1]} inputs, the layer before has {before[-1]['neurons']} neurons")
    source = before[-1]["name"] if before else "senses"
    if node.op_type == "LSTM":
        order = _rows(size, 0, 2, 3, 1)  # of i, o, f, c
        return _lstm(weights[order], own[order], (bias + own_bias)[order] if inputs[3] else None, name, source, place)
    if node.op_type == "GRU":
        order = _rows(size, 1, 0, 2)  # of z, r, h
        reset_after = bool(given.get("linear_before_reset", 0))
        return _gru(weights[order], own[order], bias[order], own_bias[order], name, source, reset_after=reset_after)
    layer = _layer(before, weights, bias + own_bias if inputs[3] else None, ACTIVATIONS[activations[0]], name, place)
    layer["inputs"].append({"from": name, "weights": own.tolist()})
    return [layer]


def _rows(size: int, *parts: int) -> NDArray[Any]:
    """Indices of the rows of stacked matrices of `size` rows each, in another order of the matrices."""
    return np.concatenate([np.arange(size) + part * size for part in parts])


def _lstm(
    weights: ArrayLike, recurrent: ArrayLike, bias: ArrayLike | None, name: str, source: str, place: str
) -> list[dict[str, Any]]:
    of_source, of_hidden = np.asarray(weights, np.float32), np.asarray(recurrent, np.float32)
    if of_source.ndim != 2 or of_hidden.ndim != 2 or not len(of_source) == len(of_hidden) == 4 * of_hidden.shape[1]:
        shapes = f"{of_source.shape} and {of_hidden.shape}"
        raise InputError(f"{place}: weights must be (4 cells, inputs) and (4 cells, cells), not {shapes}")
    count = of_hidden.shape[1]
    numbers = None if bias is None else np.asarray(bias, np.float32)
    if numbers is not None and numbers.shape != (4 * count,):
        raise InputError(f"{place}: a bias must be ({4 * count},), not {numbers.shape}")
    parts = []
    for number, part in enumerate(("input", "forget", "cell", "output")):
        rows = slice(number * count, (number + 1) * count)
        layer: dict[str, Any] = {"name": f"{name} {part}", "neurons": count}
        layer["activation"] = "tanh" if part == "cell" else "sigmoid"
        if numbers is not None:
            layer["bias"] = numbers[rows].tolist()
        layer["inputs"] = [
            {"from": source, "weights": of_source[rows].tolist()},
            {"from": name, "weights": of_hidden[rows].tolist()},
        ]
        parts.append(layer)
    gates, cell = [parts[0], parts[1], parts[3]], parts[2]
    cell.update(gate=f"{name} input", keep=f"{name} forget")
    one_to_one = [{"from": f"{name} cell", "edges": [[i, i, 1] for i in range(count)]}]
    hidden = {"name": name, "neurons": count, "gate": f"{name} output", "keep": 0, "inputs": one_to_one}
    return [*gates, cell, hidden]


def _bias(layer: dict[str, Any]) -> NDArray[Any]:
    return np.asarray(layer.get("bias", np.zeros(layer["neurons"])), np.float32)


def _matrices(layer: dict[str, Any], sizes: dict[str, int]) -> dict[str, NDArray[Any]] | None:
    """The weights of a layer by what it reads; None if it reads something else than `sizes` has, learns, or has an alpha."""
    if np.any(np.asarray(layer.get("alpha", 1)) != 1):
        return None
    found: dict[str, NDArray[Any]] = {}
    for given in layer.get("inputs", []):
        if given["from"] not in sizes or given.get("rate", 0):
            return None
        shape = (layer["neurons"], sizes[given["from"]])
        matrix = found.setdefault(given["from"], np.zeros(shape, np.float32))
        if "weights" in given:
            matrix += np.asarray(given["weights"], np.float32)
        for to, source, weight in given.get("edges", []):
            matrix[to, source] += weight
    return found


def _lstm_at(layers: list[dict[str, Any]], before: str, size: int) -> list[NDArray[Any]] | None:
    """W, R and B, as ONNX has them, of five layers that are an LSTM; None if they are none."""
    if len(layers) < 5:
        return None
    cell, hidden = layers[3:]
    gates = {layer["name"]: layer for layer in layers[:3]}
    roles = [cell.get("gate"), hidden.get("gate"), cell.get("keep")]  # input, output, forget: ONNX's order
    count = hidden["neurons"]
    sigmoids = all(gate.get("activation") == "sigmoid" and "gate" not in gate and "keep" not in gate for gate in gates.values())
    tanhs = all(layer.get("activation", "tanh") == "tanh" for layer in (cell, hidden))
    if not all(isinstance(role, str) for role in roles) or set(roles) != set(gates) or not (sigmoids and tanhs):
        return None
    copies = _matrices(hidden, {cell["name"]: count})
    plain = copies is not None and len(copies) == 1 and np.array_equal(copies[cell["name"]], np.eye(count))
    if not plain or np.any(_bias(hidden)) or hidden.get("keep") != 0:
        return None
    parts = [*(gates[role] for role in roles), cell]
    matrices = [_matrices(layer, {before: size, hidden["name"]: count}) for layer in parts]
    if any(each is None for each in matrices):
        return None
    stacked = [
        np.concatenate([(each or {}).get(source, np.zeros((count, width), np.float32)) for each in matrices])
        for source, width in ((before, size), (hidden["name"], count))
    ]
    biases = np.concatenate([*(_bias(layer) for layer in parts), np.zeros(4 * count, np.float32)])
    return [*stacked, biases]
