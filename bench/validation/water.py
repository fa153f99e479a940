# SPDX-License-Identifier: Apache-2.0
"""Bodies in water: equation 1 (`ocean`) and resistive drag (`water`)."""

from __future__ import annotations

import math

import numpy as np
from bodies import batch_of, block, changed, rounded
from solids import DENSITY, HEIGHT, MODULUS, SLENDERNESS, mode_shape, sampled_mode, timoshenko
from table import Result, Row, case

import mercurysim

WATER = 1000.0  # density [kg/m3]
C_N, C_T = 1.0, 0.02  # of resistive water


def sphere(radius: float, level: int, mass: float, stiffness: float):
    """A hollow icosahedral sphere: edges of the triangles and spokes to the center are springs. And its volume [m3]."""
    golden = (1 + math.sqrt(5)) / 2
    points = [[s, t * golden, 0] for s in (-1, 1) for t in (-1, 1)]
    points = np.array(points + [[0, s, t] for s, t, _ in points] + [[t, 0, s] for s, t, _ in points], float)
    points /= np.linalg.norm(points[0])
    reach = np.linalg.norm(points[:, None] - points[None], axis=2)
    edge = reach[reach > 1e-9].min() * 1.01
    triangles = [(i, j, k) for i in range(12) for j in range(i + 1, 12) for k in range(j + 1, 12)
                 if max(reach[i, j], reach[j, k], reach[i, k]) < edge]  # fmt: skip
    points = list(points)
    for _ in range(level):
        middles: dict[tuple[int, int], int] = {}

        def middle(i: int, j: int) -> int:
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(points)
                between = points[i] + points[j]
                points.append(between / np.linalg.norm(between))
            return middles[key]

        finer = []
        for i, j, k in triangles:
            a, b, c = middle(i, j), middle(j, k), middle(k, i)
            finer += [(i, a, c), (a, j, b), (c, b, k), (a, b, c)]
        triangles = finer
    p = np.array(points) * radius
    faces = np.array(triangles)
    inward = np.einsum("ij,ij->i", np.cross(p[faces[:, 1]] - p[faces[:, 0]], p[faces[:, 2]] - p[faces[:, 0]]), p[faces[:, 0]]) < 0
    faces[inward] = faces[inward][:, ::-1]
    edges = np.unique(np.sort(np.concatenate([faces[:, :2], faces[:, 1:], faces[:, ::2]]), axis=1), axis=0)
    spokes = np.stack([np.arange(len(p)), np.full(len(p), len(p))], axis=1)
    springs = np.concatenate([edges, spokes])
    springs = np.column_stack([springs, np.where(np.arange(len(springs)) < len(edges), 1, 2)])
    volume = np.einsum("ij,ij->i", np.cross(p[faces[:, 0]], p[faces[:, 1]]), p[faces[:, 2]]).sum() / 6
    body = mercurysim.Robot(np.vstack([p, [0, 0, 0]]), springs,
                            faces, [[0] * 6] + [[k, 0, 0, 0, 0, 0.005] for k in (stiffness, stiffness / 10)],
                            mass=[0.9 * mass / len(p)] * len(p) + [0.1 * mass])  # fmt: skip
    return body, float(volume)


def sinks(robot, drag: float, weight: float, inertia: float, speed: float, environment) -> float:
    """The speed at which a body falls [m/s], begun at 0.9 of `speed`, whose gravity is that at which drag speed^2 carries it.

    The speed approaches the terminal one as tanh(drag speed t / inertia), so three such times leave 0.03 %.
    """
    dt = min(5e-3, rounded(0.7 * robot.info()["largest_dt"]))
    fall = environment.replace(gravity=drag * speed**2 / weight)
    batch = batch_of(robot, fall, dt)
    batch.set_state(0, robot.masses, np.tile([0, 0, -0.9 * speed], (len(robot.masses), 1)))
    batch.step(round(3 * inertia / (drag * speed) / dt))
    return -float(batch.telemetry()[0]["velocity"][2])


SPEEDS = (0.002, 0.02, 0.2, 2.0)  # [m/s]


