#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks who includes whom. Prints one line per violation; exit status 1 if there is one.

    include_rules.py [ROOT]

docs/drawings/includes.py draws the arrows that this script finds.
"""

import re
import sys
from dataclasses import dataclass
from pathlib import Path

# The public headers. Everyone includes them as "mercury/x.h", users as <mercury/x.h>.
API = {"sim/api": "sim/include", "robots/api": "robots/include", "evolution/api": "evolution/include"}

# Which folders the files of a folder may include, besides their own. A folder that is not listed belongs to the nearest
# listed folder above it. "*" = all.
ALLOWED = {
    "sim/api": "",
    "sim/physics": "sim/api",
    "sim/cuda": "sim/api sim/physics",
    "sim": "sim/api sim/physics",
    "sim/cpu/layout": "sim/api sim/physics",
    "sim/cpu/kernels": "sim/api sim/physics sim/cpu/layout",
    "sim/cpu/grouping": "sim/api sim/physics sim/cpu/layout",
    "sim/cpu": "sim/api sim/physics sim/cpu/layout sim/cpu/kernels sim/cpu/grouping",
    "robots/api": "sim/api",
    "robots": "sim/api robots/api",
    "robots/library": "sim/api robots/api",
    "evolution/api": "sim/api robots/api",
    "evolution": "sim/api robots/api robots evolution/api",
    "render": "",
    "app/base": "sim/api robots/api",
    "app/recording": "sim/api robots/api robots app/base",
    "app/scene": "sim/api robots/api robots render app/base",
    "app/export": "sim/api robots/api robots render app/base app/recording app/scene",
    "app/video": "sim/api robots/api render app/base app/scene",
    "app/options": "sim/api robots/api evolution/api render app/base app/recording app/scene app/video",
    "app/live": "sim/api robots/api evolution/api robots render app/base app/recording app/scene app/export app/video app/options",
    "app/window/toolkit": "sim/api robots/api render app/base",
    "app/window/dialogs": "sim/api robots/api app/window/toolkit",
    "app/window/viewport": "sim/api robots/api render app/scene app/live app/window/toolkit",
    "app/window/panels": "sim/api robots/api evolution/api app/base app/options app/scene app/export app/live app/window/toolkit app/window/dialogs app/window/viewport",
    "app/window": "sim/api render app/base app/scene app/live app/window/toolkit app/window/viewport app/window/panels",
    "app/commands": "sim/api robots/api evolution/api evolution robots render app/base app/recording app/scene app/export app/video app/options app/window/toolkit app/window",
    "python": "sim/api robots/api evolution/api render app/base app/recording app/scene app/export app/video",
    "bench": "*",
    "tests": "*",
    "examples": "sim/api robots/api evolution/api",
}

# The plain data of sim. It includes only itself, and robots/ includes nothing else of sim: it makes robots and does not
# step them.
PLAIN_DATA = {f"sim/include/mercury/{name}.h" for name in ("brain", "error", "fnv", "host_device", "material", "number_text", "parallel", "parameters", "physics", "robot", "vec3", "voxels", "work_counter", "work_watch")}

# Headers that the build makes.
GENERATED = {"app/base/version.h", "app/commands/command_table.h"}

# Libraries of others, known by their headers, and the top folders that may use each.
SUBJECTS = {
    "OpenGL": (r"(GL|GLES\d?|EGL|KHR|GLFW|epoxy)/|osmesa|imgui", {"render", "app", "bench"}),
    "CUDA-OpenGL interop": (r"cuda_gl_interop|cuda_egl_interop|cudaGL|cudaEGL", {"app"}),
    "CUDA": (r"cuda|cooperative_groups|cub/|thrust/|nvrtc|device_launch", {"sim", "app", "bench"}),
    "files": (r"fstream$|filesystem$|nlohmann/|hdf5|H5|pugixml|zlib|png|toml", {"robots", "evolution", "render", "app", "python", "bench"}),
    "CGAL": (r"CGAL/", {"robots"}),
    "muParser": (r"muParser", {"evolution"}),
}
FREE = {"tests", "examples"}  # top folders that may use any library, and may name neighbors without their folder

# Libraries whose headers cost seconds to compile. A header that another folder includes does not bring them along.
HEAVY = re.compile(r"(Eigen|CLI|GLFW|epoxy)/|nlohmann/json\.hpp|hdf5\.h|H5")
MEASURING = ("tests/", "bench/", "examples/")  # folders that may look inside others

# The only file that may ask whether nvcc is compiling.
CUDACC_HOME = "sim/include/mercury/host_device.h"
# The only file that may include CLI11, which takes seconds to compile.
CLI_HOME = "app/options/command.cpp"

SOURCES = {".h", ".hpp", ".cuh", ".inl", ".cpp", ".cc", ".cu"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
NAMESPACE = re.compile(r"(?:inline )?namespace ([\w:]*)\s*\{")
TYPE = re.compile(r"(?:class|struct|union|enum class) (\w+)(?: final)?(?: : [^{;]*)?\s*\{")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)


@dataclass(frozen=True)
class Include:
    path: str  # of the file, relative to the root
    line: int
    quote: str  # < or "
    header: str  # as written
    target: str  # the file of ours that it names, relative to the root, or ""


def without_comments(text):
    """The text with its comments blanked, lines kept."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match.group()), text)


