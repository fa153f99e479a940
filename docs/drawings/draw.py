#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the drawings of docs/ into docs/pictures. Needs nothing but Python.

    docs/drawings/draw.py [FOLDER]
"""

import sys
from pathlib import Path

import includes
import physics
import program

DRAWINGS = {**includes.DRAWINGS, **physics.DRAWINGS, **program.DRAWINGS}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "pictures"
    for name, draw in DRAWINGS.items():
        (folder / f"{name}.svg").write_text(draw().document(), encoding="utf-8")


if __name__ == "__main__":
    main()