@case(
    "terminal-speed",
    "Terminal speed of a sphere, a cube and a plate in resistive water, over three decades",
    formula="(m - rho V) g = rho / 2 v^2 K;  cube a^2 (2 C_N + 4 C_T),  plate a^2 (2 C_N + 4 (h / a) C_T),\n"
    "sphere pi R^2 (C_N + 3 pi / 4 C_T)",
    source="resistive drag, integrated over the surface; for the sphere, integrals of |cos|^3 and sin^3",
    kind="analytic",
    step="edge [mm]",
    remark="By resistive drag a sphere has a drag coefficient of 1.05. That of a real one is 0.4 to 0.5 at Reynolds numbers of 1e3 to "
    "2e5 (H. Schlichting, Boundary-Layer Theory): resistive drag knows no wake.",
)
def terminal_speed(short: bool) -> Result:
    rows, curves = [], {"speeds": list(SPEEDS)}
    water = mercurysim.Environment("resistive")
    share = water.added_mass_coefficient
    density = 1200.0
    for name, size in (("cube", (2, 2, 2)), ("plate", (6, 6, 1))):
        edge = 0.05
        a, h = size[0] * edge, size[2] * edge
        volume, area = a * a * h, 2 * a * a * C_N + 4 * a * h * C_T
        curves[name] = []
        for speed in SPEEDS:
            # Stiff enough for the pressure of the water.
            robot = block(size, edge, modulus=max(2e4, 5e6 * speed**2), density=density, relaxation_time=0.003)
            curves[name].append(sinks(robot, WATER / 2 * area, (density - WATER) * volume,
                                      (density + share * WATER) * volume, speed, water))  # fmt: skip
            rows.append(Row(f"{name} at {speed:g} m/s", speed, curves[name][-1], "m/s"))
    radius = 0.1
    area = math.pi * radius**2 * (C_N + 3 * math.pi / 4 * C_T)
    mass = density * 4 / 3 * math.pi * radius**3

    def falling_sphere(level: int, speed: float) -> float:
        robot, volume = sphere(radius, level, mass, 200 * max(1, (speed / 0.2) ** 2))
        # Its weight is counted with the volume of its triangles, so that their error is in the drag alone.
        return sinks(robot, WATER / 2 * area, mass - WATER * volume, mass + share * WATER * volume, speed, water)

    curves["sphere"] = [falling_sphere(3, speed) for speed in SPEEDS[short:]]  # the slowest takes longest
    for speed, found in zip(SPEEDS[short:], curves["sphere"]):
        rows.append(Row(f"sphere at {speed:g} m/s, 1280 triangles", speed, found, "m/s"))
    for level in (1, 2) if short else (1, 2, 3, 4):
        edge = 1000 * radius * 1.1 / 2**level  # of the triangles, about
        coarse = "triangles of a coarse sphere cut its corners" if level < 2 else ""
        rows.append(Row("sphere at 0.2 m/s, finer and finer", 0.2, falling_sphere(level, 0.2), "m/s", edge, fails=coarse))
    return Result(rows, curves)


@case(
    "equation-1",
    "Terminal speed of a cube by the paper's equation 1",
    formula="M g = rho a^2 C_D v^2",
    source="paper, equation 1, with the flow relative to the face",
    kind="analytic",
    remark="Bodies of the paper: 1 kg per point, springs of 50 N/m.",
)
def equation_1(short: bool) -> Result:
    rows, curves = [], {"speeds": list(SPEEDS[:3])}
    robot = mercurysim.voxel(np.full((2, 2, 2), 21, np.uint8), edge=0.2)
    mass, area = float(robot.mass.sum()), 0.4 * 0.4
    for speed in SPEEDS[:3]:
        found = sinks(robot, WATER * area, mass, mass, speed, mercurysim.Ocean())
        slow = "forces below one unit of the integer sums are rounded" if speed < 0.01 else ""
        rows.append(Row(f"{speed:g} m/s", speed, found, "m/s", fails=slow))
    return Result(rows, curves)


