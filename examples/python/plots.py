# SPDX-License-Identifier: Apache-2.0
"""Plots a recording: the paths of the robots' centers of mass, and their speeds.

    mercury run --random voxel:4 --seconds 10 --record swim.h5
    python plots.py swim.h5 swim.png
"""
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, (map_of_paths, speeds) = plt.subplots(1, 2, figsize=(9, 4), constrained_layout=True)
with h5py.File(sys.argv[1]) as file:
    for robot in file["particles"].values():
        time = robot["position/time"][:]
        center = np.average(robot["position/value"][:], axis=1, weights=robot["mass"][:])
        speed = np.linalg.norm(np.average(robot["velocity/value"][:], axis=1, weights=robot["mass"][:]), axis=1)
        (line,) = map_of_paths.plot(center[:, 0], center[:, 1])
        map_of_paths.plot(*center[-1, :2], "o", color=line.get_color())
        speeds.plot(time, speed, label=robot.attrs["name"].decode())
map_of_paths.set(xlabel="x [m]", ylabel="y [m]", title="paths of the centers of mass", aspect="equal")
speeds.set(xlabel="time [s]", ylabel="speed [m/s]", title="speed of the center of mass")
speeds.legend()
figure.savefig(sys.argv[2], dpi=120)
