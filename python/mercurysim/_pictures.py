# SPDX-License-Identifier: Apache-2.0
"""Pictures and films of robots, without a window or a display."""

from __future__ import annotations

import atexit
import base64
import os
import shutil
import weakref
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Sequence, TypedDict, Union

from . import _mercury
from ._mercury import Batch, DeviceError, Environment, InputError, Recording, Result, Robot, load

if TYPE_CHECKING:
    import numpy.typing
    from typing_extensions import Unpack

    Filmed = Union[Robot, Sequence[Robot], Recording, Result, Sequence[Result], str, os.PathLike[str]]

_most_sides = 4

_cpp: Any = _mercury  # has functions for this file alone, which its stubs leave out


class Look(TypedDict, total=False):
    """How a picture shows robots: the options of `mercury render`, all of them optional."""

    color: str  # color by "material", "activation", "strain", "force", "speed", "pressure", "energy", ...
    scale: tuple[float, float]  # ends of the colors' scale; else it fits
    colormap: str  # "viridis", "magma", "cividis", "turbo" or "diverging"; else that of the quantity
    log_scale: bool  # equal ratios of values are equally far apart
    show: str | Sequence[str]  # exactly what is shown: "skin,springs,labels,path,legend,clock,scale,velocity,..."
    arrow_length: float  # factor
    arrow_density: float  # share of the arrows that is drawn, up to 1
    arrow_threshold: float  # arrows shorter than this share of the longest are left out
    camera: str  # "group", "follow", "follow:NAME", "turntable", "top", "still", or a camera file (.json)
    azimuth: float  # where the eye is, around the robots from +x [degrees]
    elevation: float  # height of the eye above the horizon [degrees]
    zoom: float  # above 1: closer
    layout: str  # "grid"; "cells": each robot stays in its cell; or "race": lanes side by side
    grid: tuple[int, int]  # columns and rows
    theme: str  # "dark" or "light"
    caption: str  # text in the upper left corner; further lines are smaller
    plain: bool  # a plain backdrop rather than water or land
    cut: str  # opens each robot beyond a plane: "y:30%"
    smooth: bool  # round skins also of many robots
    style: str  # of picture(): "usual", or "hero": the first robot against the light, copies of it behind, out of focus
    aperture: float  # of picture(): blurs what is nearer or farther; diameter of the lens over its distance, 0 to 1
    faceted: bool  # edged skins, which show each voxel, also of few robots
    footprints: bool  # on land, in films of medium and high quality: robots leave footprints (default True)
    quality: str  # "auto" (high on a GPU, low without), "low", "medium", "high"


def _words(look: Look) -> dict[str, Any]:
    words: dict[str, Any] = {**look}
    if isinstance(words.get("show"), (list, tuple)):
        words["show"] = ",".join(words["show"])
    return words


def picture(
    what: Batch | Robot | Sequence[Robot],
    size: tuple[int, int] = (1280, 720),
    *,
    environment: Environment | str | None = None,
    robot: int | None = None,
    **look: Unpack[Look],
) -> numpy.typing.NDArray[numpy.uint8]:
    """A picture of a batch as it is now, or of robots at rest: an array (height, width, 3) of uint8.

    `size` is (width, height) in pixels. `environment` is what robots at rest are shown in; a batch has its own. `robot` is
    the index of the only one that is shown of a batch. `look` are the options of Look, such as color="strain" or camera="top". The same state gives the same bytes. Any thread may
    call it; pictures are drawn one after another on a thread of Mercury's own, without a display.

    Raises InputError for what cannot be used, and DeviceError where there is no OpenGL, or in a process that was forked
    from one that has drawn: start processes with the method "spawn".
    """
    image: numpy.typing.NDArray[numpy.uint8] = _cpp._picture(what, size, environment, robot, _words(look))
    return image


def _ffmpeg() -> str:
    """The encoder: MERCURY_FFMPEG, else `ffmpeg` on PATH, else that of the package imageio-ffmpeg."""
    if named := os.environ.get("MERCURY_FFMPEG"):
        return named
    if found := shutil.which("ffmpeg"):
        return found
    try:
        from imageio_ffmpeg import get_ffmpeg_exe  # type: ignore[import-untyped, import-not-found, unused-ignore]

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):
        raise DeviceError(
            "ffmpeg was not found: install it (apt install ffmpeg, or pip install imageio-ffmpeg), name the program in "
            "MERCURY_FFMPEG, or write PNG pictures into a folder"
        ) from None