@case(
    "added-mass",
    "A bar that vibrates in water",
    formula="f(water) / f(empty space) = sqrt(rho_b / (rho_b + C_A rho))",
    source="added mass of potential flow: H. Lamb, Hydrodynamics, 6th ed., articles 68 and 92; C_A = 0.5 is the sphere's",
    kind="analytic",
    remark="Without drag. The added mass follows the skin, so the ends carry more than their share, so the bar is long: 40 x 1 x 1.",
)
def added_mass(short: bool) -> Result:
    across, slenderness = 2, 40
    omega = timoshenko(clamped=False)[1] / (slenderness / SLENDERNESS) ** 2
    robot = block((across * slenderness, across, across), HEIGHT / across, modulus=MODULUS, density=DENSITY)
    shape = mode_shape(4.7300407, False, robot.masses[:, 0] / (slenderness * HEIGHT) + 0.5)
    velocity = np.zeros_like(robot.masses)
    velocity[:, 2] = shape * 5e-3 * slenderness * HEIGHT * omega
    dt = rounded(0.8 * robot.info()["largest_dt"])
    found, rows = {}, []
    for share in (0.0, 0.5, 1.0):
        water = mercurysim.Environment(
            "resistive", normal_coefficient=0, tangential_coefficient=0, added_mass_coefficient=share
        )
        batch = batch_of(changed(robot, velocity=velocity), water, dt)
        found[share] = sampled_mode(batch, robot, shape, omega, 3)
        if share:
            expected = math.sqrt(DENSITY / (DENSITY + share * WATER))
            rows.append(Row(f"ratio of frequencies, C_A = {share:g}", expected, found[share] / found[0]))
    return Result(rows)


def mean_thrust(slip: float, steepness: float, environment, count: int) -> float:
    """The mean force along x [N] on a sheet y = b sin(k (x - c t)) that moves at U = slip c against its wave.

    The sheet's points move across alone; one wave in `count` pieces has every phase, so one moment is the mean over time. Its
    masses are held by no spring: what a step adds to their momentum is the water's force.
    """
    wave = 2 * math.pi  # length [m]: k = 1, and a = b; c = 1 m/s
    x = np.linspace(0, wave, count + 1)
    y, rate = steepness * np.sin(x), -steepness * np.cos(x)
    zero = np.zeros_like(x)
    masses = np.concatenate([np.stack([x, y, zero], 1), np.stack([x, y, zero + 1], 1)])
    speed = np.stack([zero - slip, rate, zero], 1)
    i = np.arange(count)
    faces = np.concatenate([np.stack([i, i + 1, i + count + 1], 1), np.stack([i + 1, i + count + 2, i + count + 1], 1)])
    sheet = mercurysim.Robot(masses, np.zeros((0, 3), int), faces, velocity=np.concatenate([speed, speed]))
    dt = 0.01
    batch = batch_of(sheet, environment, dt)
    batch.step(1)
    return float((batch.velocities.numpy().astype(float)[:, 0] - sheet.velocity[:, 0]).sum() / dt)


def slip_of(steepness: float, environment, count: int) -> float:
    """U/c at which the mean force along x is zero: the swimming speed of the sheet, by bisection."""
    low, high = 0.0, 1.0
    # A force toward -x drives the sheet on.
    if mean_thrust(1e-4, steepness, environment, count) > 0:
        return 0.0
    low = 1e-4
    # From slow to fast up to the first balance.
    for high in np.linspace(0.02, 1, 50):
        if mean_thrust(high, steepness, environment, count) > 0:
            break
        low = high
    for _ in range(24):
        middle = (low + high) / 2
        low, high = (low, middle) if mean_thrust(middle, steepness, environment, count) > 0 else (middle, high)
    return (low + high) / 2


def slip_by_equation_1(ratio: float, a: float) -> float:
    under = (1 - ratio) ** 2 - 8 / 3 * ratio * a * a
    return ((1 - ratio) - math.sqrt(under)) / 2 if under >= 0 else math.nan


def slip_by_resistance(c_n: float, c_t: float, a: float) -> float:
    """The root of the mean force of resistive drag, its integral over a wave computed here in double precision."""
    phase = (np.arange(4096) + 0.5) * 2 * math.pi / 4096
    s = a * np.cos(phase)
    root = np.sqrt(1 + s * s)

    def force(slip: float) -> float:
        normal, along = s * (1 - slip) / root, (slip + s * s) / root  # speeds of the water across and along, c = 1
        return float(np.mean(-c_n * np.abs(normal) * normal * s + c_t * np.abs(along) * along))

    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (low, middle) if force(middle) > 0 else (middle, high)
    return (low + high) / 2


