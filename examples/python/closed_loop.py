# SPDX-License-Identifier: Apache-2.0
"""A controller written by hand steers eels to targets: a wave of muscles drives them on, and a bias turns them.

    python closed_loop.py

Positions are read and drive signals are written in the memory of the batch, every 0.04 s. Prints how near each eel
comes to its target, and how near a second eel comes that does not steer.
"""
import numpy as np

import mercurysim
from mercurysim.bodies import eel

BEARINGS = np.radians([-90, -45, 0, 45, 90])  # of the targets, positive to the left
DISTANCE, SECONDS, FREQUENCY, WAVES = 1.5, 40, 6, 1.2  # [m], [s], [rad/s], wavelengths along the body

robot = eel()
segments, count = len(robot.actuators), len(BEARINGS)
targets = DISTANCE * np.stack([np.cos(BEARINGS), np.sin(BEARINGS)], axis=1)
batch = mercurysim.Batch([robot] * 2 * count, dt=2e-3, device="cpu")  # the second half does not steer
positions = np.asarray(batch.positions).reshape(2 * count, -1, 3)
drive, centers = np.asarray(batch.actuation.drive), np.asarray(batch.centers)
tail, head = (np.flatnonzero(half) for half in (robot.masses[:, 0] < 0, robot.masses[:, 0] > 0))


def angle(start, end):
    """By how much each vector of `end` lies to the left of that of `start` [rad]."""
    (ax, ay), (bx, by) = start.T, end.T
    return np.arctan2(ax * by - ay * bx, ax * bx + ay * by)


nearest = np.full(2 * count, np.inf)
while batch.time < SECONDS:
    way = np.tile(targets, (2, 1)) - centers[:, :2]
    nearest = np.minimum(nearest, np.linalg.norm(way, axis=1))
    heading = (positions[:, head].mean(axis=1) - positions[:, tail].mean(axis=1))[:, :2]
    turn = np.clip(angle(heading, way), -0.4, 0.4)
    turn[count:] = 0
    wave = np.sin(FREQUENCY * batch.time + 2 * np.pi * WAVES * np.arange(segments) / segments)
    drive[:] = 0.7 * wave - turn[:, None]  # u > 0 bends a segment to the right
    batch.step(20)

print("target     with control  without")
for bearing, steered, adrift in zip(BEARINGS, nearest[:count], nearest[count:]):
    print(f"{np.degrees(bearing):+4.0f} deg   {steered:8.3f} m  {adrift:6.3f} m")
