# SPDX-License-Identifier: Apache-2.0
"""A jellyfish: a bell that closes fast and opens slowly. z points ahead."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mesh import Mesh, document, muscles_for


def disc(rings: int) -> Any:
    """Distance from the middle and angle (2 rings + 1, 2 rings + 1) of a square grid whose squares become circles
    (P. Shirley and K. Chiu, A low distortion map between disk and square, 1997)."""
    u, v = np.meshgrid(*[np.arange(-rings, rings + 1) / rings] * 2, indexing="ij")
    radius = np.maximum(np.abs(u), np.abs(v))
    wide = np.abs(u) >= np.abs(v)
    with np.errstate(divide="ignore", invalid="ignore"):
        angle = math.pi / 4 * np.where(wide, v / u, 2 - u / v) + np.where(np.where(wide, u, v) < 0, math.pi, 0)
    return radius, np.where(radius > 0, angle, 0)


def pulsing_bell(
    name: str,
    *,
    radius: float,  # of the bell along its skin, from the apex to the margin [m]
    thickness: tuple[float, float],  # at the apex and at the margin [m]
    rings: int,
    open_angle: float,  # of the margin from the horizontal, half open, in right angles
    swing: float,  # by how much it closes and opens from there, in right angles
    begin: float,  # where the bell begins to swing, of the distance from the apex
    curl: float,  # how much more the margin lags behind, in turns
    frequency: float,  # of the pulses [Hz]
    jerk: float,  # 0: closes as fast as it opens; 0.5: two terms of a saw tooth
    modulus: float,
    margin: float = 1.0,  # modulus of the outermost ring over that of the others
    relaxation_time: float = 0.002,
    softest: float = 0.35,  # `softest` of document(), over E / (rho h^2)
) -> dict[str, Any]:
    along, angle = disc(rings)
    thick = thickness[0] + (thickness[1] - thickness[0]) * along
    at = np.repeat(along.ravel(), 2)
    turn_of = np.repeat(angle.ravel(), 2)
    offset = np.repeat(thick.ravel(), 2) * np.tile([-0.5, 0.5], along.size)  # inner, outer
    fine = np.linspace(0, 1, 201)
    path = np.clip((fine - begin) / (1 - begin), 0, None)

    def pose(t: float) -> Any:
        turns = t + 0.5 - curl * fine**2  # it begins where it opens slowly
        closed = np.sin(2 * math.pi * turns) + jerk * np.sin(4 * math.pi * turns)
        slope = math.pi / 2 * (open_angle * fine + swing * path * closed)
        r = np.concatenate([[0], np.cumsum((np.cos(slope[1:]) + np.cos(slope[:-1])) / 2)]) * radius / 200
        z = -np.concatenate([[0], np.cumsum((np.sin(slope[1:]) + np.sin(slope[:-1])) / 2)]) * radius / 200
        s, rr, zz = (np.interp(at, fine, values) for values in (slope, r, z))
        rr, zz = rr + offset * np.sin(s), zz + offset * np.cos(s)
        return np.stack([rr * np.cos(turn_of), rr * np.sin(turn_of), zz], axis=1)

    rest = np.mean([pose(i / 32) for i in range(32)], axis=0)
    mesh = Mesh.lattice(rest.reshape(*along.shape, 2, 3))
    ring = np.repeat(np.round(along * rings).astype(int).ravel(), 2)[mesh.used]
    outermost = ring[mesh.cells].min(axis=1) == rings - 1
    return document(
        name, "water", mesh, muscles_for(mesh, lambda t: pose(t)[mesh.used], frequency, harmonics=2 if jerk else 1),
        modulus=modulus * np.where(outermost, margin, 1.0), relaxation_time=relaxation_time,
        softest=softest * modulus / (1070 * (radius / rings) ** 2),
    )  # fmt: skip
