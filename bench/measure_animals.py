# SPDX-License-Identifier: Apache-2.0
"""Measures the sample animals and writes their table into docs/library.md.

    PYTHONPATH=build/python python3 bench/measure_animals.py                 all; some minutes on two cores
    PYTHONPATH=build/python python3 bench/measure_animals.py eel fish        these; the others' rows stay
    PYTHONPATH=build/python python3 bench/measure_animals.py --print eel     prints instead

Verdict, median and quartiles are those of `mercury check` (MERCURY_PROGRAM, or build/bin/mercury) at the default step of 1 ms;
the rest is of one run without jitter.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import mercurysim

ROOT = Path(__file__).resolve().parents[1]
LIBRARY = ROOT / "robots" / "library"
SECONDS, SETTLE = 20, 1  # all muscles set in at once, so the first second is no gait
GRAVITY = 9.81
HEAD = "| animal | lives in | masses | length | median (quartiles) from 1 s to 20 s | body lengths/s | Strouhal | cost of transport | verdict |"


@dataclass
class Gait:
    """How a robot moves in the last two thirds of a run."""

    speed: float  # [m/s]
    length: float  # of the body [m]
    period: float  # of its slowest muscle [s]
    strouhal: float  # f A / U, A the way from side to side of the end that comes last
    cost: float  # of transport: mean power of the muscles over weight times speed [1]
    speeds: Any  # [m/s] ahead, in steps of `interval`
    interval: float


def gait(robot: Any, seconds: float = SECONDS, dt: float = 1e-3) -> Gait:
    batch = mercurysim.Batch([robot], environment_of(robot), dt=dt, damping=0, device="cpu")
    stride = round(0.02 / dt)
    interval = stride * dt
    positions, power, kept = [], [], round(seconds / 3 / interval)
    for step in range(round(seconds / interval) + 1):
        if step >= kept:
            positions.append(batch.positions.numpy())
            power.append(float(batch.telemetry()["muscle_power"][0]))
        batch.step(stride)
    x = np.array(positions, float)
    centers = np.einsum("tmk,m->tk", x, robot.mass / robot.mass.sum())
    if robot.origin["environment"] == "land":
        centers[:, 2] = 0
    way = centers[-1] - centers[0]
    speed = float(np.linalg.norm(way)) / (interval * (len(x) - 1))
    ahead = way / np.linalg.norm(way)
    moving = [float(robot.materials[m, 2]) for m in np.unique(robot.springs["material"]) if robot.materials[m, 1]]
    period = 2 * math.pi / min(moving)
    axis = int(np.argmax(np.ptp(robot.masses, axis=0)))
    along = robot.masses[:, axis]
    ends = [x[:, mask].mean(axis=1) for mask in (along < along.min() + 1e-4, along > along.max() - 1e-4)]
    last = ends[0] if (ends[0] - ends[1]).mean(axis=0) @ ahead < 0 else ends[1]
    across = last - np.outer(last @ ahead, ahead)
    # Without what is slower than a beat: a path that bends is no beat.
    beat = round(period / interval)
    mean = np.array([np.convolve(part, np.ones(beat) / beat, "valid") for part in across.T]).T
    across = across[beat // 2 : beat // 2 + len(mean)] - mean
    side = across @ np.linalg.svd(across, full_matrices=False)[2][0]
    widths = [np.ptp(side[i : i + beat + 1]) for i in range(0, len(side) - beat, beat)]
    whole = round(len(power) // (period / interval) * period / interval)  # samples of whole beats
    return Gait(
        speed=speed,
        length=float(np.ptp(along)),
        period=period,
        strouhal=float(np.mean(widths)) / period / speed,
        cost=float(np.mean(power[-whole:])) / (float(robot.mass.sum()) * GRAVITY * speed),
        speeds=np.diff(centers @ ahead) / interval,
        interval=interval,
    )


def environment_of(robot: Any) -> Any:
    name = robot.origin["environment"]
    # As the program does for real bodies (default_configuration() in sim/configuration.cpp).
    return mercurysim.Land(stiffness_scale=1, relative_stiffness=1.0, contact_distance=0.9) if name == "land" else name


def checked(file: Path) -> dict[str, Any]:
    program = os.environ.get("MERCURY_PROGRAM", str(ROOT / "build" / "bin" / "mercury"))
    command = [program, "check", str(file), "--seconds", str(SECONDS), "--settle", str(SETTLE),
               "--device", "cpu", "--json", "--quiet"]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise SystemExit(done.stderr)
    return json.loads(done.stdout)["robots"][0]


def row(file: Path) -> str:
    robot = mercurysim.load(file)
    found, check = gait(robot), checked(file)
    first = check["steps"][0]
    swings = robot.name in ("eel", "fish", "pike")
    return (
        f"| {robot.name} | {robot.origin['environment']} | {len(robot.masses)} | {found.length:.2f} m "
        f"| {first['median']:.2f} m ({first['lower_quartile']:.2f} to {first['upper_quartile']:.2f}) "
        f"| {found.speed / found.length:.2f} | {f'{found.strouhal:.2f}' if swings else ''} | {found.cost:.2f} | {check['verdict']} |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("--print", action="store_true", help="write nothing")
    options = parser.parse_args()
    page = ROOT / "docs" / "library.md"
    text = page.read_text()
    table = re.search(rf"^{re.escape(HEAD)}\n\|[-|]+\|\n((?:\|.*\n)*)", text, re.MULTILINE)
    if not table:
        raise SystemExit(f"{page}: has no table that begins with {HEAD}")
    rows = {line.split("|")[1].strip(): line for line in table[1].splitlines()}
    files = {file.stem: file for file in sorted(LIBRARY.glob("*.json"))}
    for name in options.names or files:
        rows[name] = row(files[name])
        print(rows[name], flush=True)
    if not options.print:
        kept = "".join(rows[name] + "\n" for name in files if name in rows)
        page.write_text(text[: table.start(1)] + kept + text[table.end(1) :])


if __name__ == "__main__":
    main()
