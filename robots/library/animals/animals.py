# SPDX-License-Identifier: Apache-2.0
"""The sample animals that no generator makes. Their numbers were found by a search (CMA-ES) for speed."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from drifters import pulsing_bell
from rays import waving_wings
from walkers import four_legged, walker


def jellyfish() -> dict[str, Any]:
    """Its bell closes faster than it opens, and its margin lags behind."""
    return pulsing_bell(
        "jellyfish",
        radius=0.5,
        thickness=(0.0854, 0.0584),
        rings=6,
        open_angle=0.985,
        swing=0.35,
        begin=0.099,
        curl=0.349,
        frequency=1.72,
        jerk=0.37,
        modulus=1.13e6,
        margin=0.43,
    )


def ray() -> dict[str, Any]:
    """As a manta it flies more than it waves: its wings are shorter than the wave."""
    return waving_wings(
        "ray",
        span=1.75,
        chord=1.3,
        tip=0.508,
        sweep=-0.05,
        rows=12,
        stations=14,
        thickness=(0.153, 0.0664),
        edge=0.4,
        frequency=2.2,
        wavelength=1.56,
        slope=1.2,
        begin=0.18,
        modulus=5e6,
    )


def ant() -> dict[str, Any]:
    """Six legs in two tripods: three always stand."""
    return walker(
        "ant",
        cell=(0.1, 0.1, 0.1),
        trunk=(11, 2, 2),
        legs=[(0, True, 0), (4, True, 0.5), (8, True, 0), (0, False, 0.5), (4, False, 0), (8, False, 0.5)],
        leg=(2, 3),
        swing=0.227,
        lift=0.2,
        frequency=1.3,
        modulus=5.5e5,
        relaxation_time=0.003,
        taper=0.83,
        nose=0.83,
    )


def dog() -> dict[str, Any]:
    """It trots: a hind leg steps together with the foreleg of the other side."""
    return four_legged(
        "dog",
        cell=(0.1, 0.1, 0.1),
        trunk=(8, 2),
        down=3,
        gait=(0, 0.5, 0.5, 0),
        swing=0.26,
        lift=0.12,
        frequency=1.35,
        modulus=1.3e6,
        relaxation_time=0.0026,
        softest=0.44,
    )


ANIMALS: dict[str, Callable[[], dict[str, Any]]] = {"ant": ant, "dog": dog, "jellyfish": jellyfish, "ray": ray}
