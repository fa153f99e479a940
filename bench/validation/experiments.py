# SPDX-License-Identifier: Apache-2.0
"""Against experiments of others."""

from __future__ import annotations

import math
import os
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from bodies import at_end, batch_of, block, changed, rounded
from measured import BEAM_FREQUENCY, BEAM_SAG, BEAM_SOURCE, CATSHARK, CATSHARK_SOURCE
from solids import AREA, DENSITY, INERTIA, euler_bernoulli, timoshenko
from table import Result, Row, case

import mercurysim

GRAVITY = 9.80709  # where the beam was measured [m/s2]


@case(
    "silicone-beam",
    "A clamped beam of silicone under its weight and two loads",
    formula="sag of the end under its weight, 52 g and 101 g;\nfrequency of the swings after the release (within 5 %)",
    source=BEAM_SOURCE,
    kind="real",
    step="voxel [mm]",
    remark="30 x 30 x 100 mm, 1,070 kg/m3 and 263,824 Pa, the modulus that its authors fitted to their finite elements and these "
    "recordings; nothing is fitted here. It is the modulus with which a beam without shear sags as measured. A beam of it with shear "
    "(Timoshenko's) sags 9 % more and swings 6 % slower, and so does the lattice: that is why its frequency is low. With 287 kPa, "
    "Timoshenko's beam would sag as measured and swing at 7.45 Hz, 3.6 % below the silicone. Silicone keeps its volume (Poisson's ratio 0.5), the lattice does not (0.25). The "
    "load is a mass at the upper edge of the end. `bench/validation/measured.py` computes the measured numbers from the data.",
)  # fmt: skip
def silicone_beam(short: bool) -> Result:
    length, height, modulus = 0.1, 0.03, 263824
    omega = 2 * math.pi * BEAM_FREQUENCY
    rows, curves = [], {}
    for across in (3, 6) if short else (3, 6, 12):
        free = block((round(across * length / height), across, across), height / across,
                     modulus=modulus, density=DENSITY)  # fmt: skip
        step = 1000 * height / across
        dt = rounded(0.8 * free.info()["largest_dt"])
        end = at_end(free, 0, 1)
        edge = end & at_end(free, 2, 1)
        fixed = at_end(free, 0, -1)
        middle = end & (np.abs(free.masses[:, 2] - 0.009) < 0.6 * height / across)  # the marker's height
        for load, sag in BEAM_SAG.items():
            mass = free.mass + np.where(edge, load / GRAVITY / edge.sum(), 0)
            robot = changed(free, fixed=fixed, mass=mass)
            batch = batch_of(robot, mercurysim.Environment("space", gravity=GRAVITY), dt, omega)
            batch.step(round(15 / omega / dt))
            z = batch.positions.numpy()[:, 2] - robot.masses[:, 2]
            what = f"sag under its weight and {load:.2f} N" if load else "sag under its weight"
            coarse = "a lattice of 3 voxels across bends too stiffly" if load and across == 3 else ""
            rows.append(Row(what, sag, -1000 * float(z[middle].mean()), "mm", step, fails=coarse))
            if load:
                continue
            batch.reset()
            batch.configure(damping=0)
            strides, samples = round(2 * math.pi / omega / 30 / dt), []
            for _ in range(90):
                batch.step(strides)
                samples.append(float((batch.positions.numpy()[:, 2] - robot.masses[:, 2])[middle].mean()))
            swing = np.array(samples) - z[middle].mean()
            i = np.flatnonzero(swing[1:] * swing[:-1] < 0)
            crossings = i + swing[i] / (swing[i] - swing[i + 1])
            found = (len(crossings) - 1) / 2 / (crossings[-1] - crossings[0]) / (strides * dt)
            soft = "" if across == 3 else "the modulus is that of a beam without shear; with shear it swings at 7.14 Hz"
            rows.append(Row("frequency of the swings", BEAM_FREQUENCY, found, "Hz", step, tolerance=0.05, fails=soft))
        curves[f"{across} across"] = [row.found for row in rows if row.step == step and row.unit == "mm"]
    # Beams of the same modulus.
    unit_sag, swing_rate = timoshenko(True, length, modulus)
    thin_sag = DENSITY * AREA * length**4 / (8 * modulus * INERTIA)
    last = {row.what: row.found for row in rows}
    for name, per_gravity, rate in (("Timoshenko", unit_sag, swing_rate),
                                    ("Euler and Bernoulli", thin_sag, euler_bernoulli(1.8751041, length, modulus))):  # fmt: skip
        sag_there, frequency = 1000 * GRAVITY * per_gravity, rate / 2 / math.pi
        rows.append(Row(f"{name}: sag under its weight", sag_there, last["sag under its weight"], "mm", counts=False))
        rows.append(Row(f"{name}: frequency", frequency, last["frequency of the swings"], "Hz", counts=False))
    return Result(rows, curves)


