#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Steps of an environment per second: bench/bench_gym.py [--robots N] [--size VOXELS] [--frame-skip N] [--eel]

The robots are solids of 5 x 5 x 5 voxels of muscle, with 216 masses, or the eel of examples/python/ppo.py. Rows take
turns, so that a change of the clock rate affects all; figures are medians. Every row steps the same robots.

    stepping only        Batch.step(frame_skip)
    driven and observed  the same, with actions written before it and centers of mass read after it, in PyTorch
    SwimEnv.step         the whole environment: observations, rewards, targets and resets
"""
import argparse
import statistics
import time

import numpy as np
import torch

import mercurysim
from mercurysim.gym import SwimEnv, eel

CALLS, TURNS = 50, 20


def cube(size):
    middle = (np.arange(size) >= size / 2).astype(np.uint8)
    return mercurysim.voxel(1 + middle[:, None, None] + 2 * middle[:, None] + 4 * middle, name="cube")


def measure(env):
    """{row: median seconds of a call}"""
    drive, centers = torch.from_dlpack(env.batch.actuation.drive), torch.from_dlpack(env.batch.centers)
    actions = 0.2 * torch.rand(env.action_space.shape, device=drive.device)
    stream = torch.cuda.current_stream().cuda_stream if drive.is_cuda else None
    total = torch.zeros_like(centers)

    def driven_and_observed():
        drive.copy_(actions)
        env.batch.step(env.frame_skip, stream=stream)
        total.add_(centers)

    rows = {
        "stepping only": lambda: env.batch.step(env.frame_skip, stream=stream),
        "driven and observed": driven_and_observed,
        "SwimEnv.step": lambda: env.step(actions),
    }
    env.reset(seed=1)
    times = {name: [] for name in rows}
    for turn in range(TURNS + 1):
        for name, call in rows.items():
            if drive.is_cuda:
                torch.cuda.synchronize()
            start = time.perf_counter()
            for _ in range(CALLS):
                call()
            if drive.is_cuda:
                torch.cuda.synchronize()
            if turn > 0:  # the first turn warms up
                times[name].append((time.perf_counter() - start) / CALLS)
    return {name: statistics.median(values) for name, values in times.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", type=int, default=1024)
    parser.add_argument("--size", type=int, default=5, help="of the cube [voxels]")
    parser.add_argument("--frame-skip", type=int, default=20)
    parser.add_argument("--eel", action="store_true")
    parser.add_argument("--device", default="auto")
    options = parser.parse_args()
    robot = eel() if options.eel else cube(options.size)
    env = SwimEnv(robot, options.robots, device=options.device, torch=True, frame_skip=options.frame_skip)
    print(f"{options.robots} robots of {len(robot.masses)} masses, {options.frame_skip} time steps per call, on "
          f"{env.batch.device_name}")
    print("                     per call   calls x robots / s   time steps x robots / s")
    for name, seconds in measure(env).items():
        rate = options.robots / seconds
        print(f"{name:19} {1e3 * seconds:7.3f} ms {rate:16,.0f} {rate * options.frame_skip:22,.0f}")


if __name__ == "__main__":
    main()
