# SPDX-License-Identifier: Apache-2.0
"""Springs, bars and columns in empty space."""

from __future__ import annotations

import math

import numpy as np
from bodies import at_end, batch_of, block, changed, rounded
from numpy.polynomial import legendre
from table import Result, Row, case, decaying_sine

import mercurysim

MODULUS, DENSITY, POISSON = 264e3, 1070.0, 0.25  # a soft silicone [Pa], [kg/m3]; the lattice's ratio
HEIGHT, SLENDERNESS = 0.03, 10  # of the bars [m]; length over height
LENGTH = SLENDERNESS * HEIGHT
INERTIA, AREA = HEIGHT**4 / 12, HEIGHT**2


@case(
    "oscillator",
    "Two masses on a viscous spring",
    formula="omega = sqrt(omega0^2 - gamma^2),  omega0^2 = 2 k / m,  gamma = omega0^2 tau / 2",
    source="damped harmonic oscillator, any textbook of mechanics",
    kind="analytic",
    step="dt [s]",
)
def oscillator(short: bool) -> Result:
    stiffness, tau = 50.0, 0.004
    omega0 = math.sqrt(2 * stiffness)
    gamma = omega0**2 * tau / 2
    rows = []
    for dt in (1e-3,) if short else (4e-3, 2e-3, 1e-3):
        pair = mercurysim.Robot(
            [[0, 0, 0], [1, 0, 0]], [[0, 1, 1]], None, [[0] * 6, [stiffness, 0, 0, 0, 0, tau]],
            velocity=[[-0.1, 0, 0], [0.1, 0, 0]],
        )  # fmt: skip
        batch = batch_of(pair, mercurysim.Environment("space"), dt)
        strides, stretch = round(0.1 / dt), []
        for _ in range(40):
            x = batch.positions.numpy()[:, 0]
            stretch.append(x[1] - x[0] - 1)
            batch.step(strides)
        omega, decay = decaying_sine(stretch, strides * dt)
        rows += [
            Row("frequency", math.sqrt(omega0**2 - gamma**2), omega, "rad/s", dt),
            Row("decay", gamma, decay, "1/s", dt),
        ]
    return Result(rows)


def timoshenko(clamped: bool, length: float = LENGTH, modulus: float = MODULUS) -> tuple[float, float]:
    """The sag of the tip under 1 m/s2 [m] and the first frequency [rad/s] of a bar of that length, by Ritz's method.

    Energies 1/2 integral of E I theta'^2 + kappa G A (w' - theta)^2 and of rho A w'^2 + rho I theta'^2 in time, with
    Legendre polynomials for the deflection w and the rotation theta; kappa by Cowper (1966). A clamped end multiplies them by x.
    """
    kappa = 10 * (1 + POISSON) / (12 + 11 * POISSON)
    shear = kappa * modulus / (2 * (1 + POISSON)) * AREA
    count = 12
    nodes, weights = legendre.leggauss(40)
    weights = weights * length / 2
    basis = np.array([legendre.legval(nodes, np.eye(count)[i]) for i in range(count)])
    slope = np.array([legendre.legval(nodes, legendre.legder(np.eye(count)[i])) for i in range(count)]) * 2 / length
    if clamped:
        x = (nodes + 1) * length / 2
        basis, slope = basis * x, slope * x + basis
    zero = np.zeros_like(basis)
    bend, strain = np.vstack([zero, slope]), np.vstack([slope, -basis])
    w, theta = np.vstack([basis, zero]), np.vstack([zero, basis])
    stiffness = modulus * INERTIA * (bend * weights) @ bend.T + shear * (strain * weights) @ strain.T
    mass = DENSITY * AREA * (w * weights) @ w.T + DENSITY * INERTIA * (theta * weights) @ theta.T
    inverse = np.linalg.inv(np.linalg.cholesky(mass))
    squares = np.linalg.eigvalsh(inverse @ stiffness @ inverse.T)
    if not clamped:
        return 0.0, math.sqrt(squares[2])  # after two rigid motions
    tip = np.array([legendre.legval(1.0, np.eye(count)[i]) for i in range(count)]) * length
    load = (w * weights).sum(axis=1) * DENSITY * AREA
    return float(tip @ np.linalg.solve(stiffness, load)[:count]), math.sqrt(squares[0])


def euler_bernoulli(root: float, length: float = LENGTH, modulus: float = MODULUS) -> float:
    """The frequency of a bar without shear [rad/s]; root = beta L of the mode."""
    return root**2 / length**2 * math.sqrt(modulus * INERTIA / (DENSITY * AREA))


def bar(across: int):
    return block((across * SLENDERNESS, across, across), HEIGHT / across, modulus=MODULUS, density=DENSITY)


def mode_shape(root: float, clamped: bool, x: np.ndarray) -> np.ndarray:
    """The first mode of Euler and Bernoulli, x from 0 to 1."""
    sign = -1 if clamped else 1
    ratio = (math.cosh(root) - sign * math.cos(root)) / (math.sinh(root) - sign * math.sin(root))
    b = root * x
    return np.cosh(b) + sign * np.cos(b) - ratio * (np.sinh(b) + sign * np.sin(b))


