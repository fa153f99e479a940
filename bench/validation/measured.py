# SPDX-License-Identifier: Apache-2.0
"""What others measured, and how the numbers follow from their data.

    python3 bench/validation/measured.py beam DIRECTORY     of a clone of srl-ethz/diffPD_sim2real: its realbeam_experiments/Measurement_data
    python3 bench/validation/measured.py catshark FILE      of a clone of fberio/scanicula_steady_swimming: its scanicula_midline_kinematics.txt

Both repositories have the MIT license.
"""

from __future__ import annotations

import csv
import struct
import sys
from pathlib import Path

import numpy as np

# A clamped beam of silicone (Dragon Skin 10), 30 x 30 x 100 mm, is held straight and released under its weight, with nothing,
# 52 g or 101 g at the upper edge of its free end: how far a marker at the end has sunk in the end [mm], and the frequency of
# the first swings [Hz]. By recording: the first frame after the release, as its authors chose it.
BEAM_RECORDINGS = {
    "beam_gravity_V2_b.c3d": 65,
    "beam_load52_V2_a.c3d": 43,
    "beam_load101_V2_a.c3d": 51,
}
BEAM_SAG = {0.0: 6.63, 0.51012: 17.28, 1.00062: 26.13}  # load [N]: [mm]
BEAM_FREQUENCY = 7.73
BEAM_SOURCE = (
    "motion capture by M. Dubied, M. Y. Michelis, A. Spielberg and R. K. Katzschmann, Sim-to-Real for Differentiable "
    "Projective Dynamics on Soft Robots, IEEE RA-L 7 (2022); github.com/srl-ethz/diffPD_sim2real (MIT)"
)

# Small-spotted catsharks that swim steadily: f A / U, means of 4 or 5 animals, by speed in body lengths per second.
CATSHARK = {0.5: 0.661, 0.75: 0.462, 1.0: 0.340, 1.25: 0.291, 1.5: 0.269, 1.75: 0.256, 2.0: 0.217, 3.0: 0.161, 4.0: 0.138,
            5.0: 0.124, 6.0: 0.094}  # fmt: skip
CATSHARK_SOURCE = (
    "F. Berio, C. Morerod and V. Di Santo, Speed-Dependent Locomotor Patterns During Steady Swimming in a Demersal Shark; "
    "github.com/fberio/scanicula_steady_swimming (MIT)"
)

# How far sample robots of evosoro get in its own simulator in 5 s [m], along the ground on land: with 99, 100 and 101 % of the
# elastic moduli of their files. Why Mercury is known to differ by more than a tenth, or nothing.
EVOSORO: dict[str, tuple[list[float], str]] = {
    "hexapus": ([0.3241, 0.3232, 0.3223], ""),
    "flapping_passive_tissue": ([0.2918, 0.2919, 0.2920], "its voxels swing 9 % wider here than there"),
    "hopper": ([1.5043, 1.5097, 1.5102], ""),
    "pusher_land": ([2.4985, 2.4998, 2.5002], "the ground damps the turning of voxels there, and it needs that: without, it gets 22 % of its way"),
    "quadruped_land": ([1.3979, 1.4050, 1.4115], "its legs fold, and it walks on contacts between spheres of 1.5 voxels, which Mercury does not have"),
}
EVOSORO_SOURCE = (
    "evosoro at commit b95ec95, `_voxcad_land_water`, built with its Makefile; S. Kriegman, F. Corucci and others, "
    "github.com/skriegman/evosoro (MIT)"
)

# Where the six markers are before the release [m]: x along the beam from its end, z up. The last three are on the clamp.
MARKERS = np.array(
    [[0, 0.015, 0.036], [0, -0.006, 0.024], [0, 0.036, 0.006], [-0.094, -0.01, -0.001], [-0.094, 0.04, 0.0275], [-0.094, 0.04, 0]]
)


def c3d_points(path: Path) -> tuple[np.ndarray, float]:
    """Positions (frames, markers, 3) of a C3D file of floats, and frames per second."""
    data = path.read_bytes()
    points, analog, first, last, _, scale, block, _, rate = struct.unpack("<5Hf2Hf", data[2:24])
    if scale >= 0:
        sys.exit(f"{path}: holds integers; only C3D files of floats can be read")
    frames, width = last - first + 1, 4 * points + analog
    values = np.frombuffer(data, "<f4", frames * width, (block - 1) * 512).reshape(frames, width)
    return values[:, : 4 * points].reshape(frames, points, 4)[:, :, :3].astype(float), rate


def beam(directory: Path) -> None:
    for name, start in BEAM_RECORDINGS.items():
        points, rate = c3d_points(directory / name)
        # The rotation that takes the markers to where they should be (Kabsch).
        here, there = points[start] - points[start].mean(axis=0), MARKERS - MARKERS.mean(axis=0)
        u, _, v = np.linalg.svd(here.T @ there)
        height = points[:, 1] @ (u @ np.diag([1, 1, np.sign(np.linalg.det(u @ v))]) @ v)[:, 2]
        swing = height[start:] - height[-50:].mean()
        i = np.flatnonzero(swing[1:] * swing[:-1] < 0)[:7]
        crossings = i + swing[i] / (swing[i] - swing[i + 1])
        frequency = rate * (len(crossings) - 1) / 2 / (crossings[-1] - crossings[0])
        print(f"{name}: sinks by {1000 * swing[0]:.2f} mm, swings at {frequency:.2f} Hz")


def catshark(file: Path) -> None:
    found: dict[float, list[float]] = {}
    with file.open(newline="") as lines:
        for row in csv.DictReader(lines):
            try:
                frequency, amplitude, speed, length = (float(row[name]) for name in ("TBF", "tailAmplitude", "U", "TL"))
            except ValueError:  # NA
                continue
            found.setdefault(float(row["speedBL"]), []).append(frequency * amplitude * length / 100 / speed)
    for speed, values in sorted(found.items()):
        print(f"{speed:g} body lengths/s: f A / U = {np.mean(values):.3f}, {min(values):.3f} to {max(values):.3f}, {len(values)} animals")


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("beam", "catshark"):
        sys.exit(__doc__)
    {"beam": beam, "catshark": catshark}[sys.argv[1]](Path(sys.argv[2]))
