# SPDX-License-Identifier: Apache-2.0
"""Mercury: thousands of soft robots at once, on a GPU or on the cores of a CPU.

    import mercurysim

    robots = mercurysim.random_voxel(64, seed=1)
    batch = mercurysim.Batch(robots, environment=mercurysim.Ocean())
    batch.step(1000)
    print(batch.telemetry()["center_of_mass"])
"""

from . import _mercury
from ._mercury import *  # noqa: F403  random_voxel() and its siblings, one for each kind of robots
from ._mercury import (
    Actuation,
    Array,
    Batch,
    BatchState,
    DeviceError,
    Environment,
    InputError,
    Land,
    Ocean,
    OceanSimple,
    Recorder,
    Recording,
    Result,
    Results,
    Robot,
    Water,
    evaluate,
    export,
    load,
    voxel,
)
from ._signatures import make_readable

make_readable(globals())

from ._pages import Page, show  # noqa: E402
from ._pictures import Film, Look, Video, picture, render  # noqa: E402

__version__: str = getattr(_mercury, "__version__")

__all__ = [
    "Actuation",
    "Array",
    "Batch",
    "BatchState",
    "DeviceError",
    "Environment",
    "Film",
    "InputError",
    "Land",
    "Look",
    "Ocean",
    "OceanSimple",
    "Page",
    "Recorder",
    "Recording",
    "Result",
    "Results",
    "Robot",
    "Video",
    "Water",
    "__version__",
    "evaluate",
    "export",
    "load",
    "picture",
    "render",
    "show",
    "voxel",
]

__all__ += [name for name in dir(_mercury) if name.startswith("random_")]
