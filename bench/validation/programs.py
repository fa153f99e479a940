# SPDX-License-Identifier: Apache-2.0
"""Against other programs."""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from bodies import batch_of
from measured import EVOSORO, EVOSORO_SOURCE
from table import Result, Row, case

import mercurysim

ROOT = Path(__file__).resolve().parents[2]


def mercury(*arguments: Any) -> str:
    program = os.environ.get("MERCURY_PROGRAM", str(ROOT / "build" / "bin" / "mercury"))
    return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


@case(
    "evosoro",
    "Robots of evosoro, here and in its own simulator",
    formula="how far the center of mass gets while muscles move in the first 5 s, on land along the ground, in meters of the\n"
    "file; median of 5 trials with a jitter of a thousandth of a spring's length",
    source=EVOSORO_SOURCE,
    kind="real",
    remark="The files of `tests/data/evosoro`, imported with their worlds. Expected is the median of three runs of its simulator, with "
    "elastic moduli of 99 to 101 % of the file's; the second number of a robot's name is how far these are apart. On land muscles rest there "
    "until InitCmTime, 0.5 s, where the way begins; here they move from the start, for the other 4.5 s. Voxels add their springs "
    "and masses, so that bodies stretch, shear, bend and weigh as beams of evosoro do, and on the floor they stand on the middles of voxels. "
    "Damping (BondDampingZ) is the relaxation time of springs. quadruped_land weighs more than its legs of one voxel carry: within half a "
    "second they fold, here as there. What it walks on then are contacts: voxels push each other away as spheres of 1.5 voxels. "
    "Without SelfColEnabled its own program takes it 0.25 m the other way. In Mercury masses push each other away, within one distance. "
    "What its program does and Mercury does not is in [import.md](import.md#how-far-robots-get-here-and-there).",
)
def evosoro(short: bool) -> Result:
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in ["hexapus"] if short else EVOSORO:
            distances, why = EVOSORO[name]
            out = Path(folder) / name
            mercury("import", ROOT / "tests" / "data" / "evosoro" / f"{name}.vxa", "-o", out)
            world = out / f"{name}.toml"
            length, seconds = map(float, re.findall(r"of the file is ([\d.]+) m here, 1 s is ([\d.]+) s", world.read_text())[0])
            rest = re.findall(r"^settle = (\S+)", world.read_text(), re.MULTILINE)
            moving = 5 * seconds - sum(map(float, rest))
            [robot] = json.loads(mercury("run", out / f"{name}.json", "--config", world, "--seconds", moving, "--settle", 0,
                                         "--trials", 5, "--jitter", 1e-3, "--device", "cpu", "--json", "--quiet"))["robots"]  # fmt: skip
            spread = (robot["upper_quartile"] - robot["lower_quartile"]) / length
            middle = sorted(distances)[len(distances) // 2]
            rows.append(Row(f"{name} (quartiles {spread:.3f} m apart here, runs {max(distances) - min(distances):.3f} m there)",
                            middle, robot["distance"] / length, "m", fails=why))  # fmt: skip
    return Result(rows)


@case(
    "newton",
    "A lattice in Newton",
    formula="largest distance of a mass from where Newton has it after 0.25, 0.5, 1 and 2 s, as a share of the lattice's length",
    source="Newton 1.8, its semi-implicit solver at 0.1 ms (github.com/newton-physics/newton); `tests/data/newton/lattice.py` makes the "
    "positions",
    kind="analytic",
    remark="A block of 3 x 2 x 2 voxels, stretched, sheared and spinning in empty space. Both programs sum forces, then velocities, then "
    "positions, so that they agree at the same time step to rounding, and to the first order of its difference otherwise.",
)
def newton(short: bool) -> Result:
    data = json.loads((ROOT / "tests" / "data" / "newton" / "lattice.json").read_text())
    rest, theirs = np.array(data["rest"]), {float(t): np.array(x) for t, x in data["found"].items()}
    robot = mercurysim.Robot(rest, [(a, b, 1) for a, b in data["springs"]], materials=[[0, 0, 0, 0], [data["stiffness"], 0, 0, 0]])
    rows = []
    for dt in (1e-3, 1e-4) if short else (1e-3, 5e-4, 2.5e-4, 1e-4):
        batch = batch_of(robot, mercurysim.Environment("space"), dt)
        batch.set_state(0, np.array(data["positions"], np.float32), np.array(data["velocities"], np.float32))
        now, worst = 0.0, 0.0
        for time, positions in theirs.items():
            batch.step(round((time - now) / dt))
            now = time
            worst = max(worst, float(np.linalg.norm(batch.positions.numpy() - positions, axis=1).max()))
        rows.append(Row(f"largest distance, dt {1e3 * dt:g} ms here", 0, 1e6 * worst, "um", scale=1e6 * float(np.ptp(rest[:, 0]))))
    return Result(rows)
