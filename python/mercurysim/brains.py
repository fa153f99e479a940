# SPDX-License-Identifier: Apache-2.0
"""Brains from the weights of networks, and ONNX files, for Robot.with_brain() (docs/brains.md)."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import InputError

ACTIVATIONS = {"Tanh": "tanh", "Sigmoid": "sigmoid", "Relu": "relu", "Sin": "sine", "Identity": "linear"}


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
        made.append(_layer(made, weights, bias, output if last else activation, "motor" if last else f"layer {number}"))
    if not made:
        raise InputError("layers: a brain needs at least one layer")
    return {"period": period, "layers": made}


def from_onnx(path: str | os.PathLike[str], *, period: float = 0.02) -> dict[str, Any]:
    """The brain of an ONNX file: layers in a row (Gemm, or MatMul and Add), each with an activation (Tanh, Sigmoid, Relu,
    Sin, or none), and recurrent layers (RNN with Tanh). Needs the package onnx.

    Raises InputError, which names the node, for others: an LSTM has gates, which are no such layers.
    """
    import onnx
    from onnx import numpy_helper

    try:
        model = onnx.load(os.fspath(path))
    except Exception as error:  # protobuf has many
        reason = (str(error).splitlines() or ["it is empty"])[0]
        raise InputError(f"{os.fspath(path)}: is no ONNX file: {reason}") from None
    constants = {tensor.name: numpy_helper.to_array(tensor) for tensor in model.graph.initializer}
    layers: list[dict[str, Any]] = []
    for number, node in enumerate(model.graph.node):
        place = f"{os.fspath(path)}: node {number} ({node.op_type})"
        given = {attribute.name: onnx.helper.get_attribute_value(attribute) for attribute in node.attribute}
        if node.op_type == "Constant":
            constants[node.output[0]] = numpy_helper.to_array(given["value"])
        elif node.op_type == "Gemm":
            weights = _constant(constants, node.input[1], place)
            weights = given.get("alpha", 1.0) * (weights if given.get("transB", 0) else weights.T)
            bias = given.get("beta", 1.0) * _constant(constants, node.input[2], place) if len(node.input) > 2 else None
            layers.append(_layer(layers, weights, bias, "linear", f"layer {len(layers)}", place))
        elif node.op_type == "MatMul":
            weights = _constant(constants, node.input[1], place).T
            layers.append(_layer(layers, weights, None, "linear", f"layer {len(layers)}", place))
        elif node.op_type == "Add" and layers:
            name = node.input[1] if node.input[1] in constants else node.input[0]
            bias = np.broadcast_to(_constant(constants, name, place), layers[-1]["neurons"])
            layers[-1]["bias"] = (np.asarray(layers[-1].get("bias", 0.0)) + bias).tolist()
        elif node.op_type == "RNN":
            layers.append(_recurrent(layers, node, given, constants, place))
        elif node.op_type in ACTIVATIONS and layers and layers[-1]["activation"] == "linear":
            layers[-1]["activation"] = ACTIVATIONS[node.op_type]
        elif node.op_type not in ("Flatten", "Identity", "Squeeze", "Clip"):  # drives are limited to [-1, 1] in any case
            known = "Gemm, MatMul, Add, RNN, " + ", ".join(ACTIVATIONS)
            raise InputError(f"{place}: is no layer of a brain; there are {known}")
    if not layers:
        raise InputError(f"{os.fspath(path)}: holds no layer")
    return {"period": period, "layers": layers}


def to_onnx(brain: dict[str, Any], senses: int, path: str | os.PathLike[str]) -> None:
    """Writes a brain of layers in a row, as Robot.brain has it, as an ONNX file: from "senses" (batch, senses) to "drives"
    (batch, actuators). Needs the package onnx. Raises InputError for a brain with memory: one whose layers have an alpha
    below 1, learn, or read themselves or later ones."""
    import onnx
    from onnx import TensorProto, helper, numpy_helper

    operators = {name: operator for operator, name in ACTIVATIONS.items()}
    nodes, constants, value, size, before = [], [], "senses", senses, "senses"
    for number, layer in enumerate(brain["layers"]):
        inputs = layer.get("inputs", [])
        in_a_row = len(inputs) == 1 and inputs[0]["from"] == before
        if not in_a_row or inputs[0].get("rate", 0) or np.any(np.asarray(layer.get("alpha", 1)) != 1):
            raise InputError(f"/brain/layers/{number}: ONNX takes layers in a row, each of alpha 1, without memory")
        weights = np.zeros((layer["neurons"], size), np.float32)
        for to, source, weight in inputs[0].get("edges", []):
            weights[to, source] += weight
        if "weights" in inputs[0]:
            weights = np.asarray(inputs[0]["weights"], np.float32)
        bias = np.asarray(layer.get("bias", np.zeros(layer["neurons"])), np.float32)
        constants.append(numpy_helper.from_array(weights, f"weights {number}"))
        constants.append(numpy_helper.from_array(bias, f"bias {number}"))
        nodes.append(helper.make_node("Gemm", [value, f"weights {number}", f"bias {number}"], [f"sum {number}"], transB=1))
        nodes.append(helper.make_node(operators[layer.get("activation", "tanh")], [f"sum {number}"], [f"value {number}"]))
        value, size, before = f"value {number}", layer["neurons"], layer["name"]
    nodes.append(helper.make_node("Identity", [value], ["drives"]))
    graph = helper.make_graph(
        nodes, "brain",
        [helper.make_tensor_value_info("senses", TensorProto.FLOAT, ["batch", senses])],
        [helper.make_tensor_value_info("drives", TensorProto.FLOAT, ["batch", size])],
        constants,
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


def _constant(constants: dict[str, Any], name: str, place: str) -> Any:
    if name not in constants:
        raise InputError(f"{place}: {name} is no constant of the file")
    return constants[name].astype(np.float32)


def _recurrent(
    before: list[dict[str, Any]], node: Any, given: dict[str, Any], constants: dict[str, Any], place: str
) -> dict[str, Any]:
    activations = [text.decode() for text in given.get("activations", [b"Tanh"])]
    if given.get("direction", b"forward") != b"forward" or activations != ["Tanh"]:
        raise InputError(f"{place}: a recurrent layer runs forward, with Tanh")
    weights, own = (_constant(constants, node.input[k], place)[0] for k in (1, 2))
    bias = _constant(constants, node.input[3], place)[0] if len(node.input) > 3 and node.input[3] else None
    size = weights.shape[0]
    sums = None if bias is None else bias[:size] + bias[size:]
    layer = _layer(before, weights, sums, "tanh", f"layer {len(before)}", place)
    layer["inputs"].append({"from": layer["name"], "weights": own.tolist()})
    return layer
