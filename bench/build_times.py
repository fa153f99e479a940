#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures what a developer waits for: building from nothing, rebuilding after a change, and the tests.

    bench/build_times.py FOLDER [--only STEP...] [--top N]
    bench/build_times.py --log build/.ninja_log [--top N]

Clones this repository into FOLDER/mercury (which must not exist, or be of an earlier call) and measures there, with the
packages of scripts/setup.sh installed:

    demo    the build of scripts/demo: the program alone      [CPU-minutes, minutes]
    test    the build of scripts/test: all targets            [CPU-minutes, minutes]
    panel   a change in one panel of the window, rebuilt      [s]
    tests   ctest                                             [minutes]

CPU-minutes are the sum of the durations in .ninja_log. They are those of the processors only while no more compilers
run than there are cores, and nothing else does. With --log, the slowest entries of a log and its sums by folder.
"""

import argparse
import collections
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PANEL = "app/window/panels/view_panel.cpp"
JOBS = str(os.cpu_count())


def durations(log):
    """{output: seconds} of the last run of each command in a .ninja_log; a command with several outputs counts once."""
    entries = {}
    for line in log.read_text().splitlines()[1:]:
        start, end, _, output, command = line.split("\t")
        entries[command] = output, (int(end) - int(start)) / 1000
    return dict(entries.values())


def print_log(log, top):
    found = durations(log)
    folders = collections.Counter()
    for output, seconds in found.items():
        folders[output.split("/CMakeFiles/")[0]] += seconds
    print(f"{len(found)} commands, {sum(found.values()) / 60:.1f} CPU-minutes")
    for name, values in (("folder", folders), ("file", found)):
        for key, seconds in sorted(values.items(), key=lambda entry: -entry[1])[:top]:
            print(f"{seconds:8.1f} s  {name} {key}")


class Clone:
    def __init__(self, folder):
        self.folder = folder / "mercury"
        self.build = self.folder / "build"
        if not self.folder.exists():
            subprocess.run(["git", "clone", "-q", str(ROOT), str(self.folder)], check=True)

    def run(self, *command):
        """Seconds that a command takes in the clone."""
        start = time.monotonic()
        result = subprocess.run(command, cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
        if result.returncode:
            sys.exit(f"{' '.join(command)}:\n{(result.stdout + result.stderr)[-4000:]}")
        return time.monotonic() - start

    def configure(self, everything):
        switch = "ON" if everything else "OFF"
        options = [f"-DMERCURY_TESTS={switch}", f"-DMERCURY_BENCH={switch}"]
        if everything:
            python = "build/venv/bin/python"
            self.run("bash", "-c", "source scripts/setup.sh; python_environment")
            options += ["-DMERCURY_PYTHON=ON", f"-DPython_EXECUTABLE={self.folder / python}"]
        self.run("bash", "-c", 'source scripts/setup.sh; configure "$@"', "configure", *options)

    def built(self, everything):
        """(CPU-minutes, minutes) of a build from nothing."""
        self.run("rm", "-rf", "build")
        self.configure(everything)
        seconds = self.run("cmake", "--build", "build", "--parallel", JOBS, "--target", "all" if everything else "mercury")
        return sum(durations(self.build / ".ninja_log").values()) / 60, seconds / 60


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, metavar="FOLDER")
    parser.add_argument("--only", nargs="+", choices=["demo", "test", "panel", "tests"], default=["demo", "test", "panel", "tests"])
    parser.add_argument("--log", type=Path)
    parser.add_argument("--top", type=int, default=15, metavar="N")
    options = parser.parse_args()
    if options.log:
        return print_log(options.log, options.top)
    if not options.folder:
        parser.error("give a folder, or --log")
    options.folder.mkdir(parents=True, exist_ok=True)
    clone = Clone(options.folder.resolve())
    print(f"{JOBS} cores", flush=True)
    for step in ("demo", "test"):
        if step in options.only:
            cpu, wall = clone.built(everything=step == "test")
            print(f"{step:6} {cpu:6.1f} CPU-minutes, {wall:.1f} minutes", flush=True)
    if "panel" in options.only:
        with open(clone.folder / PANEL, "a") as panel:
            panel.write("// A change.\n")
        seconds = clone.run("cmake", "--build", "build", "--parallel", JOBS, "--target", "mercury")
        print(f"panel  {seconds:6.1f} s", flush=True)
    if "tests" in options.only:
        seconds = clone.run("ctest", "--test-dir", "build", "--parallel", JOBS, "--timeout", "900")
        print(f"tests  {seconds / 60:6.1f} minutes", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
