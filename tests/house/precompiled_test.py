#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Precompiled headers are used at the level of optimization at which they were made: precompiled_test.py BUILD-FOLDER

GCC 13 and newer refuse others, so a build would fail on newer distributions alone.
"""

import json
import re
import sys
from pathlib import Path


def level_of(command):
    """The last -O option, which counts."""
    return (re.findall(r"\s-O(\w*)", command) or [""])[-1]


def main():
    file = Path(sys.argv[1]) / "compile_commands.json"
    if not file.exists():
        return print("skipped: the build keeps no list of its commands")
    commands = [entry["command"] for entry in json.loads(file.read_text())]
    made, used = {}, []
    for command in commands:
        header = re.search(r"\s-include (\S+cmake_pch\.hxx)", command)
        if not header:
            continue
        if "c++-header" in command:
            made[header[1]] = level_of(command)
        else:
            used.append((header[1], level_of(command), command))
    if not used:
        return print("skipped: nothing is precompiled here")
    wrong = [f"-O{made[header]} is used at -O{level}: {command[-150:]}" for header, level, command in used
             if header in made and made[header] != level]
    print("\n".join(wrong[:20]) or f"{len(used)} sources use {len(made)} precompiled headers at their own level")
    sys.exit(1 if wrong or not made else 0)


main()
