# SPDX-License-Identifier: Apache-2.0
"""Whole robots against the same equations in double precision, written again with NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np
from bodies import batch_of
from table import Result, Row, case

import mercurysim


def calculated(robot: Any, dt: float, times: list[float], water: bool) -> list[np.ndarray]:
    """Positions at some times: muscles, viscous springs and equation 1, by the symplectic Euler method, in double precision."""
    x = robot.masses.astype(float)
    v = np.zeros_like(x)
    a, b = robot.springs["a"].astype(int), robot.springs["b"].astype(int)
    material = robot.springs["material"]
    rest = robot.springs["rest_length"].astype(float)
    stiffness, amplitude, frequency, phase = robot.materials.astype(float)[material].T
    relaxation = robot.relaxation_time.astype(float)[material]
    mass = robot.mass.astype(float)[:, None]
    faces = robot.faces.astype(int)
    found = []
    for n in range(round(max(times) / dt) + 1):
        if len(found) < len(times) and n == round(times[len(found)] / dt):
            found.append(x.copy())
        force = np.zeros_like(x)
        d = x[b] - x[a]
        length = np.linalg.norm(d, axis=1)
        rate = np.einsum("ij,ij->i", d, v[b] - v[a]) / length
        wanted = rest * (1 + amplitude * np.sin(frequency * n * dt + phase))
        pull = (stiffness * (length - wanted + relaxation * rate) / length)[:, None] * d
        for axis in range(3):
            force[:, axis] = np.bincount(a, pull[:, axis], len(x)) - np.bincount(b, pull[:, axis], len(x))
        if water:
            p, q, r = x[faces[:, 0]], x[faces[:, 1]], x[faces[:, 2]]
            normal = np.cross(q - p, r - p) / 2  # its length is the area
            u = -v[faces].mean(axis=1)
            through = np.einsum("ij,ij->i", normal, u)[:, None]
            speed = np.einsum("ij,ij->i", u, u)[:, None]
            push = 500 * (0.8 * np.abs(through) * u + 0.2 * speed * np.where(through < 0, -normal, normal)) / 3
            for axis in range(3):
                force[:, axis] += np.bincount(faces.ravel(), np.repeat(push[:, axis], 3), len(x))
        v += dt * force / mass
        x += dt * v
    return found


@case(
    "reference",
    "Whole robots against a calculation in double precision",
    formula="the same equations; largest distance of a mass from where the reference has it, in edges of a voxel",
    source="docs/physics.md, written again with NumPy in bench/validation/reference.py",
    kind="analytic",
    remark="A random robot of the paper without water and by equation 1, and one of a real material, whose muscles move for 4 s.",
)
def reference(short: bool) -> Result:
    times = [0.5] if short else [1.0, 2.0, 4.0]
    size = {"voxels": ((4, 3, 3), (4, 3, 3)), "edge": 0.1}
    paper = mercurysim.random_voxel(1, seed=1, **size)[0]
    real = mercurysim.random_voxel(1, seed=1, physics="real", modulus=2e4, **size)[0]
    rows = []
    for name, robot, environment in (("paper, no water", paper, mercurysim.Environment("space")),
                                     ("paper, equation 1", paper, mercurysim.Ocean()),
                                     ("real, no water", real, mercurysim.Environment("space"))):  # fmt: skip
        dt = 1e-3
        expected = calculated(robot, dt, times, water="equation" in name)
        batch = batch_of(robot, environment, dt)
        for at, there in zip(times, expected):
            batch.step(round(at / dt) - batch.steps)
            apart = np.linalg.norm(batch.positions.numpy() - there, axis=1).max() / 0.1
            rows.append(Row(f"{name}, after {at:g} s", 0, float(apart), "edges", scale=1))
    return Result(rows)