def _output(path: str | os.PathLike[str]) -> tuple[str, str]:
    """The file or folder, and the encoder that it needs."""
    output = os.fspath(path)
    if not isinstance(output, str):
        raise TypeError(f"output: text or a path is expected, not {type(output).__name__}")
    if output.endswith(".png"):
        raise InputError(f"output: {output} is one picture; use picture(), or give .mp4, .webm, .gif or a folder")
    return output, _ffmpeg() if output.endswith((".mp4", ".webm", ".gif")) else "ffmpeg"


def _rate(output: str, fps: float | None) -> float:
    if fps is None:
        return 25.0 if output.endswith(".gif") else 30.0
    if not fps > 0:
        raise InputError(f"fps: {fps} is not accepted; give a finite number > 0 frames/s")
    return float(fps)


class Video:
    """A finished video: a file, or a folder of PNG pictures. Notebooks show it inline."""

    _largest_inline = 32 << 20  # bytes; larger ones would make notebooks unusable

    def __init__(self, path: str | os.PathLike[str], frames: int, size: tuple[int, int], fps: float):
        self.path = Path(path)
        self.frames = frames  # number of frames
        self.size = size  # (width, height) [pixels]
        self.fps = fps  # frames per second

    def __repr__(self) -> str:
        return f"Video({str(self.path)!r}, {self.frames} frames, {self.size[0]}x{self.size[1]})"

    def __fspath__(self) -> str:
        return str(self.path)

    def _repr_html_(self) -> str | None:
        kind = self.path.suffix[1:]
        if kind not in ("mp4", "webm", "gif") or not self.path.is_file():
            return None
        if self.path.stat().st_size > self._largest_inline:
            return f"<code>{escape(repr(self))}</code>: too large to be shown here"
        data = base64.b64encode(self.path.read_bytes()).decode()
        style = f'style="max-width: 100%; width: {self.size[0]}px; aspect-ratio: {self.size[0]} / {self.size[1]}"'
        if kind == "gif":
            return f'<img src="data:image/gif;base64,{data}" alt="{escape(self.path.name)}" {style}>'
        return f'<video controls loop muted playsinline {style} src="data:video/{kind};base64,{data}"></video>'

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        html = self._repr_html_()
        return {"text/plain": repr(self)} | ({"text/html": html} if html else {})


def _filmed(what: Filmed) -> Any:
    if isinstance(what, Batch):
        raise TypeError("what: a batch is filmed by Film; give robots, results, a recording, or the path of one")
    if isinstance(what, (str, os.PathLike)):
        return Recording(what) if os.fspath(what).endswith(".h5") else load(what)
    return what


def render(
    what: Filmed | Mapping[str, Filmed],
    output: str | os.PathLike[str],
    seconds: float | None = None,
    *,
    environment: Environment | str | None = None,
    solver: str = "force",
    dt: float = 1e-3,
    damping: float = 0.1,
    device: str = "auto",
    threads: int = 0,
    size: tuple[int, int] = (1280, 720),
    fps: float | None = None,
    speed: float = 1,
    crf: int | None = None,
    **look: Unpack[Look],
) -> Video:
    """Makes a video of robots, which it simulates, of a recording, which it plays, or of results, which it tries again.

    `what` are robots, the path of a robot file or of a folder of them, a Recording or the path of one (.h5), or a Result of
    evaluate() or several of one call, which move exactly as they did. A dict of up to four of these stands side by side
    in one film, from left to right, with its keys above: {"before": recording, "after": result}. While a recording is
    played, other threads must not use h5py.

    `output` is a file (.mp4, .webm, .gif), which is replaced, or a new or empty folder for PNG pictures. `seconds` are
    simulated (default 10; of recordings and results all of the longest: recordings stay at their end, results go
    on), `speed` of them per second of video, `fps` frames per second of video
    (default 30; 25 for .gif), exactly: frames between two steps are interpolated. `crf` is the encoder's: lower is better and larger, 0 is lossless. `environment`,
    `solver`, `dt`, `damping`, `device` and `threads` are those of Batch; recordings and results have their own. `look` are the options
    of Look.

    The result shows itself in notebooks. Ctrl-C ends it and keeps nothing. Raises InputError for what cannot be used,
    and DeviceError where there is no OpenGL or no encoder.
    """
    path, ffmpeg = _output(output)
    rate = _rate(path, fps)
    sides = what if isinstance(what, Mapping) else {"": what}
    if not 1 <= len(sides) <= _most_sides:
        raise InputError(f"what: {len(sides)} sides are not accepted; give 1 to {_most_sides}")
    frames = _cpp._render(
        [(title, _filmed(side)) for title, side in sides.items()],
        path,
        seconds,
        environment=environment,
        solver=solver,
        dt=dt,
        damping=damping,
        device=device,
        threads=threads,
        size=size,
        fps=rate,
        speed=speed,
        crf=-1 if crf is None else crf,
        ffmpeg=ffmpeg,
        look=_words(look),
    )
    return Video(path, frames, _encoded(path, size), rate)


