# SPDX-License-Identifier: Apache-2.0
"""A ray: a flat body whose wings wave from front to back. x points ahead, y to the left, z up."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mesh import Mesh, document, muscles_for


def waving_wings(
    name: str,
    *,
    span: float,  # [m]
    chord: float,  # in the middle [m]
    tip: float,  # chord of the wing's tip, over that
    sweep: float,  # of the tip behind the middle, over the chord
    rows: int,  # cells across the span
    stations: int,  # cells from the front to the back
    thickness: tuple[float, float],  # in the middle and at the tip [m]
    edge: float,  # thickness at the leading and trailing edges, over that in the middle of the row
    frequency: float,  # [Hz]
    wavelength: float,  # [m]
    slope: float,  # of the wave at the tip: 2 pi over the wavelength, times its height
    begin: float,  # where the wing begins to wave, of the distance from the middle
    modulus: float,
    softest: float = 0.35,  # `softest` of document(), over E / (rho h^2)
    relaxation_time: float = 1e-4,
) -> dict[str, Any]:
    """Two skins, the upper and the lower, whose muscles make the wave z = W(y) sin(k (x - c t)), W rising to the tips."""
    across, along = np.linspace(-1, 1, rows + 1), np.linspace(0, 1, stations + 1)
    out = np.abs(across)
    width = chord * np.sqrt(1 - (1 - tip**2) * out**2)
    points = np.zeros((stations + 1, rows + 1, 2, 3))
    points[..., 0] = ((along[:, None] - 0.5) * width - sweep * chord * out**2)[..., None]
    points[..., 1] = (across * span / 2)[:, None]
    rounding = edge + (1 - edge) * np.sqrt(4 * along * (1 - along))
    half = (thickness[0] + (thickness[1] - thickness[0]) * out**0.8) / 2 * rounding[:, None]
    points[..., 2] = half[..., None] * np.array([-1, 1])
    mesh = Mesh.lattice(points)
    k = 2 * math.pi / wavelength
    x, y, z = mesh.points.T

    def pose(t: float) -> Any:
        at = np.clip((np.abs(y) / (span / 2) - begin) / (1 - begin), 0, None)
        height, rise = slope / k * at**2, slope / k * 2 * at / ((1 - begin) * span / 2) * np.sign(y)
        turn = k * x + 2 * math.pi * t
        # The normal of the middle turns with the wave, and both skins stay where they are on it.
        tilt_x, tilt_y = height * k * np.cos(turn), rise * np.sin(turn)
        norm = np.sqrt(1 + tilt_x**2 + tilt_y**2)
        return np.stack([x - z * tilt_x / norm, y - z * tilt_y / norm, height * np.sin(turn) + z / norm], axis=1)

    h = chord / stations
    return document(
        name, "water", mesh, muscles_for(mesh, pose, frequency), modulus=modulus, relaxation_time=relaxation_time,
        softest=softest * modulus / (1070 * h**2),
    )  # fmt: skip