def beat(name: str) -> tuple[float, float]:
    """Of a sample robot with a real body: body lengths per second and f A / U, after 10 s, from a recording."""
    program = os.environ.get("MERCURY_PROGRAM", str(Path(__file__).resolve().parents[2] / "build" / "bin" / "mercury"))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "swim.h5"
        subprocess.run([program, "run", f"sample:{name}", "--physics", "real", "--seconds", "20", "--every", "20",
                        "--device", "cpu", "--record", file], check=True, capture_output=True)  # fmt: skip
        recording = mercurysim.Recording(file)
        rest = recording.robots[0]
        later = [i for i, t in enumerate(recording.times) if t >= 10]
        x = np.array([recording.positions(i) for i in later], float)
        seconds = recording.times[later[-1]] - recording.times[later[0]]
    length = float(np.ptp(rest.masses[:, 0]))
    ends = [x[:, at_end(rest, 0, end)].mean(axis=1) for end in (-1, 1)]
    way = x[-1].mean(axis=0) - x[0].mean(axis=0)
    speed = np.linalg.norm(way) / seconds
    ahead = way / np.linalg.norm(way)
    tail = ends[0] if (ends[0] - ends[1]).mean(axis=0) @ ahead < 0 else ends[1]
    across = tail - np.outer(tail @ ahead, ahead)
    across -= across.mean(axis=0)
    side = np.linalg.svd(across, full_matrices=False)[2][0]
    moved = [float(rest.materials[m, 2]) for m in np.unique(rest.springs["material"]) if rest.materials[m, 1]]
    period = 2 * math.pi / moved[0]
    per = round(period / seconds * (len(later) - 1))
    widths = [np.ptp(across[i : i + per] @ side) for i in range(0, len(later) - per, per)]
    return speed / length, float(np.mean(widths)) / period / speed


@case(
    "animals",
    "Swimming: Strouhal numbers of animals and of the sample robots",
    formula="St = f A / U, A the way of the tail's tip from side to side;\ncatsharks 0.29 to 0.26 at 1.25 to 1.75 body lengths/s",
    source=CATSHARK_SOURCE,
    kind="real",
    remark="Expected is the animals' mean at 1.25 to 1.75 body lengths per second; slower animals beat more, 0.66 at 0.5 body "
    "lengths per second. The sample eel and fish were searched for with this number as their goal (docs/library.md), so the rows "
    "show that bodies by Mercury's equations can swim so, not that they must. The eel of the paper's physics has 2.2.",
)
def animals(short: bool) -> Result:
    expected = float(np.mean([CATSHARK[speed] for speed in (1.25, 1.5, 1.75)]))
    rows, curves = [], {"catshark": [list(CATSHARK), list(CATSHARK.values())]}
    for name in () if short else ("eel", "fish"):
        speed, strouhal = beat(name)
        curves[name] = [speed, strouhal]
        why = "beats its tail too often for its speed" if abs(strouhal / expected - 1) > 0.1 else ""
        rows.append(Row(f"Strouhal number of the sample {name}, {speed:.2f} body lengths/s", expected, strouhal, fails=why))
    return Result(rows, curves)