def _encoded(path: str, size: tuple[int, int]) -> tuple[int, int]:
    """H.264 and VP9 have even sides."""
    even = path.endswith((".mp4", ".webm"))
    return (size[0] + size[0] % 2, size[1] + size[1] % 2) if even else (size[0], size[1])


class Film:
    """Films a batch that you step yourself.

        with mercurysim.Film("swim.mp4", batch) as film:
            for _ in range(100):
                film.step(100)
        film  # in a notebook: the video

    step() steps the batch and adds the frames on the way, `fps` of them per simulated second; those between two steps
    are interpolated. A program may also step the batch itself, and call frame() for each frame.

    `output`, `size`, `fps`, `crf` and `look` are those of render(). Drawing and encoding go on in the background. When
    the block of `with` ends, the film is completed; when it ends by an exception, nothing is kept. Robots that are added
    to the batch or removed from it change the layout of the next frame.
    """

    def __init__(
        self,
        output: str | os.PathLike[str],
        batch: Batch,
        *,
        fps: float | None = None,
        size: tuple[int, int] = (1280, 720),
        crf: int | None = None,
        **look: Unpack[Look],
    ):
        self.path, ffmpeg = _output(output)
        self.video: Video | None = None  # once the film is closed
        self._film = _cpp._Film(
            self.path, batch, size, _rate(self.path, fps), -1 if crf is None else crf, ffmpeg, _words(look)
        )
        _films.add(self)

    def frame(self) -> None:
        """Adds the batch as it is now. Waits while several frames are behind. Raises what an earlier frame raised."""
        self._film.add_frame()

    def step(self, n: int = 1) -> None:
        """Advances the batch by `n` time steps and adds the frames on the way, exactly `fps` per simulated second.

        The first call begins with the batch as it is. Steps that the batch makes by itself in between are not filmed.
        Waits and raises as frame() does, and InputError for more frames than steps.
        """
        self._film.step(n)

    @property
    def frames(self) -> int:
        """Number of frames so far."""
        return int(self._film.frames)

    def close(self) -> Video:
        """Completes the film, and returns the video. Raises DeviceError if the encoder fails or there is no frame."""
        if self.video is None:
            self._film.finish()
            self.video = Video(self.path, self._film.frames, self._film.size, self._film.fps)
        return self.video

    def discard(self) -> None:
        """Ends the film and keeps nothing. A file of that name that was there before stays as it was."""
        self._film.discard()

    def __enter__(self) -> Film:
        return self

    def __exit__(self, kind: Any, error: Any, trace: Any) -> None:
        if kind is None:
            self.close()
        else:
            self.discard()

    def __repr__(self) -> str:
        return repr(self.video) if self.video else f"Film({self.path!r}, {self.frames} frames so far)"

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> dict[str, str]:
        return self.video._repr_mimebundle_() if self.video else {"text/plain": repr(self)}


_films: weakref.WeakSet[Film] = weakref.WeakSet()


def _end() -> None:
    """Films that are not closed keep nothing, and the drawing thread ends while the interpreter still works."""
    _cpp._stop_videos()  # films wait for them
    for film in list(_films):
        film.discard()
    _cpp._end_drawing()
    for film in list(_films):  # that other threads began meanwhile
        film.discard()


atexit.register(_end)
