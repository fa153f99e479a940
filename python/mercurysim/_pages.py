# SPDX-License-Identifier: Apache-2.0
"""Web pages that play robots, in notebooks and in a browser."""

from __future__ import annotations

import html
import os
import tempfile
import webbrowser
from pathlib import Path
from typing import Any, Sequence

from . import _mercury
from ._mercury import Batch, Environment, InputError, Recording, Result, Robot

_cpp: Any = _mercury

_largest_inline = 16 << 20  # bytes; larger pages would make notebooks unusable
_inline_seconds = 4.0  # of a robot that a notebook shows by itself


class Page:
    """A web page that plays robots: one file, which needs no network. Notebooks show it inline."""

    def __init__(self, text: str, height: int = 480):
        self.text = text
        self.height = height  # in a notebook [pixels]

    def __repr__(self) -> str:
        return f"Page({len(self.text.encode()) / 1e6:.2f} MB)"

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page as a file."""
        Path(path).write_text(self.text, encoding="utf-8")

    def open(self) -> None:
        """Shows the page in the browser of this machine."""
        with tempfile.NamedTemporaryFile("w", suffix=".html", delete=False, encoding="utf-8") as file:
            file.write(self.text)
        webbrowser.open(Path(file.name).as_uri())

    def _repr_html_(self) -> str:
        if len(self.text) > _largest_inline:
            return f"<code>{html.escape(repr(self))}</code>: too large to be shown here; save() it"
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" style="width: 100%; height: {self.height}px; border: 0; '
            'border-radius: 8px" allow="fullscreen; clipboard-write"></iframe>'
        )


def show(
    what: Robot | Batch | Recording | Result | Sequence[Robot] | Sequence[Result],
    *,
    seconds: float | None = None,
    environment: Environment | str | None = None,
    height: int = 480,
) -> Page:
    """Plays robots, a batch, a recording or results in a web page, which a notebook shows; save() and open() it elsewhere.

    Robots are simulated for `seconds` (default 10) in `environment`, or in the one that they are made for. A batch goes
    on from where it is, for the page alone. A Result of evaluate() is tried again, exactly as it was. `height` is that of the page in a notebook [pixels].

    Raises InputError for what cannot be used.
    """
    if not height > 0:
        raise InputError(f"height: {height} is not accepted; give a whole number > 0")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "page.html"
        _cpp.export(what, path, seconds=seconds, environment=environment)
        return Page(path.read_text(encoding="utf-8"), height)


def _robot_html(robot: Robot) -> str | None:
    try:
        return show(robot, seconds=_inline_seconds, height=360)._repr_html_()
    except InputError:  # it has no skin
        return None


def _motion_html(what: Recording | Result) -> str | None:
    try:
        return show(what)._repr_html_()
    except InputError:
        return None


if isinstance(Recording, type):  # else this build exports nothing
    setattr(Robot, "_repr_html_", _robot_html)
    setattr(Recording, "_repr_html_", _motion_html)
    setattr(Result, "_repr_html_", _motion_html)