def sampled_mode(batch, robot, shape: np.ndarray, omega: float, periods: float) -> float:
    """The frequency [rad/s] of the motion along z, weighted by a shape and the masses, which leave out other modes."""
    weights = shape * robot.mass / np.sum(shape**2 * robot.mass)
    strides = max(1, round(2 * math.pi / omega / 24 / batch.dt))
    samples = []
    for _ in range(round(24 * periods)):
        batch.step(strides)
        samples.append(float(weights @ (batch.positions.numpy()[:, 2] - robot.masses[:, 2])))
    return decaying_sine(samples, strides * batch.dt)[0]


ACROSS = (2, 4, 8, 16)


def too_stiff(across: int) -> str:
    """Edges of voxels carry the bending at distances z from the middle; the trapezoidal rule over z^2 gives 1 + 2 / n^2."""
    return f"a lattice of {across} voxels across bends too stiffly" if across < 8 else ""


@case(
    "cantilever",
    "Cantilever: sag under its weight and first vibration",
    formula="Timoshenko's beam; without shear sag = rho g A L^4 / (8 E I), omega = 1.8751^2 / L^2 sqrt(E I / (rho A))",
    source="S. Timoshenko, Philosophical Magazine 41 (1921); kappa: G. R. Cowper, J. Appl. Mech. 33 (1966)",
    kind="lattice",
    step="voxel [mm]",
    remark="A bar of 10 x 1 x 1, whose shear adds 1 % to the sag, with 2, 4, 8 and 16 voxels across. It settles with critical "
    "damping, then gravity ends and it vibrates without any damping.",
)
def cantilever(short: bool) -> Result:
    unit_sag, omega = timoshenko(clamped=True)
    gravity = 0.02 * LENGTH / unit_sag
    thin = DENSITY * AREA * LENGTH**4 / (8 * MODULUS * INERTIA)
    rows, curves = [], {}
    for across in ACROSS[:3] if short else ACROSS:
        free = bar(across)
        robot = changed(free, fixed=at_end(free, 0, -1))
        dt = rounded(0.8 * free.info()["largest_dt"])
        batch = batch_of(robot, mercurysim.Environment("space", gravity=gravity), dt, 2 * omega)
        batch.step(round(11 / omega / dt))
        z = batch.positions.numpy()[:, 2] - robot.masses[:, 2]
        sag = float(-z[at_end(robot, 0, 1)].mean())
        batch.configure(environment=mercurysim.Environment("space"), damping=0)
        along = robot.masses[:, 0] / LENGTH + 0.5
        found = sampled_mode(batch, robot, mode_shape(1.8751041, True, along), omega, 1)
        step = 1000 * HEIGHT / across
        rows.append(Row("sag over length", unit_sag * gravity / LENGTH, sag / LENGTH, "", step, fails=too_stiff(across)))
        rows.append(Row("frequency", omega / 2 / math.pi, found / 2 / math.pi, "Hz", step, fails=too_stiff(across)))
        curves["profile"] = [sorted(set(np.round(along, 6).tolist()))]
        curves["profile"].append([float(z[np.abs(along - x) < 1e-4].mean() / LENGTH) for x in curves["profile"][0]])
    rows.append(Row("Euler and Bernoulli: sag over length", thin * gravity / LENGTH, sag / LENGTH, counts=False))
    thin_omega = euler_bernoulli(1.8751041)
    rows.append(Row("Euler and Bernoulli: frequency", thin_omega / 2 / math.pi, found / 2 / math.pi, "Hz", counts=False))
    return Result(rows, curves)


@case(
    "free-free",
    "Bar with free ends: first vibration",
    formula="Timoshenko's beam; without shear omega = 4.7300^2 / L^2 sqrt(E I / (rho A))",
    source="as for the cantilever",
    kind="lattice",
    step="voxel [mm]",
)
def free_free(short: bool) -> Result:
    omega = timoshenko(clamped=False)[1]
    rows = []
    for across in ACROSS[:3] if short else ACROSS:
        robot = bar(across)
        along = robot.masses[:, 0] / LENGTH + 0.5
        shape = mode_shape(4.7300407, False, along)
        velocity = np.zeros_like(robot.masses)
        velocity[:, 2] = shape * 2e-3 * LENGTH * omega
        dt = rounded(0.8 * robot.info()["largest_dt"])
        batch = batch_of(changed(robot, velocity=velocity), mercurysim.Environment("space"), dt)
        found = sampled_mode(batch, robot, shape, omega, 3)
        step = 1000 * HEIGHT / across
        rows.append(Row("frequency", omega / 2 / math.pi, found / 2 / math.pi, "Hz", step, fails=too_stiff(across)))
    thin = euler_bernoulli(4.7300407)
    rows.append(Row("Euler and Bernoulli: frequency", thin / 2 / math.pi, found / 2 / math.pi, "Hz", counts=False))
    return Result(rows)


