# SPDX-License-Identifier: Apache-2.0
"""Mercury: thousands of soft robots at once, on a GPU or on the cores of a CPU.

    import mercurysim

    robots = mercurysim.random_voxel(64, seed=1)
    batch = mercurysim.Batch(robots, environment=mercurysim.Ocean())
    batch.step(1000)
    print(batch.telemetry()["center_of_mass"])
"""

from . import _mercury
from ._mercury import *  # noqa: F403  a function random_voxel() for each kind of robots, a class Ocean for each environment
from ._mercury import (
    Actuation,
    Array,
    Batch,
    BatchState,
    DeviceError,
    Environment,
    InputError,
    Recorder,
    Recording,
    Result,
    Results,
    Robot,
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
    "Look",
    "Page",
    "Recorder",
    "Recording",
    "Result",
    "Results",
    "Robot",
    "Video",
    "__version__",
    "evaluate",
    "export",
    "load",
    "picture",
    "render",
    "show",
    "voxel",
]

_environments = {cls.__name__ for cls in Environment.__subclasses__()}
__all__ += [name for name in dir(_mercury) if name.startswith("random_") or name in _environments]
