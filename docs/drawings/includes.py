# SPDX-License-Identifier: Apache-2.0
"""The drawing of who includes whom, from the includes themselves. tests/house checks that the committed one is up to
date, and fails for an arrow that would not point down."""

import sys
from pathlib import Path

from svg import CORAL, GOLD, GRAY, INK, PALE, TEAL, VIOLET, WATER, Drawing

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/house"))
import include_rules  # noqa: E402

LEFT_OUT = {"bench", "tests", "examples"}  # on top of everything

# Folder: (middle, row from the top, width, color, what it is).
PLACES = {
    "python": (1050, 4, 150, GOLD, "the package mercurysim"),
    "app/commands": (690, 0, 210, VIOLET, "view, render, run, new, info, bench"),
    "app/window": (690, 1, 190, VIOLET, "the main loop of the window"),
    "app/window/panels": (690, 2, 190, VIOLET, "what the user reads and changes"),
    "app/window/viewport": (560, 3, 190, VIOLET, "the picture and the mouse on it"),
    "app/window/dialogs": (840, 3, 190, VIOLET, "open, save, export"),
    "app/live": (560, 4, 190, VIOLET, "scene, physics thread, undo"),
    "app/window/toolkit": (840, 4, 190, VIOLET, "ImGui, fonts, widgets"),
    "app/options": (560, 5, 190, VIOLET, "command line and TOML"),
    "app/export": (785, 5, 170, VIOLET, "files of other programs"),
    "app/recording": (470, 6, 170, VIOLET, "HDF5 and repro files"),
    "app/video": (660, 6, 170, VIOLET, "simulate, draw, encode"),
    "app/base": (445, 7, 150, VIOLET, "Ctrl-C, progress, queues"),
    "app/scene": (650, 7, 176, VIOLET, "appearance, arrows, cameras"),
    "sim/cpu": (170, 6, 170, CORAL, "the CPU backend"),
    "sim/cpu/kernels": (101, 7, 126, CORAL, "steps in vectors"),
    "sim/cpu/grouping": (243, 7, 134, CORAL, "lockstep groups"),
    "sim/cpu/layout": (126, 8, 176, CORAL, "slots, tiles, schedules"),
    "sim/cuda": (268, 8, 92, CORAL, "on the chip"),
    "sim": (366, 8, 92, CORAL, "Simulation"),
    "robots": (560, 8, 104, TEAL, "files, generators"),
    "robots/library": (680, 8, 108, TEAL, "sample robots"),
    "evolution": (836, 7, 170, TEAL, "genomes, algorithms, runs"),
    "evolution/api": (836, 8, 170, TEAL, "public headers"),
    "sim/physics": (225, 9, 374, CORAL, "the equations, one source for host and device"),
    "robots/api": (650, 9, 294, TEAL, "public headers: <mercury/voxel.h>, ..."),
    "sim/api": (418, 10, 776, CORAL, "public headers: <mercury/simulation.h>, <mercury/robot.h>, ..."),
    "render": (890, 10, 132, WATER, "OpenGL"),
}
TOP, PITCH, HEIGHT = 40, 82, 48
LOWER = 8  # rows from this one on stand lower, below the names of their regions
GAP = 30


def reduced(arrows):
    """The arrows without those that follow from others: {folder: [folder]}."""
    graph = {}
    for a, b in arrows:
        if a not in LEFT_OUT:
            graph.setdefault(a, set()).add(b)

    def below(folder):
        return {c for b in graph.get(folder, ()) for c in {b} | below(b)}

    return {a: sorted(b for b in others if not any(b in below(c) for c in others)) for a, others in sorted(graph.items())}


def top_of_row(row):
    return TOP + PITCH * row + (GAP if row >= LOWER else 0)


def top_of(folder):
    return top_of_row(PLACES[folder][1])


def spread(wanted, low, high, step=30):
    """The wanted positions {key: x}, kept within low and high and at least `step` apart."""
    keys = sorted(wanted, key=wanted.get)
    step = min(step, (high - low) / max(1, len(keys) - 1))
    at = {}
    for i, key in enumerate(keys):
        lowest = at[keys[i - 1]] + step if i else low
        at[key] = min(max(wanted[key], lowest), high - step * (len(keys) - 1 - i))
    return at


def aim(a, b):
    """Where an arrow from a to b wants to leave: straight down if b is there, otherwise toward its middle."""
    middle, _, width = PLACES[b][:3]
    return PLACES[a][0] if abs(PLACES[a][0] - middle) < width / 2 - 20 else middle


def ports(folder, wanted):
    """Where arrows meet the upper or lower side of a folder's box, each as near as possible to where it wants to."""
    middle, _, width = PLACES[folder][:3]
    return spread(wanted, middle - width / 2 + 20, middle + width / 2 - 20)


def drawing(root=ROOT):
    graph = reduced(include_rules.Tree(root).arrows())
    folders = {*graph, *(b for others in graph.values() for b in others)}
    if folders != set(PLACES):
        raise ValueError(f"docs/drawings/includes.py: give a place to {sorted(folders ^ set(PLACES))}, or remove it")
    d = Drawing(1140, top_of_row(11) - 6)
    for x, row, width, rows, name in [
            (330, 0, 630, 8, "app/"), (24, 6, 296, 4, "sim/"), (24, 8, 400, 2, ""), (470, 8, 340, 2, "robots/")]:
        top = top_of_row(row) - 32
        d.box((x, top), (width, top_of_row(row + rows - 1) + HEIGHT + 14 - top), PALE, "none", 12, 0)
        d.text((x + 14, top + 21), name, 15, GRAY, anchor="start", bold=True)
    d.text((30, 58), "Who includes whom", 22, INK, anchor="start", bold=True)
    d.lines((30, 92), ["An arrow points to the folder that is included.", "All arrows point down, so there is no cycle.",
                       "", "A folder may also include what lies further", "down along its arrows.", "",
                       "sim/api and robots/api are the public headers:", "all that users see, and all that app/ sees of sim/.",
                       "", "bench/ and tests/ may include everything,", "examples/ only the public headers."],
            14, 21, anchor="start", color=INK)

    leaving = {a: ports(a, {b: aim(a, b) for b in others}) for a, others in graph.items()}
    for b in PLACES:
        for a, x in ports(b, {a: leaving[a][b] for a in graph if b in graph[a]}).items():
            if PLACES[a][1] >= PLACES[b][1]:
                raise ValueError(f"docs/drawings/includes.py: the arrow from {a} to {b} does not point down")
            curve(d, (leaving[a][b], top_of(a) + HEIGHT), (x, top_of(b) - 1), PLACES[a][3])
    for folder, (middle, _, width, color, what) in PLACES.items():
        fill = {"sim/api": "#fbece7", "robots/api": "#e4f2f0"}.get(folder, "#ffffff")
        d.box((middle - width / 2, top_of(folder)), (width, HEIGHT), fill, color, 8, 2)
        d.text((middle, top_of(folder) + 20), folder, 15, color, bold=True)
        d.text((middle, top_of(folder) + 38), what, 12, INK)
    return d


def curve(d, a, b, color):
    """An arrow that leaves a downward and enters b from above."""
    bend = 0.5 * (b[1] - a[1])
    d.add(f'<path d="M{a[0]:.1f},{a[1]:.1f} C{a[0]:.1f},{a[1] + bend:.1f} {b[0]:.1f},{b[1] - bend:.1f} '
          f'{b[0]:.1f},{b[1]:.1f}" fill="none" stroke="{color}" stroke-width="1.8" marker-end="url(#{d.head(color)})"/>')


DRAWINGS = {"includes": drawing}
