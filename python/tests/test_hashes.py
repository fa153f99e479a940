# SPDX-License-Identifier: Apache-2.0
"""Robots move the same, bit for bit, whether Python or the command line steps them."""

import csv
import io

import pytest

import mercurysim


@pytest.mark.parametrize(
    "environment, options, solver, dt",
    [
        (mercurysim.Ocean(), [], "force", 1e-3),
        (mercurysim.Ocean(density=500, flow=(0.1, 0, 0)), ["--density", 500, "--flow", "0.1,0,0"], "xpbd", 2e-3),
        (mercurysim.Land(), ["--environment", "land"], "xpbd", 1e-3),
        (mercurysim.OceanSimple(), ["--environment", "ocean-simple"], "force", 1e-3),
    ],
)
def test_hashes_are_those_of_the_command_line(mercury, device, environment, options, solver, dt):
    options = [*options, "--solver", solver, "--dt", dt, "--device", device, "--seconds", 300 * dt]
    table = csv.DictReader(io.StringIO(mercury("run", "--quiet", "--random", "voxel:4", "--seed", 1, "--csv", "-", *options)))
    expected = [row["hash"] for row in table]
    robots = mercurysim.random_voxel(4, seed=1)
    batch = mercurysim.Batch(robots, environment=environment, solver=solver, dt=dt, device=device)
    batch.step(300)
    assert [f"{batch.hash(i):016x}" for i in range(4)] == expected
    results = mercurysim.evaluate(
        robots, 300 * dt, environment=environment, solver=solver, dt=dt, device=device, hashes=True
    )
    assert [f"{result.hash:016x}" for result in results] == expected