def folder_of(path):
    """The folder of ALLOWED that a file belongs to."""
    for name, place in API.items():
        if path.startswith(place + "/"):
            return name
    parts = path.split("/")
    for count in range(len(parts) - 1, 0, -1):
        if "/".join(parts[:count]) in ALLOWED:
            return "/".join(parts[:count])
    raise ValueError(f"{path} belongs to no folder")


def resolve(root, path, header):
    """The file of ours that an include names, or ""."""
    if header.startswith("mercury/"):
        for place in API.values():
            if (root / place / header).is_file():
                return f"{place}/{header}"
        return ""
    return header if "/" in header and (root / header).is_file() else ""


class Tree:
    """The sources below a root and their includes."""

    def __init__(self, root):
        self.root = root
        tops = sorted({name.split("/")[0] for name in ALLOWED})
        files = [file for top in tops for file in (root / top).rglob("*") if file.suffix in SOURCES]
        self.texts = {file.relative_to(root).as_posix(): without_comments(file.read_text(encoding="utf-8"))
                      for file in sorted(files)}
        self.includes = [
            Include(path, number, match.group(1), match.group(2), resolve(root, path, match.group(2)))
            for path, text in self.texts.items()
            for number, line in enumerate(text.splitlines(), start=1)
            if (match := INCLUDE.match(line))
        ]
        self.by_path = {}
        for include in self.includes:
            self.by_path.setdefault(include.path, []).append(include)

    def of(self, path):
        """The includes of a file."""
        return self.by_path.get(path, [])

    def arrows(self):
        """{(folder, folder): number of includes} between different folders."""
        found = {}
        for include in self.includes:
            if include.target:
                arrow = folder_of(include.path), folder_of(include.target)
                if arrow[0] != arrow[1]:
                    found[arrow] = found.get(arrow, 0) + 1
        return found

    def heavy_way(self, path, seen):
        """The includes by which a header brings a heavy library along, or None."""
        for include in self.of(path):
            if not include.target and HEAVY.match(include.header):
                return [include.header]
            if include.target and include.target not in seen:
                seen.add(include.target)
                way = self.heavy_way(include.target, seen)
                if way:
                    return [include.target, *way]
        return None

    def heavy_headers(self):
        """(path, line, what is wrong) of each header that other folders include with a heavy library in it."""
        reported = set()
        for include in self.includes:
            crosses = include.target and folder_of(include.path) != folder_of(include.target)
            if not crosses or include.path.startswith(MEASURING) or include.target in reported:
                continue
            way = self.heavy_way(include.target, {include.target})
            if way:
                reported.add(include.target)
                yield include.target, 1, f"{include.path} gets {' > '.join(way)} through it: hide the library in a source"

    def types_defined_twice(self):
        """(path, line, what is wrong) of each type of a header that another header defines, too: where both are linked, one
        takes the other's functions."""
        first = {}
        for path, text in self.texts.items():
            if not path.endswith((".h", ".cuh")):
                continue
            spaces, depth = [], 0  # (name, depth of braces around it)
            for number, line in enumerate(text.splitlines(), start=1):
                if match := NAMESPACE.match(line):
                    spaces.append((match.group(1), depth))
                elif match := TYPE.match(line):
                    name = "::".join([*(space for space, _ in spaces), match.group(1)])
                    other = first.setdefault(name, path)
                    if other != path:
                        yield path, number, f"{other} defines {name}, too"
                depth += line.count("{") - line.count("}")
                while spaces and depth <= spaces[-1][1]:
                    spaces.pop()

    def problems(self):
        """(path, line, what is wrong)."""
        for include in self.includes:
            for problem in problems_of(self.root, include):
                yield include.path, include.line, problem
        for path, text in self.texts.items():
            for number, line in enumerate(text.splitlines(), start=1):
                if "__CUDACC__" in line and path != CUDACC_HOME:
                    yield path, number, f"only {CUDACC_HOME} asks for __CUDACC__"
        yield from self.heavy_headers()
        yield from self.types_defined_twice()
        graph = {}
        for include in self.includes:
            graph.setdefault(include.path, []).append(include.target)
        cycle = cycle_in(graph)
        if cycle:
            yield cycle[0], 1, "includes itself: " + " -> ".join(cycle)


