#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the rules of who may include whom. Prints one line a violation; exit status 1 if there is one.

    include_rules.py [ROOT]
"""

import re
import sys
from pathlib import Path

# The folders of ours that each folder may include, besides itself. "sim/api" and "robots/api" are the public headers,
# which users include as <mercury/...>. A folder that is not listed goes with the nearest listed folder above it.
API = {"sim/api": "sim/include", "robots/api": "robots/include"}
ALLOWED = {
    "sim/api": "",
    "sim/physics": "sim/api",
    "sim": "sim/api sim/physics",
    "sim/cpu": "sim/api sim/physics sim",
    "sim/cuda": "sim/api sim/physics sim",
    "robots/api": "sim/api",
    "robots": "sim/api robots/api",
    "robots/library": "sim/api robots/api",
    "render": "",
    "app/base": "sim/api",
    "app/recording": "sim/api robots/api robots app/base",
    "app/scene": "sim/api robots/api robots render app/base",
    "app/video": "sim/api render app/base app/scene",
    "app/options": "sim/api robots/api render app/base app/recording app/scene app/video",
    "app/live": "sim/api robots/api robots render app/base app/recording app/scene app/video app/options",
    "app/window/toolkit": "sim/api robots/api render",
    "app/window/dialogs": "app/window/toolkit",
    "app/window/viewport": "sim/api robots/api render app/scene app/live app/window/toolkit",
    "app/window/panels": "sim/api robots/api render app/scene app/live app/window/toolkit app/window/dialogs app/window/viewport",
    "app/window": "sim/api render app/base app/scene app/live app/window/toolkit app/window/viewport app/window/panels",
    "app/commands": "sim/api robots/api robots render app/base app/recording app/video app/options app/window/toolkit app/window",
    "bench": "*",
    "tests": "*",
    "examples": "sim/api robots/api",
}

# What robots/ may know of sim/: plain data, no stepping. These headers include only one another.
PLAIN_DATA = {f"sim/{name}.h" for name in ("error", "host_device", "material", "robot", "vec3")}

# Subjects of others' libraries, known by their headers, and the folders that may know each.
SUBJECTS = {
    "OpenGL": (r"(GL|GLES\d?|EGL|KHR|GLFW|epoxy)/|osmesa|imgui", {"render", "app", "bench"}),
    "CUDA-OpenGL interop": (r"cuda_gl_interop|cuda_egl_interop|cudaGL|cudaEGL", {"app"}),
    "CUDA": (r"cuda|cooperative_groups|cub/|thrust/|nvrtc|device_launch", {"sim", "app", "bench"}),
    "files": (r"fstream$|filesystem$|nlohmann/|hdf5|H5|pugixml|png|toml", {"robots", "render", "app", "bench"}),
    "CGAL": (r"CGAL/", {"robots"}),
}
FREE = {"tests", "examples"}  # folders that may include any library

# Who may ask whether nvcc is compiling.
CUDACC_HOME = "mercury/host_device.h"

SOURCES = {".h", ".hpp", ".cuh", ".inl", ".cpp", ".cc", ".cu"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


def without_comments(text):
    """The text with its comments blanked, lines kept."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def violations_of_include(path, folder, quote, header, root):
    """What is wrong with `path` (relative to root) including `header`; quote is < or "."""
    top = header.split("/")[0]
    if "/" in header and top in OURS:
        if top not in OURS[folder]:
            yield f"{folder}/ may not include {top}/ ({header})"
        elif folder == "robots" and top == "sim" and header not in PLAIN_DATA:
            yield f"robots/ may include only the plain data of sim/, not {header}"
        elif path in PLAIN_DATA and header not in PLAIN_DATA:
            yield f"plain data may include only plain data, not {header}"
        return
    if folder in FREE:
        return
    if header.startswith("..") or quote == '"' and ((root / path).parent / header).exists():
        yield f"name the header from the root: {header}"
        return
    for subject, (pattern, allowed) in SUBJECTS.items():
        if re.match(pattern, header):
            if folder not in allowed:
                yield f"{folder}/ may not know {subject} ({header})"
            return


def violations_of_file(root, path):
    """(line, what is wrong) of one source file."""
    folder = path.split("/")[0]
    text = without_comments((root / path).read_text(encoding="utf-8"))
    for number, line in enumerate(text.splitlines(), start=1):
        include = INCLUDE.match(line)
        if include:
            for problem in violations_of_include(path, folder, *include.groups(), root):
                yield number, problem
        if "__CUDACC__" in line and path != CUDACC_HOME:
            yield number, f"only {CUDACC_HOME} asks for __CUDACC__"


def check(root):
    """(number of files read, one line a violation)."""
    files = sorted(
        file.relative_to(root).as_posix()
        for folder in OURS
        for file in (root / folder).rglob("*")
        if file.suffix in SOURCES
    )
    return len(files), [f"{path}:{line}: {what}" for path in files for line, what in violations_of_file(root, path)]


def main():
    root = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parents[2]
    count, problems = check(root)
    for problem in problems:
        print(problem)
    if count == 0:
        print(f"{root}: no source files")
    return 1 if problems or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
