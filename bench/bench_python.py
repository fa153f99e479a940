# SPDX-License-Identifier: Apache-2.0
"""Measures what a program in Python pays to step robots, to drive their actuators and to read their states.

    PYTHONPATH=build/python python bench/bench_python.py [--device cuda] [--robots 1024] [--steps 20] [--seconds 2]

The robots are those of bench_shared_arrays: solids of 5 x 5 x 5 voxels of muscle, with 216 masses. One call makes some
steps. The first row makes the same steps in one call, so its loop is in C++; ratios are speeds relative to it. All rows
take turns, so that a change of the clock rate affects all; the times are medians. "host" is how long Python takes for a
call, on CUDA without waiting for the device. An environment step is one call for one robot.
"""

import argparse
import statistics
import time

import mercurysim

CALLS = 50  # of a turn


def solids(count):
    return mercurysim.random_voxel(
        count, seed=1, voxels=(5, 5, 5), air=0, tissue=0, bone=0, symmetry="none", frequencies=5
    )


class Loop:
    """Steps a batch in one way."""

    def __init__(self, name, robots, arguments, driven=(), read=()):
        self.name, self.read = name, read
        self.steps = arguments.steps
        self.batch = mercurysim.Batch(robots, device=arguments.device)
        self.drive = None
        self.observed = []
        self.host, self.total = [], []
        if driven or read:
            self.prepare(driven, read)

    def prepare(self, driven, read):
        import torch

        if driven:
            self.drive = torch.from_dlpack(self.batch.actuation.drive)
            self.actions = [torch.rand_like(self.drive) * 2 - 1 for _ in range(2)]
        views = [torch.from_dlpack(getattr(self.batch, name)) for name in read]
        self.observed = [(torch.empty_like(view), view) for view in views]

    def call(self, i):
        if self.drive is not None:
            self.drive.copy_(self.actions[i % 2])
        self.batch.step(self.steps)
        for copy, view in self.observed:
            copy.copy_(view)

    def turn(self):
        start = time.perf_counter()
        for i in range(CALLS):
            self.call(i)
        self.host.append((time.perf_counter() - start) / CALLS)
        self.batch.synchronize()
        self.total.append((time.perf_counter() - start) / CALLS)


class OneCall(Loop):
    def turn(self):
        start = time.perf_counter()
        self.batch.step(CALLS * self.steps)
        self.host.append((time.perf_counter() - start) / CALLS)
        self.batch.synchronize()
        self.total.append((time.perf_counter() - start) / CALLS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--robots", type=int, default=1024)
    parser.add_argument("--steps", type=int, default=20, help="per call")
    parser.add_argument("--seconds", type=float, default=2, help="per row")
    arguments = parser.parse_args()
    robots = solids(arguments.robots)
    loops = [
        OneCall("one call of step()", robots, arguments),
        Loop("step()", robots, arguments),
    ]
    try:
        import torch  # noqa: F401
    except ImportError:
        print("without PyTorch: no arrays are written or read")
    else:
        loops += [
            Loop("  centers read", robots, arguments, read=["centers"]),
            Loop("  positions read", robots, arguments, read=["positions"]),
            Loop("  drive written", robots, arguments, driven=True),
            Loop("  drive written, centers read", robots, arguments, driven=True, read=["centers"]),
            Loop("  drive written, positions read", robots, arguments, driven=True, read=["positions"]),
        ]
    for loop in loops:
        loop.turn()
        loop.host.clear(), loop.total.clear()
    start = time.perf_counter()
    while time.perf_counter() - start < arguments.seconds * len(loops):
        for loop in loops:
            loop.turn()

    batch, robot = loops[0].batch, robots[0]
    print(
        f"{batch.device_name}, {len(robots)} robots of {len(robot.masses)} masses and {len(robot.springs)} springs, "
        f"{len(batch.actuators(0))} actuators, {arguments.steps} steps per call"
    )
    fastest = statistics.median(loops[0].total)
    for loop in loops:
        call = statistics.median(loop.total)
        print(
            f"{loop.name:32} {1e3 * call:9.4f} ms per call, host {1e3 * statistics.median(loop.host):9.4f} ms, "
            f"{len(robots) / call:.3e} environment steps/s, {fastest / call:6.3f}"
        )
    empty = mercurysim.Batch([], device=arguments.device)
    count = 20000
    start = time.perf_counter()
    for _ in range(count):
        empty.step(1)
    print(f"step() of no robots {1e6 * (time.perf_counter() - start) / count:.2f} us")


main()
