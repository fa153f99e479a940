# SPDX-License-Identifier: Apache-2.0
"""Writes the sample animals that no generator makes.

    PYTHONPATH=build/python python3 robots/library/animals robots/library [NAME ...]
"""

from __future__ import annotations

import argparse
from pathlib import Path

from animals import ANIMALS
from mesh import save


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"{', '.join(ANIMALS)}; default: all")
    options = parser.parse_args()
    unknown = [name for name in options.names if name not in ANIMALS]
    if unknown:
        parser.error(f"{unknown[0]}: no such animal; give {', '.join(ANIMALS)}")
    for name in options.names or ANIMALS:
        save(options.folder, ANIMALS[name]())


if __name__ == "__main__":
    main()
