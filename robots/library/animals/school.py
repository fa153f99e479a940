# SPDX-License-Identifier: Apache-2.0
"""Writes a school of one sample, side by side, for a picture in which all of them have one target.

    python3 robots/library/animals/school.py hunter 3x5 hunters
    mercury render hunters --grid 3x5 --camera top --target 6,4,0 -o school.mp4

A grid of `render` puts each robot into the middle of its cell. Here it is there already, so all keep their coordinates, and the target
is at the same place for all.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

LIBRARY = Path(__file__).resolve().parents[1]
SPACING = 1.45  # size of a cell of the grid per size of the robot


def main() -> None:
    if len(sys.argv) != 4:
        sys.exit(str(__doc__))
    robot = json.loads((LIBRARY / f"{sys.argv[1]}.json").read_text())
    columns, rows = (int(number) for number in sys.argv[2].split("x"))
    folder = Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    masses = robot["masses"]
    low, high = ([end(axis) for axis in zip(*masses)] for end in (min, max))
    for i in range(columns * rows):
        cell = (i % columns - (columns - 1) / 2, (rows - 1) / 2 - i // columns, 0)
        by = [SPACING * c * (b - a) - (a + b) / 2 for c, a, b in zip(cell, low, high)]
        robot["masses"] = [[x + d for x, d in zip(mass, by)] for mass in masses]
        (folder / f"{i:02}.json").write_text(json.dumps(robot) + "\n")


if __name__ == "__main__":
    main()
