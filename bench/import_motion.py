#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How far imported robots get in Mercury and in the programs that they come from: the tables of docs/import.md.

    python3 bench/import_motion.py --evosoro DIRECTORY --evogym DIRECTORY

of clones of skriegman/evosoro and EvolutionGym/evogym, built before (README of each). Of evosoro this is
`evosoro/_voxcad_land_water/voxelyzeMain/voxelyze`; of EvoGym its module `evogym.simulator_cpp`, or --evogym-module DIRECTORY with
a `simulator_cpp` where it is not installed. Each robot moves its muscles for 5 s of its program's time, three times there, with densities
(evosoro) or amplitudes (EvoGym) of 99, 100 and 101 %, and in five trials with jitter here.

The second table has evosoro's robots on land of `sample_vxa`, put into water in both programs.

The third has robots of EvoGym's own sampler: the first five, by seed, that get at least a voxel far there in runs that
agree within half of that way. The rule was written down before any of them was simulated (docs/experiments.md).
"""

from __future__ import annotations

import argparse
import importlib
import importlib.util
import itertools
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

SECONDS = 5
ROOT = Path(__file__).resolve().parents[1]
EVOSORO = [
    *(f"_voxcad_land_water/sample_vxa/{name}.vxa" for name in (
        "hexapus", "flapping_passive_tissue", "quadrupus_passive_tissue", "full_cross",
        "hopper", "pusher_land", "quadruped_land", "land_stiffness_phaseoffset")),
    "_voxcad/voxelyzeMain/Example_withPhaseOffset.vxa",
]  # fmt: skip
EVOGYM = ["examples/world_data/speed_bot.json", "examples/world_data/carry_bot.json",
          "tutorials/world_data/simple_environment_with_robot.json"]  # fmt: skip
DEPTH = 3  # voxels across the plane, so that flat robots do not tip over
# The default muscles of the importer: one wave along the robot, 1 Hz at 3.35 times the time of EvoGym.
AMPLITUDE, TIME = 0.4, math.sqrt(110 / 9.81)
STEP = 30 * 1e-4  # of EvoGym's Sim.step() [s]
SAMPLED, SAMPLED_SHAPE, SHORTEST_WAY = 5, (5, 5), 0.1  # robots of the sampler, voxels, [m]

Way = tuple[float, ...]  # of the center of mass [m of the file]


def length(way: Way) -> float:
    return math.hypot(*way)


def middle(ways: list[Way]) -> Way:
    return sorted(ways, key=length)[len(ways) // 2]


def largest_difference(ways: list[Way]) -> float:
    return max(math.dist(a, b) for a, b in itertools.combinations(ways, 2))


def has_direction(ways: list[Way]) -> bool:
    return largest_difference(ways) <= length(middle(ways)) / 2


def evosoro_ways(program: Path, file: Path) -> list[Way]:
    text = file.read_text(encoding="latin-1")

    def number(name: str) -> float:
        found = re.search(rf"<{name}>([^<]*)</{name}>", text)
        return float(found[1]) if found else 0

    def changed(name: str, value: Any) -> str:
        return re.sub(rf"<{name}>[^<]*</{name}>", f"<{name}>{value}</{name}>", text)

    original, ways = text, []
    for share in (0.99, 1, 1.01):
        with tempfile.TemporaryDirectory() as folder:
            text = re.sub(r"<Density>([^<]*)<", lambda found: f"<Density>{share * float(found[1]):.9g}<", original)
            # Muscles rest until InitCmTime, and the way that the program writes begins there.
            text = changed("StopConditionType", 2)
            text = changed("StopConditionValue", number("InitCmTime") + SECONDS)
            text = changed("FitnessFileName", "result.xml")
            (Path(folder) / "robot.vxa").write_text(text, encoding="latin-1")
            subprocess.run([program.resolve(), "-f", "robot.vxa"], cwd=folder, check=False, capture_output=True)
            text = (Path(folder) / "result.xml").read_text()
            x, y, z = (number(f"normDist{axis}") for axis in "XYZ")
            text = original
            edge = number("Lattice_Dim")
            ways.append((edge * x, edge * y, edge * z) if number("FluidEnvironment") else (edge * x, edge * y))
    return ways


def rows_in_water(program: Path, folder: Path) -> Iterator[str]:
    for file in sorted(folder.glob("*.vxa")):
        text = file.read_text(encoding="latin-1")
        if "<FluidEnvironment>0<" not in text:
            continue
        with tempfile.TemporaryDirectory() as changed:
            swimmer = Path(changed) / file.name
            swimmer.write_text(text.replace("<FluidEnvironment>0<", "<FluidEnvironment>1<"), encoding="latin-1")
            yield row(f"{file.stem}, in water", evosoro_ways(program, swimmer), *mercury_way(swimmer))


def evogym_body(file: Path) -> Any:
    """Types of the voxels of the robot in a world, the upper row first."""
    import numpy as np

    world = json.loads(file.read_text())
    width = world["grid_width"]
    [robot] = [thing for thing in world["objects"].values() if {3, 4} & set(thing["types"])]
    cells = {divmod(index, width): kind for index, kind in zip(robot["indices"], robot["types"]) if kind}
    rows, columns = [row for row, _ in cells], [column for _, column in cells]
    return np.array([[cells.get((row, column), 0) for column in range(min(columns), max(columns) + 1)]
                     for row in range(max(rows), min(rows) - 1, -1)], float)  # fmt: skip


def connections(body: Any) -> Any:
    """Pairs of voxels that share a side, of shape (2, n)."""
    import numpy as np

    height, width = body.shape
    pairs = [(y * width + x, (y + down) * width + x + right) for y in range(height) for x in range(width)
             for down, right in ((0, 1), (1, 0))
             if y + down < height and x + right < width and body[y, x] and body[y + down, x + right]]  # fmt: skip
    return np.array(pairs, float).reshape(-1, 2).T


def evogym_ways(simulator: Any, body: Any) -> list[Way]:
    import numpy as np

    width = body.shape[1]
    ways = []
    for share in (0.99, 1, 1.01):
        sim = simulator.Sim()
        sim.init(200, 40)
        sim.read_robot_from_array(body, connections(body), "robot", 100, 0)
        actuators = [int(i) for i in np.ravel(sim.get_indices_of_actuators("robot"))]

        def center() -> Any:
            return np.array(sim.object_pos_at_time(sim.get_time(), "robot")).mean(axis=1)

        start = center()
        for step in range(round(SECONDS / STEP)):
            angle = 2 * math.pi * TIME * step * STEP
            sim.set_action("robot", np.array([[i, 1 + share * AMPLITUDE * math.sin(angle + 2 * math.pi * (i % width) / width)]
                                              for i in actuators]))  # fmt: skip
            sim.step()
        ways.append((float(center()[0] - start[0]), 0.0))
    return ways


def sampled_bodies(evogym: Path) -> Iterator[tuple[int, Any]]:
    """The robots of EvoGym's sampler by their seed, without the empty rows and columns around them."""
    import numpy as np

    # The file alone, since the package `evogym` needs its simulator installed.
    spec = importlib.util.spec_from_file_location("evogym_utils", evogym / "evogym" / "utils.py")
    assert spec and spec.loader
    sampler = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sampler)
    for seed in itertools.count():
        random.seed(seed)
        body, _ = sampler.sample_robot(SAMPLED_SHAPE)
        used = np.argwhere(body)
        (top, left), (bottom, right) = used.min(axis=0), used.max(axis=0)
        yield seed, body[top : bottom + 1, left : right + 1]


