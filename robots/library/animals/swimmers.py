# SPDX-License-Identifier: Apache-2.0
"""Bodies that bend in a wave: an eel, a fish, a worm. x points ahead, y to the left, z up.

What resistive water allows. A sheet with the wave y = b sin(k (x - c t)) swims at U = s c, where s follows from a = k b and
the ratio of C_T to C_N alone (docs/validation.md): 0.40, 0.61 and 0.71 at a = 0.3, 0.6 and 1. Its Strouhal number is

    f 2 b / U = a / (pi s):   0.24, 0.31, 0.45

so an animal's 0.2 to 0.4 needs a of 0.2 to 0.8, a body without blunt ends (C_N acts on them), and 1.2 waves or more on the
body, since with fewer the whole body turns to and fro. Its speed is s f / waves body lengths per second. The muscles impose
the curvature as long as the body's own slowest vibration is not slower than the beat, which takes some MPa: the water's
pressure is of the order of rho (1 - s)^2 (c a)^2, the body's inertia several times as large.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from mesh import Mesh, Muscle, digits, document


def bending_body(
    name: str,
    *,
    length: float,  # [m]
    stations: int,  # cells along the body
    layers: int,  # cells from the lower to the upper edge
    width: Callable[[Any], Any],  # [m], of the distance behind the nose, 0 to 1
    depth: Callable[[Any], Any],  # [m]
    edge: float,  # thickness at the upper and lower edge, over that in the middle
    frequency: float,  # of the beat [Hz]
    waves: float,  # on the body
    curvature: Callable[[Any], Any],  # [1/m], largest, of the distance behind the nose
    segments: int,  # muscles along each side
    modulus: float,
    modulus_of: Callable[[Any], Any] = np.ones_like,  # over `modulus`
    softest: float = 0.35,  # `softest` of document(), over E / (rho h^2)
    relaxation_time: float = 1e-4,
    upright: bool = True,  # False: lies on its side, so that it bends up and down
    environment: str = "water",
) -> dict[str, Any]:
    """Two skins, left and right, of `layers` cells; muscles along both work in opposite pairs."""
    behind = np.linspace(0, 1, stations + 1)
    height = np.linspace(-1, 1, layers + 1)
    points = np.zeros((stations + 1, 2, layers + 1, 3))
    points[..., 0] = (1 - behind[:, None, None]) * length
    points[..., 1] = (width(behind)[:, None] / 2 * (1 - (1 - edge) * height**2))[:, None] * np.array([-1, 1])[:, None]
    points[..., 2] = (depth(behind)[:, None] / 2 * height)[:, None]
    if not upright:
        points = points[..., [0, 2, 1]] * (1, -1, 1)
    mesh = Mesh.lattice(points[::-1])  # x first, ascending
    station, side, layer = (index.ravel() for index in np.indices(points.shape[:3]))

    def muscles(a: int, b: int) -> tuple[Muscle, ...]:
        if station[a] == station[b] or side[a] != side[b]:
            return ()
        way = mesh.points[b] - mesh.points[a]
        along = float(way[0] ** 2 / (way @ way))  # a spring at an angle follows those along the body
        at = 1 - float(mesh.points[[a, b], 0].mean()) / length
        if not 0.9 / stations < at < 1 - 0.9 / stations:  # the cells at both ends
            return ()
        segment = (min(segments - 1, int(at * segments)) + 0.5) / segments
        amplitude = digits(float(curvature(segment)) * float(width(np.array(segment))) / 2 * along, 2)
        if amplitude < 1e-3:
            return ()
        return ((amplitude if side[a] else -amplitude, 2 * math.pi * frequency, -2 * math.pi * waves * segment),)

    middle = mesh.points[mesh.cells, 0].mean(axis=1)
    return document(
        name, environment, mesh, muscles, modulus=modulus * modulus_of(1 - middle / length), relaxation_time=relaxation_time,
        softest=softest * modulus / (1070 * (length / stations) ** 2),
    )  # fmt: skip