def problems_of(root, include):
    """What is wrong with one include."""
    path, header, target = include.path, include.header, include.target
    folder, top = folder_of(path), path.split("/")[0]
    if target:
        other = folder_of(target)
        if other != folder and other not in ALLOWED[folder].split() and ALLOWED[folder] != "*":
            yield f"{folder}/ may not include {other}/ ({header})"
        elif top == "robots" and other == "sim/api" and target not in PLAIN_DATA:
            yield f"robots/ may include only the plain data of sim/, not {header}"
        elif path in PLAIN_DATA and target not in PLAIN_DATA:
            yield f"plain data may include only plain data, not {header}"
        return
    if header in GENERATED:
        return
    if header.split("/")[0] in {"mercury", *(name.split("/")[0] for name in ALLOWED)}:
        yield f"there is no {header}"
        return
    if top in FREE:
        return
    if header.startswith("..") or include.quote == '"' and ((root / path).parent / header).exists():
        yield f"name the header from the root: {header}"
        return
    if header.startswith("CLI/") and path != CLI_HOME:
        yield f"only {CLI_HOME} includes CLI11"
    for subject, (pattern, users) in SUBJECTS.items():
        if re.match(pattern, header):
            if top not in users:
                yield f"{top}/ may not use {subject} ({header})"
            return


def cycle_in(graph):
    """A cycle of {node: [node]}, its first node repeated at the end, or None."""
    state = {}  # absent = not seen, False = on the current path, True = done

    def visit(node, path):
        if state.get(node) is False:
            return path[path.index(node):] + [node]
        if node in state:
            return None
        state[node] = False
        for other in graph.get(node, []):
            cycle = visit(other, path + [node])
            if cycle:
                return cycle
        state[node] = True
        return None

    return next((cycle for node in list(graph) if (cycle := visit(node, []))), None)


def check_table(allowed):
    """What is wrong with a table of allowed arrows."""
    graph = {folder: [] if others == "*" else others.split() for folder, others in allowed.items()}
    for folder, others in graph.items():
        for other in others:
            if other not in allowed:
                yield f"{folder}/ may include {other}/, which is not listed"
    cycle = cycle_in(graph)
    if cycle:
        yield "the allowed arrows have a cycle: " + " -> ".join(cycle)


def check(root):
    """(number of files read, one line per violation)."""
    tree = Tree(root)
    problems = [f"{path}:{line}: {what}" for path, line, what in tree.problems()]
    return len(tree.texts), list(check_table(ALLOWED)) + problems


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