def sampled_rows(evogym: Path, simulator: Any) -> Iterator[str]:
    import numpy as np

    taken = 0
    for seed, body in sampled_bodies(evogym):
        there = evogym_ways(simulator, body)
        # Written so that ways that are no numbers are not taken.
        if not (length(middle(there)) >= SHORTEST_WAY and has_direction(there)):
            print(f"sampled robot {seed}: not taken, ways there {[round(x, 3) for x, _ in there]} m", file=sys.stderr)
            continue
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / f"sampled_{seed}.npz"
            np.savez(file, body, connections(body))
            yield row(f"sampled robot {seed}", there, *mercury_way(file, "--depth", DEPTH))
        taken += 1
        if taken == SAMPLED:
            return


def mercury(*arguments: Any) -> str:
    program = os.environ.get("MERCURY_PROGRAM", str(ROOT / "build" / "bin" / "mercury"))
    return subprocess.run([program, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def mercury_way(file: Path, *options: Any) -> tuple[Way, float, float]:
    """The way of the median trial, the distance between quartiles [m of the file], and dt [s of the file]."""
    with tempfile.TemporaryDirectory() as folder:
        mercury("import", file, "-o", folder, "--brief", *options)
        world = Path(folder) / f"{file.stem}.toml"
        text = world.read_text()
        scale = re.findall(r"of the file is ([\d.]+) m here", text)
        edge = float(scale[0]) if scale else 1
        [time] = map(float, re.findall(r"1 s is ([\d.]+) s", text))
        [dt] = map(float, re.findall(r"^dt = (\S+)", text, re.MULTILINE))
        [robot] = json.loads(mercury("run", world.with_suffix(".json"), "--config", world, "--seconds", SECONDS * time, "--settle", 0,
                                     "--trials", 5, "--jitter", 1e-3, "--device", "cpu", "--json", "--quiet"))["robots"]  # fmt: skip
        in_water = "environment = \"resistive\"" in text
        way = tuple((robot[f"end_{axis}"] - robot[f"start_{axis}"]) / edge for axis in ("xyz" if in_water else "xy"))
        return way, (robot["upper_quartile"] - robot["lower_quartile"]) / edge, dt / time


def row(name: str, there: list[Way], here: Way, spread: float, dt: float) -> str:
    way = middle(there)
    along = sum(a * b for a, b in zip(way, here)) / (length(way) * length(here))
    share = length(here) / length(way)
    turn = math.degrees(math.acos(max(-1, min(1, along))))
    verdict = "holds" if turn < 45 and abs(share - 1) <= 0.3 else "**fails**"
    if not has_direction(there):
        verdict = "no direction there: not counted"
    return (f"| {name} | {length(way):.3f} | {largest_difference(there):.3f} | {length(here):.3f} | {spread:.3f} | {1e6 * dt:.0f} | "
            f"{100 * share:.0f} % | {turn:.0f}\N{DEGREE SIGN} | {verdict} |")  # fmt: skip


HEADING = """| robot | there [m] | spread | here [m] | spread | dt [us] | share | angle between | |
|---|---|---|---|---|---|---|---|---|"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--evosoro", type=Path)
    parser.add_argument("--evogym", type=Path)
    parser.add_argument("--evogym-module", type=Path)
    options = parser.parse_args()
    print(HEADING)
    land_water = options.evosoro / "evosoro" / "_voxcad_land_water" if options.evosoro else Path()
    program = land_water / "voxelyzeMain" / "voxelyze"
    for name in EVOSORO if options.evosoro else []:
        file = options.evosoro / "evosoro" / name
        print(row(file.stem, evosoro_ways(program, file), *mercury_way(file)), flush=True)
    if options.evogym:
        if options.evogym_module:
            sys.path.insert(0, str(options.evogym_module))
        simulator = importlib.import_module("evogym.simulator_cpp" if not options.evogym_module else "simulator_cpp")
        for name in EVOGYM:
            file = options.evogym / name
            print(row(file.stem, evogym_ways(simulator, evogym_body(file)), *mercury_way(file, "--depth", DEPTH)), flush=True)
    if options.evosoro:
        print(f"\n{HEADING}")
        for line in rows_in_water(program, land_water / "sample_vxa"):
            print(line, flush=True)
    if options.evogym:
        print(f"\n{HEADING}")
        for line in sampled_rows(options.evogym, simulator):
            print(line, flush=True)


if __name__ == "__main__":
    main()