@case(
    "rod",
    "Rod with free ends: first longitudinal vibration",
    formula="omega = pi / L sqrt(E / rho)",
    source="wave equation of a thin rod, any textbook of elasticity",
    kind="lattice",
    step="voxel [mm]",
)
def rod(short: bool) -> Result:
    omega = math.pi / LENGTH * math.sqrt(MODULUS / DENSITY)
    rows = []
    for across in (1, 2) if short else (1, 2, 4, 8):
        robot = bar(across)
        shape = np.sin(math.pi * robot.masses[:, 0] / LENGTH)
        velocity = np.zeros_like(robot.masses)
        velocity[:, 0] = shape * 2e-3 * LENGTH * omega
        dt = rounded(0.4 * robot.info()["largest_dt"])
        batch = batch_of(changed(robot, velocity=velocity), mercurysim.Environment("space"), dt)
        weights = shape * robot.mass / np.sum(shape**2 * robot.mass)
        strides, samples = max(1, round(2 * math.pi / omega / 24 / dt)), []
        for _ in range(72):
            batch.step(strides)
            samples.append(float(weights @ (batch.positions.numpy()[:, 0] - robot.masses[:, 0])))
        found = decaying_sine(samples, strides * dt)[0]
        rows.append(Row("frequency", omega / 2 / math.pi, found / 2 / math.pi, "Hz", 1000 * HEIGHT / across))
    return Result(rows)


@case(
    "column",
    "Column under its own weight",
    formula="the top sinks by rho g L^2 / (2 E)",
    source="Hooke's law, integrated over the length",
    kind="lattice",
    step="voxel [mm]",
)
def column(short: bool) -> Result:
    sinks = 2e-3 * LENGTH
    gravity = sinks * 2 * MODULUS / DENSITY / LENGTH**2
    omega = math.pi / (2 * LENGTH) * math.sqrt(MODULUS / DENSITY)
    rows = []
    for across in (1, 2) if short else (1, 2, 4, 8):
        free = block((across, across, across * SLENDERNESS), HEIGHT / across, modulus=MODULUS, density=DENSITY)
        robot = changed(free, fixed=at_end(free, 2, -1))
        dt = rounded(0.6 * free.info()["largest_dt"])
        batch = batch_of(robot, mercurysim.Environment("space", gravity=gravity), dt, 2 * omega)
        batch.step(round(12 / omega / dt))
        z = batch.positions.numpy()[:, 2] - robot.masses[:, 2]
        sag = float(-z[at_end(robot, 2, 1)].mean())
        rows.append(Row("sinking of the top", 1000 * sinks, 1000 * sag, "mm", 1000 * HEIGHT / across))
    return Result(rows)


@case(
    "conservation",
    "Energy and momenta of a spinning, stretched body over a million steps",
    formula="energy, momentum and angular momentum stay what they are",
    source="Noether's theorem; the symplectic Euler method keeps them but for rounding (E. Hairer, C. Lubich and G. Wanner, "
    "Geometric Numerical Integration, 2006)",
    kind="analytic",
)
def conservation(short: bool) -> Result:
    robot = block((3, 2, 2), 0.1, modulus=1e4, density=DENSITY)
    x = robot.masses.astype(float)
    start = x * (1.05, 0.97, 1.0)
    velocity = np.cross((0.4, 0.7, 2.0), start) + (0.02, -0.01, 0.03)
    dt, samples = 1e-3, 250
    steps = (100_000 if short else 1_000_000) // samples
    batch = batch_of(robot, mercurysim.Environment("space"), dt)
    batch.set_state(0, start.astype(np.float32), velocity.astype(np.float32))
    mass = robot.mass.astype(float)[:, None]
    energy, momentum, spin = [], [], []
    for _ in range(samples):
        batch.step(steps - 1)
        x, v, before = batch.positions.numpy(), batch.velocities.numpy().astype(float), batch.telemetry()[0]
        batch.step(1)
        # Velocities are those of half a step earlier: the mean of two steps is at the time of the positions.
        after = batch.telemetry()[0]
        energy.append(float(before["elastic_energy"] + (before["kinetic_energy"] + after["kinetic_energy"]) / 2))
        momentum.append((mass * v).sum(axis=0))
        spin.append((mass * np.cross(x - 0.5 * dt * v, v)).sum(axis=0))
    early, late = np.mean(energy[: samples // 10]), np.mean(energy[-samples // 10 :])
    p0, l0 = (mass * velocity).sum(axis=0), (mass * np.cross(start, velocity)).sum(axis=0)
    drift = np.linalg.norm(np.array(momentum) - p0, axis=1) / np.linalg.norm(p0)
    turn = np.linalg.norm(np.array(spin) - l0, axis=1) / np.linalg.norm(l0)
    rows = [
        Row("energy, mean of the last tenth over that of the first", 1, late / early),
        Row("momentum, largest change over its size", 0, float(drift.max()), scale=1),
        Row("angular momentum, largest change over its size", 0, float(turn.max()), scale=1),
    ]
    times = (np.arange(1, samples + 1) * steps / 1e6).tolist()
    return Result(rows, {"steps": times, "energy": (np.array(energy) / early - 1).tolist(),
                         "momentum": drift.tolist(), "spin": turn.tolist()})  # fmt: skip
