# SPDX-License-Identifier: Apache-2.0
"""Compares Mercury with theory and experiments, and writes docs/validation.md with its plots.

    PYTHONPATH=build/python python3 bench/validation                 all cases, about two minutes on two cores
    PYTHONPATH=build/python python3 bench/validation cantilever rod  these again; the others as recorded
    PYTHONPATH=build/python python3 bench/validation --page          the page and its plots from what is recorded

What the cases found is recorded in bench/validation/results.json. The page is made from it and from the table of cases.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from pathlib import Path

import bodies
import cases  # noqa: F401
import page
from table import CASES, Result

HERE = Path(__file__).resolve().parent
RESULTS, DOCS = HERE / "results.json", HERE.parents[1] / "docs"


def recorded() -> dict[str, Result]:
    data = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    return {name: Result.from_json(data[name]) for name in CASES if name in data}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help=f"{', '.join(CASES)}; default: all")
    parser.add_argument("--page", action="store_true", help="run nothing")
    parser.add_argument("--device", default="cpu", help="as of mercurysim.Batch; what is recorded is of the CPU")
    options = parser.parse_args()
    bodies.DEVICE = options.device
    unknown = [name for name in options.cases if name not in CASES]
    if unknown:
        parser.error(f"{unknown[0]}: no such case; give {', '.join(CASES)}")
    results = recorded()
    begin = time.monotonic()
    for name in [] if options.page else options.cases or CASES:
        start = time.monotonic()
        results[name] = CASES[name].run(False)
        print(f"{name:20} {100 * results[name].worst:8.3f} %  {time.monotonic() - start:6.1f} s", flush=True)
    if not options.page:
        print(f"{time.monotonic() - begin:.0f} s")
    if not options.page and options.device == "cpu":
        lines = [f"{json.dumps(name)}: {json.dumps(result.to_json())}" for name, result in results.items()]
        RESULTS.write_text("{\n" + ",\n".join(lines) + "\n}\n")
    if options.device == "cpu":
        page.write(recorded(), DOCS)
    return 0


if __name__ == "__main__":
    sys.exit(main())
