# SPDX-License-Identifier: Apache-2.0
"""The sample animals. Their numbers were found by a search (CMA-ES) for speed at the Strouhal number of animals, 0.27."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from swimmers import bending_body


def eel() -> dict[str, Any]:
    """Its whole body waves, as an eel's does, by nearly as much at the head as at the tail.

    All its cross sections are alike, so the sides of its cells are flat.
    """
    length, waves = 2.0, 1.87
    a, head, middle = 0.68, 1.1, -0.03  # k b of the wave at the tail; at the head and, added, in the middle over that

    def girth(at: Any) -> Any:
        nose = np.sqrt(np.clip(at / 0.15, 0.22, 1))
        return nose * (1 - 0.15 * at**2) * np.where(at > 0.9, 1 - 0.5 * ((at - 0.9) / 0.1) ** 2, 1)

    return bending_body(
        "eel",
        length=length,
        stations=22,
        layers=3,
        width=lambda at: 0.105 * girth(at),
        depth=lambda at: 0.187 * girth(at),
        edge=0.6,
        frequency=2.0,
        waves=waves,
        curvature=lambda at: a * (2 * math.pi * waves / length) * (head + (1 - head) * at + 4 * middle * at * (1 - at)),
        segments=16,
        modulus=5.3e6,
    )


def smooth(at: Any, places: Any, values: Any) -> Any:
    """A curve through the values without hills of its own (F. N. Fritsch and J. Butland, 1984)."""
    step, rise = np.diff(places), np.diff(values) / np.diff(places)
    slope = np.concatenate([rise[:1], np.zeros(len(rise) - 1), rise[-1:]])
    same = rise[1:] * rise[:-1] > 0
    slope[1:-1][same] = 2 * (rise[1:] * rise[:-1])[same] / (rise[1:] + rise[:-1])[same]
    i = np.clip(np.searchsorted(places, at) - 1, 0, len(step) - 1)
    t = (at - places[i]) / step[i]
    start, end = values[i] * (1 + 2 * t) + slope[i] * step[i] * t, values[i + 1] * (3 - 2 * t) - slope[i + 1] * step[i] * (1 - t)
    return start * (1 - t) ** 2 + end * t**2


def fish() -> dict[str, Any]:
    """A deep body, a narrow stem and a rounded fin. Its cross sections are alike, as the eel's are."""
    length, waves = 1.2, 1.95
    a, head, middle = 0.554, 0.89, -0.072  # as the eel's
    behind = np.array([0, 0.04, 0.1, 0.2, 0.35, 0.5, 0.65, 0.78, 0.85, 0.9, 0.95, 1])
    depths = length * np.array([0.07, 0.111, 0.153, 0.195, 0.209, 0.186, 0.135, 0.118, 0.104, 0.0853, 0.0938, 0.0896])
    ratio = 0.485

    def depth(at: Any) -> Any:
        return smooth(at, behind, depths)

    def curvature(at: Any) -> Any:
        wanted = a * (2 * math.pi * waves / length) * (head + (1 - head) * at + 4 * middle * at * (1 - at))
        ends = np.clip(np.minimum(at / 0.25, (1 - at) / 0.15), 0, 1)
        return ends * np.minimum(wanted, 0.6 / (ratio * depth(at)))  # muscles shorten by 0.3 at most

    return bending_body(
        "fish",
        length=length,
        stations=18,
        layers=4,
        width=lambda at: ratio * depth(at),
        depth=depth,
        edge=0.45,
        frequency=2.45,
        waves=waves,
        curvature=curvature,
        segments=14,
        modulus=3.071e6,
    )


def inchworm() -> dict[str, Any]:
    """Waves run from its tail to its head: what the wave lifts swings ahead, and the rest stands."""
    thickness, contraction = 0.14, 0.28

    def girth(at: Any) -> Any:
        return np.sqrt(np.clip(np.minimum(at, 1 - at) / 0.1, 0.4, 1))

    return bending_body(
        "inchworm",
        length=1.6,
        stations=20,
        layers=3,
        width=lambda at: thickness * girth(at),
        depth=lambda at: 0.24 * girth(at),
        edge=0.7,
        frequency=1.0,
        waves=-1.2,
        curvature=lambda at: 2 * contraction / thickness,
        segments=16,
        modulus=4e5,
        relaxation_time=0.005,
        upright=False,
        environment="land",
    )


ANIMALS: dict[str, Callable[[], dict[str, Any]]] = {"eel": eel, "fish": fish, "inchworm": inchworm}
