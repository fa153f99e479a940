# SPDX-License-Identifier: Apache-2.0
"""Writes the robots with which the searches for brains began (docs/library.md): bodies of the samples, whose brains do not
react to what they sense.

    python3 robots/library/animals/brains.py starts
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

LIBRARY = Path(__file__).resolve().parents[1]
Robot = dict[str, Any]
Edge = list[float]  # to, from, weight


def sample(name: str) -> Robot:
    return json.loads((LIBRARY / f"{name}.json").read_text())


def with_brain(robot: Robot, sensors: list[dict[str, Any]], layers: list[dict[str, Any]]) -> Robot:
    robot["sensors"], robot["brain"] = sensors, {"period": 0.01, "layers": layers}
    robot["requires"] = [*robot.get("requires", []), "brain"]
    return robot


def waves(robot: Robot) -> list[tuple[float, float]]:
    """Frequency and phase of each actuator: of muscles that move alike."""
    used = {spring[2] for spring in robot["springs"]}
    muscles = [m for i, m in enumerate(robot["materials"]) if i in used and m["amplitude"] != 0]
    return list(dict.fromkeys((muscle["frequency"], muscle["phase"]) for muscle in muscles))


def blank_swimmer(name: str) -> Robot:
    """A clock for each muscle and one neuron that bends all of the body. All weights are 0."""
    robot = sample(name)
    count = len(waves(robot))
    turn = {"name": "turn", "neurons": 1, "alpha": 0.1, "inputs": [{"from": "senses", "edges": [[0, 3, 0]]}]}
    clock = [[i, k, 0] for i in range(count) for k in (0, 1)]
    wave = {"name": "wave", "neurons": count, "activation": "linear",
            "inputs": [{"from": "senses", "edges": clock}, {"from": "turn", "weights": [[0]] * count}]}  # fmt: skip
    sensors = [{"kind": "clock", "frequency": waves(robot)[0][0]}, {"kind": "target_direction"}]
    return with_brain(robot, sensors, [turn, wave])


def two_sided(name: str) -> tuple[Robot, list[tuple[bool, float]], float]:
    """A walker with an actuator per side and phase of its muscles; which side and phase each is, and the frequency."""
    robot = sample(name)
    materials, y = robot["materials"], [mass[1] for mass in robot["masses"]]
    count, left_of = len(materials), {}
    for spring in robot["springs"]:
        material = spring[2]
        if materials[material]["amplitude"] != 0 and y[spring[0]] + y[spring[1]] > 0:
            if material not in left_of:
                left_of[material] = len(materials)
                materials.append(dict(materials[material]))
            spring[2] = left_of[material]
    groups: dict[tuple[bool, float], list[int]] = {}
    for material in sorted({spring[2] for spring in robot["springs"] if materials[spring[2]]["amplitude"] != 0}):
        groups.setdefault((material >= count, materials[material]["phase"]), []).append(material)
    sides = sorted(groups, key=lambda group: (not group[0], group[1]))
    numbers = {True: 0, False: 0}
    robot["actuators"] = []
    for side in sides:
        numbers[side[0]] += 1
        label = f"{'left' if side[0] else 'right'} {numbers[side[0]]}"
        robot["actuators"].append({"name": label, "materials": groups[side]})
    return robot, sides, materials[groups[sides[0]][0]]["frequency"]


def rounded(weight: float) -> float:
    return round(weight, 4)


def blind_moth() -> Robot:
    """The ant with an eye on each side. Its gait is the ant's; the neuron "turn" reads both eyes with weights of 0.

    A pair of neurons, tanh(g (s + x)) + tanh(g (s - x)), passes a sine s where x is near 0 and nothing where x is far
    from it. x = 0.6 + 1.2 t of the one pair and 1.6 (1 - t) of the other follow the neuron t: the first swings the legs
    of a side ahead, the second backwards. On the other side t counts the other way. So t turns the robot.
    """
    robot, sides, frequency = two_sided("ant")
    masses = robot["masses"]
    front = max(mass[0] for mass in masses) - 0.25

    def eye(side: int) -> list[int]:
        return [i for i, (x, y, z) in enumerate(masses) if x > front and side * y > 0.05 and z > 0][:8]

    sensors = [{"kind": "clock", "frequency": frequency}]
    sensors += [{"kind": "light", "masses": eye(side), "gain": 60} for side in (1, -1)]
    gain, bias, clock, turned = 1.5, [], [], []
    for side in (1, -1):
        for offset, slope in ((0.6, 1.2), (1.6, -1.6)):
            for sign in (1, -1):
                clock.append([len(bias), 0, gain])
                turned.append([len(bias), 0, rounded(side * sign * slope * gain)])
                bias.append(rounded(sign * offset * gain))
    swing: list[Edge] = []
    lift: list[Edge] = []
    for i, (left, phase) in enumerate(sides):
        for k, weight in enumerate((0.62, 0.62, -0.5, -0.5)):
            swing.append([i, k + (0 if left else 4), rounded(weight * math.cos(phase))])
        lift.append([i, 1, rounded(math.sin(phase))])
    return with_brain(robot, sensors, [
        {"name": "turn", "neurons": 1, "alpha": 0.1, "bias": [0],
         "inputs": [{"from": "senses", "edges": [[0, 2, 0], [0, 3, 0]]}]},
        {"name": "stride", "neurons": 8, "bias": bias,
         "inputs": [{"from": "senses", "edges": clock}, {"from": "turn", "edges": turned}]},
        {"name": "legs", "neurons": len(sides), "activation": "linear",
         "inputs": [{"from": "stride", "edges": swing}, {"from": "senses", "edges": lift}]},
    ])  # fmt: skip


def numb_ant() -> Robot:
    """The ant with a sense of balance and of touch, and four neurons for them, which do not drive its legs yet."""
    robot, sides, frequency = two_sided("ant")
    ground = min(mass[2] for mass in robot["masses"]) + 1e-3

    def feet(side: int) -> list[int]:
        return [i for i, (_, y, z) in enumerate(robot["masses"]) if z < ground and side * y > 0]

    sensors = [{"kind": "clock", "frequency": frequency}, {"kind": "up"}, {"kind": "turn_rate", "gain": 0.3},
               {"kind": "velocity"}] + [{"kind": "touch", "masses": feet(side)} for side in (1, -1)]  # fmt: skip
    # Rolling, sideways velocity, pitching, standing on one side.
    begin = {(0, 3): 2, (0, 5): 1, (1, 9): 1, (2, 2): 2, (2, 6): 1, (3, 11): 1, (3, 12): -1}
    reflex = [[to, sense, begin.get((to, sense), 0)] for to in range(4) for sense in range(2, 13)]
    gait = [[i, k, rounded((math.cos(phase), math.sin(phase))[k])] for i, (_, phase) in enumerate(sides) for k in (0, 1)]
    return with_brain(robot, sensors, [
        {"name": "reflex", "neurons": 4, "bias": [0] * 4, "inputs": [{"from": "senses", "edges": reflex}]},
        {"name": "legs", "neurons": len(sides), "activation": "linear", "bias": [0] * len(sides),
         "inputs": [{"from": "senses", "edges": gait}, {"from": "reflex", "weights": [[0] * 4] * len(sides)}]},
    ])  # fmt: skip


STARTS = {"eel": lambda: blank_swimmer("eel"), "fish": lambda: blank_swimmer("fish"), "moth": blind_moth, "ant": numb_ant}


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(str(__doc__))
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in STARTS.items():
        (folder / f"{name}.json").write_text(json.dumps(make()) + "\n")


if __name__ == "__main__":
    main()
