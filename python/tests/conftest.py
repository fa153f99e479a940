# SPDX-License-Identifier: Apache-2.0
import os
import signal
import subprocess

import pytest

import mercurysim

# Tests interrupt themselves and programs that they start, also where this process was started with Ctrl-C ignored, as in
# the background of a script.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture
def mercury():
    """Runs the program mercury and returns what it prints."""
    program = os.environ.get("MERCURY_PROGRAM")
    if not program:
        pytest.skip("this build has no program mercury")

    def run(*arguments):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=True).stdout

    return run


@pytest.fixture
def recorded(robots, tmp_path, mercury):
    """A recording of the robots of the test: 5 frames in 0.2 s."""
    for i, robot in enumerate(robots):
        robot.save(tmp_path / f"{i}.json")
    path = tmp_path / "run.h5"
    where = ["--record", path, "--every", 50, "--seconds", 0.2, "--device", "cpu"]
    mercury("run", *(tmp_path / f"{i}.json" for i in range(len(robots))), *where)
    return path


@pytest.fixture(params=["cpu", "cuda"])
def device(request):
    """Every device that Mercury steps robots on; skips those that this machine or build lacks."""
    try:
        mercurysim.Batch([], device=request.param)
    except mercurysim.DeviceError as error:
        pytest.skip(str(error))
    return request.param


@pytest.fixture
def robots():
    return mercurysim.random_voxel(4, seed=1)


@pytest.fixture
def batch(robots, device):
    return mercurysim.Batch(robots, device=device)
