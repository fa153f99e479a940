# SPDX-License-Identifier: Apache-2.0
"""Brains of modules of PyTorch do what PyTorch says, thought by thought."""
import numpy as np
import pytest

import mercurysim
from mercurysim import brains

torch = pytest.importorskip("torch")
nn = torch.nn

SENSES = [{"kind": "clock", "frequency": 6.3}, {"kind": "target_direction"}]  # five numbers
BODY = mercurysim.random_voxel(1, voxels=(5, 4, 3), seed=4, frequencies=5)[0]
COUNT = len(BODY.actuators)


def modules(kind):
    torch.manual_seed(3)
    if kind == "layers":
        return [nn.Sequential(nn.Linear(5, 7), nn.Dropout(0.5), nn.ReLU(), nn.Sequential(nn.Linear(7, COUNT), nn.Sigmoid()))]
    if kind == "without biases":
        return [nn.LSTM(5, 4, bias=False), nn.Linear(4, COUNT, bias=False)]
    recurrent = {
        "RNN": nn.RNN(5, 6), "ReLU": nn.RNN(5, 6, nonlinearity="relu"), "LSTM": nn.LSTM(5, 6), "GRU": nn.GRU(5, 6),
        "two LSTMs": nn.LSTM(5, 6, num_layers=2, batch_first=True), "two GRUs": nn.GRU(5, 6, num_layers=2),
    }[kind]  # fmt: skip
    with torch.no_grad():
        for name, values in recurrent.named_parameters():  # each bias counts
            if name.startswith("bias"):
                values.uniform_(-1, 1)
    return [recurrent, nn.Linear(6, COUNT), nn.Tanh()]


@pytest.mark.parametrize("kind", ["layers", "without biases", "RNN", "ReLU", "LSTM", "GRU", "two LSTMs", "two GRUs"])
def test_a_robot_does_what_pytorch_says(kind):
    made = modules(kind)
    batch = mercurysim.Batch(BODY.with_brain(brains.from_torch(*made), SENSES), device="cpu")
    senses, drives = [], []
    for _ in range(50):
        batch.step(20)
        senses.append(batch.brain.senses[0].copy())
        drives.append(np.asarray(batch.actuation.drive)[0].copy())
    with torch.no_grad():
        value = torch.tensor(np.array(senses))  # (thoughts, 5): a sequence, without a batch
        for module in made:
            value = module.eval()(value)
            value = value[0] if isinstance(value, tuple) else value
    expected = np.clip(np.array(value.tolist()), -1, 1)
    np.testing.assert_allclose(drives, expected, atol=5e-6)
    assert np.ptp(expected, axis=0).max() > 0.01


def test_brains_of_pytorch_go_into_files(tmp_path):
    robot = BODY.with_brain(brains.from_torch(*modules("GRU"), period=0.01), SENSES)
    assert [layer["name"] for layer in robot.brain["layers"]] == [
        "layer 0 reset", "layer 0 change", "layer 0 recall", "layer 0", "layer 4"
    ]  # fmt: skip
    assert robot.brain["period"] == pytest.approx(0.01)
    robot.save(tmp_path / "trained.json")
    assert mercurysim.load(tmp_path / "trained.json") == robot


@pytest.mark.parametrize(("made", "message"), [
    ([], "modules: a brain needs at least one layer"),
    ([nn.Linear(5, 3), nn.Conv1d(1, 1, 1)], "modules[1] (Conv1d): is no layer of a brain; there are Linear, "),
    ([nn.Sequential(nn.Linear(5, 3), nn.Linear(4, 2))], "modules[0].1 (Linear): 4 inputs, the layer before has 3 neurons"),
    ([nn.Linear(5, 3), nn.GRU(4, 2)], "modules[1] (GRU): 4 inputs, the layer before has 3 neurons"),
    ([nn.Tanh()], "modules[0] (Tanh): follows no layer that is without an activation"),
    ([nn.LSTM(5, 3), nn.ReLU()], "modules[1] (ReLU): follows no layer that is without an activation"),
    ([nn.LSTM(5, 3, bidirectional=True)], "modules[0] (LSTM): must run forward, "),
    ([nn.LSTM(5, 3, proj_size=2)], "modules[0] (LSTM): must run forward, without a projection"),
])
def test_other_modules_are_refused(made, message):
    with pytest.raises(mercurysim.InputError) as error:
        brains.from_torch(*made)
    assert str(error.value).startswith(message)
