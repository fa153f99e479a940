# SPDX-License-Identifier: Apache-2.0
"""Bodies on the ground."""

from __future__ import annotations

import math

import numpy as np
from bodies import batch_of, block, rounded
from table import Result, Row, case

import mercurysim

GRAVITY = 9.81


@case(
    "slope",
    "An elastic plate on a slope",
    formula="rests while tan(angle) <= mu, else slides with g (sin(angle) - mu cos(angle))",
    source="Coulomb's law of friction",
    kind="analytic",
    remark="A slope is gravity at an angle. The plate is 0.6 x 0.6 x 0.1 m of 50 kPa; mu = 0.8.",
)
def slope(short: bool) -> Result:
    friction = 0.8
    plate = block((6, 6, 1), 0.1, modulus=5e4, density=1070, relaxation_time=0.01)
    rows = []
    for over in (0.95, 1.05, 1.25, 1.5):
        angle = math.atan(over * friction)
        land = mercurysim.Land(
            gravity=(GRAVITY * math.sin(angle), 0, -GRAVITY * math.cos(angle)), friction=friction, stiffness_scale=1
        )
        dt = 1e-3
        batch = batch_of(plate, land, dt)
        batch.step(1000)  # until it has sunk into its shape
        before = float(batch.telemetry()[0]["velocity"][0])
        batch.step(1000)
        found = (float(batch.telemetry()[0]["velocity"][0]) - before) / (1000 * dt)
        expected = max(0.0, GRAVITY * (math.sin(angle) - friction * math.cos(angle)))
        what = f"acceleration at tan(angle) = {over:g} mu"
        rows.append(Row(what, expected, found, "m/s2", scale=GRAVITY if over < 1 else None))
    return Result(rows)


@case(
    "bounce",
    "A drop onto the ground and its bounce, against the same at dt / 16",
    formula="height of the center after the bounce; converges with the step of time",
    source="the same body at dt / 16",
    kind="lattice",
    step="dt [s]",
    remark="A cube of 0.2 m and 20 kPa falls from 0.1 m, without damping. The ground takes the energy of each mass that lands, so "
    "there is no formula for the height.",
)
def bounce(short: bool) -> Result:
    cube = block((3, 3, 3), 0.2 / 3, modulus=2e4, density=1070)
    coarse = rounded(0.4 * cube.info()["largest_dt"])
    land = mercurysim.Land(stiffness_scale=1, self_collision=False)

    def highest(dt: float) -> tuple[float, list[float], list[float]]:
        batch = batch_of(cube, land, dt)
        batch.set_state(0, batch.positions.numpy() + np.float32([0, 0, 0.1]))
        times, heights = [], []
        stride = round(2e-3 / dt) if dt < 2e-3 else 1
        while batch.time < 0.6:
            batch.step(stride)
            times.append(batch.time)
            heights.append(float(batch.centers.numpy()[0, 2]) - 0.1)
        low = int(np.argmin(heights))
        high = low + int(np.argmax(heights[low:]))
        # A parabola through the three highest samples.
        a, b, c = heights[high - 1 : high + 2]
        return b + (c - a) ** 2 / (8 * (2 * b - a - c)), times, heights

    dts = [coarse / 2**i for i in range(5)]
    reference, times, heights = highest(dts[-1])
    rows, curves = [], {"times": times, "reference": heights}
    for dt in dts[:-1]:
        found, times, heights = highest(dt)
        rows.append(Row("height of the bounce", 1000 * reference, 1000 * found, "mm", dt))
        if dt == coarse:
            curves |= {"coarse times": times, "coarse": heights}
    return Result(rows, curves)