@case(
    "waving-sheet",
    "A waving sheet with prescribed motion, equation 1",
    formula="U/c = ((1 - r) - sqrt((1 - r)^2 - (8/3) r a^2)) / 2,  r = C_L / C_D,  a = k b",
    source="zero of equation 1's mean force along the way; means of |cos| and |cos|^3 over a wave",
    kind="analytic",
    step="piece [waves]",
    remark="y = b sin(k (x - c t)) moves at U against its wave. Without lift (r = 0) it has no thrust. At r = 0.2, Mercury's "
    "default, it slips by more than 90 % of its wave's speed: equation 1 cannot swim well.",
)
def waving_sheet(short: bool) -> Result:
    rows, curves = [], {"steepness": [0.1 * i for i in range(1, 11)]}
    for ratio in (0.1, 0.2, 0.3):
        ocean = mercurysim.Ocean(drag_coefficient=1, lift_coefficient=ratio)
        curves[f"r {ratio}"] = []
        for a in [0.6] if short else curves["steepness"]:
            expected = slip_by_equation_1(ratio, a)
            found = slip_of(a, ocean, 400) if math.isfinite(expected) else math.nan
            curves[f"r {ratio}"].append(found if math.isfinite(found) else None)
            if abs(a - 0.6) < 1e-9:
                rows.append(Row(f"U/c at a = 0.6, r = {ratio:g}", expected, found))
    for count in (40, 80) if short else (25, 50, 100, 200):
        found = slip_of(0.6, mercurysim.Ocean(drag_coefficient=1, lift_coefficient=0.3), count)
        rows.append(Row("U/c at a = 0.6, r = 0.3, finer and finer", slip_by_equation_1(0.3, 0.6), found, step=1 / count,
                        fails="25 pieces per wave are too few" if count == 25 else ""))  # fmt: skip
    still = slip_of(0.6, mercurysim.Ocean(drag_coefficient=1, lift_coefficient=0), 400)
    rows.append(Row("U/c at a = 0.6, r = 0: no thrust", 0, still, scale=1))
    return Result(rows, curves)


@case(
    "resistive-sheet",
    "The same sheet in resistive water",
    formula="mean over a wave of C_N |u_n| u_n n_x + C_T |u_t| u_t t_x = 0",
    source="the integral of resistive drag, computed in double precision by the midpoint rule; J. Gray and G. J. Hancock, J. Exp. Biol. 32 (1955)",
    kind="analytic",
    step="piece [waves]",
    remark="For comparison, what Mercury does not model. A sheet in a viscous fluid without inertia (G. I. Taylor, Proc. R. Soc. A "
    "209, 1951) swims at U/c = a^2 / 2 (1 - 19/16 a^2) for small a. A slender body by reactive forces alone (M. J. Lighthill, "
    "J. Fluid Mech. 9, 1960) has thrust until U = c, and what it reaches depends on its drag.",
)  # fmt: skip
def resistive_sheet(short: bool) -> Result:
    rows, curves = [], {"steepness": [0.1 * i for i in range(1, 11)]}
    for c_t in (0.02, 0.1):
        water = mercurysim.Environment("resistive", tangential_coefficient=c_t, added_mass_coefficient=0)
        curves[f"C_T {c_t}"] = []
        for a in [0.6] if short else curves["steepness"]:
            expected, found = slip_by_resistance(C_N, c_t, a), slip_of(a, water, 400)
            curves[f"C_T {c_t}"].append(found)
            if min(abs(a - 0.3), abs(a - 0.6), abs(a - 1)) < 1e-9:
                rows.append(Row(f"U/c at a = {a:.1f}, C_T = {c_t:g}", expected, found))
    water = mercurysim.Environment("resistive", added_mass_coefficient=0)
    for count in (40, 80) if short else (25, 50, 100, 200):
        found = slip_of(0.6, water, count)
        rows.append(Row("U/c at a = 0.6, C_T = 0.02, finer and finer", slip_by_resistance(C_N, C_T, 0.6), found, step=1 / count))
    return Result(rows, curves)
