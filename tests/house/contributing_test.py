#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The worked examples of CONTRIBUTING.md work: their changes are made in a copy of the sources, what changed is compiled, and
what they add is run.

    contributing_test.py BUILD        a build with Ninja, without sanitizers
    contributing_test.py BUILD COPY   makes the copy in the folder COPY and leaves it there

The copy is always in the same folder, so that a compiler cache that the build uses knows what did not change.

Generators, importers, quantities, panels and commands are linked with the libraries of the build into a program. Parameters
and environments change headers that everything includes: what a Simulation needs is compiled from scratch without
optimization, for one kernel alone, and of the rest the sources that read the tables are checked.
"""

import itertools
import json
import platform
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KERNEL = {"x86_64": "ssse3", "aarch64": "neon"}.get(platform.machine(), "portable")
EXAMPLE = re.compile(r"^`(\S+)`(?: \(new\))?:\n\n```(diff|cpp)\n(.*?)^```$", re.M | re.S)

# Starts the program, or lists the panels of its window.
PROGRAM = """
#include <cstdio>
#include <string>
#include <vector>
#include "app/commands/program.h"
#include "app/window/panels/panel.h"
int main(int count, char** words) {
  if (count == 1) for (const auto& panel : mercury::window::panel_table()) std::puts(panel.title);
  return count == 1 ? 0 : mercury::run_program(std::vector<std::string>(words + 1, words + count));
}
"""

# What theory says of the parameter and of the environments.
SIMULATION = """
#include <cmath>
#include <cstdio>
#include "mercury/observables.h"
#include "mercury/simulation.h"
#include "sim/cpu/kernels/kernel.h"
namespace mercury::cpu {
std::span<const Kernel> kernels() { return {&KERNEL_kernel, 1}; }  // the others are compiled as this one is
}
using namespace mercury;
bool failed = false;
void expect(const char* what, double value, double expected) {
  const bool good = std::fabs(value - expected) < 1e-3 * std::fabs(expected);
  std::printf("%s: %g, expected %g%s\\n", what, value, expected, good ? "" : ": WRONG");
  failed |= !good;
}
int main() {
  const Robot robot{.name = "pair",
                    .masses = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
                    .springs = {{0, 1, 21, 1}},
                    .faces = {{0, 1, 2}}};
  const auto drag = [&](float salinity) {
    return length(face_force(Environment{.water = FaceDrag{.salinity = salinity}}, robot.faces[0], robot.masses,
                             std::vector<Vec3>(3, {0, 0, 1})).drag);
  };
  expect("drag in salt water", drag(35) / drag(0), 1 + 7.6e-4 * 35);
  const auto velocity = [&](const char* environment) {
    Simulation simulation({.damping = 0, .environment = environment_named(environment)}, {&robot, 1});
    simulation.set_state(0, robot.masses, std::vector<Vec3>(3, {0, 1, 0}));
    simulation.step(100);
    return simulation.state(0).velocities[2];
  };
  expect("speed in syrup after 0.1 s", velocity("syrup").y, std::pow(1 - 5 * 1e-3, 100));
  const Environment floor = environment_named("sea-floor");
  expect("the sea floor has its name", name_of(floor) == "sea-floor", 1);
  expect("the sea floor has contacts and ground", has_contacts(floor) && has_ground(floor), 1);
  expect("falling speed above the sea floor", velocity("sea-floor").z < 0, 1);
  return failed;
}
"""

# The table of an algorithm's parameters.
TABLE = """
#include <cstdio>
#include "mercury/algorithm.h"
int main() {
  std::apply([](const auto&... parameter) { (std::printf("%s ", std::string(parameter.name).c_str()), ...); },
             mercury::AlgorithmSettings::parameters);
}
"""


def examples(text):
    """{heading: [(path, kind, lines)]} of the blocks that name a file."""
    found = {}
    for section in re.split(r"^## ", text, flags=re.M)[1:]:
        blocks = [(path, kind, body.splitlines()) for path, kind, body in EXAMPLE.findall(section)]
        if blocks:
            found[section.split("\n", 1)[0]] = blocks
    return found


def applied(text, lines, path):
    """The text with a block of diff: its parts, between lines @@, are looked for in their order."""
    begin = 0
    for part in "\n".join(lines).split("\n@@\n"):
        part = part.split("\n")
        bad = [line for line in part if line[:1] not in ("", " ", "+", "-")]
        assert not bad, f"CONTRIBUTING.md: {path}: a line of a diff begins with a blank, + or -: {bad[0]}"
        old = "".join(line[1:] + "\n" for line in part if not line.startswith("+"))
        new = "".join(line[1:] + "\n" for line in part if not line.startswith("-"))
        place = ("\n" + text).find("\n" + old, begin)
        assert place >= 0, f"CONTRIBUTING.md: {path} has no such lines (any more):\n{old}"
        text = text[:place] + new + text[place + len(old):]
        begin = place + len(new)
    return text


class Copy:
    """The sources, changed, with the commands of the build."""

    def __init__(self, build, folder, found):
        self.build, self.folder, self.objects = build, folder, folder / "objects"
        self.found, self.changed = found, set()  # the examples, those whose changes are made
        only_sources = lambda at, names: [name for name in names if not (Path(at) / name).is_dir()
                                          and Path(name).suffix not in (".h", ".cpp")]
        for part in ("sim", "robots", "evolution", "render", "app"):
            shutil.copytree(ROOT / part, folder / part, ignore=only_sources)
        self.objects.mkdir()
        self.commands = json.loads((build / "compile_commands.json").read_text())
        launcher = re.search(r"^CMAKE_CXX_COMPILER_LAUNCHER:\w+=(.+)", (build / "CMakeCache.txt").read_text(), re.M)
        self.launcher = launcher[1].split(";") if launcher else []

    def change(self, example):
        """Makes the changes of an example; its sources."""
        self.changed.add(example)
        blocks = self.found[example]
        for path, kind, lines in blocks:
            file = self.folder / path
            assert file.exists() == (kind == "diff"), f"CONTRIBUTING.md: {path}: a diff is for files that exist, cpp for others"
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(applied(file.read_text(), lines, path) if kind == "diff" else "\n".join(lines) + "\n")
        return [path for path, _, _ in blocks if path.endswith(".cpp")]

    def flags(self, target):
        """How sources of a target are compiled, with the headers of the copy. -O1 is what precompiled headers allow at least."""
        of_target = [command for command in self.commands if f"/mercury_{target}.dir/" in command["command"]]
        assert of_target, f"{self.build}: no target mercury_{target}"
        words = shlex.split(of_target[0]["command"])
        words = words[:words.index("-o")]
        own = lambda word: word.startswith(f"-I{ROOT}") and not word.startswith(f"-I{self.build}")
        words = [word.replace(str(ROOT), str(self.folder)) if own(word) else word for word in words] + ["-O1"]
        return [words[0], f"-I{self.folder}", *words[1:]]  # before what the build made

    def compile(self, sources, flags):
        """Objects of sources of the copy."""
        memory = ["--param", "ggc-min-expand=1000", "--param", "ggc-min-heapsize=500000"]  # kB that the compiler takes at once
        made = []
        for source in sources:
            made.append(self.objects / (source.replace("/", "_") + ".o"))
            run([*self.launcher, *flags, *memory, "-o", made[-1], "-c", self.folder / source], self.build)
        return made

    def program(self, objects, source):
        """The program mercury with these objects before those of the libraries, and a main function of its own."""
        (self.folder / "main.cpp").write_text(source)
        own = self.compile(["main.cpp"], self.flags("app_window_panels"))
        link = subprocess.run(["ninja", "-C", self.build, "-t", "commands", "-s", "bin/mercury"], check=True,
                              stdout=subprocess.PIPE, text=True).stdout.splitlines()[-1]
        words = shlex.split(link.split("&&")[1])
        words[words.index("-o") + 1] = str(self.folder / "mercury")
        place = next(i for i, word in enumerate(words) if word.endswith(".o"))  # of main.cpp
        # Objects of several sources define some functions once more; the first definition counts.
        words[place:place + 1] = ["-Wl,-z,muldefs", *own, *objects]
        run(words, self.build)
        return self.folder / "mercury"


def run(words, folder):
    done = subprocess.run(list(map(str, words)), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, f"{shlex.join(map(str, words))}\n{done.stdout}"
    return done.stdout


def expect(text, *parts):
    for part in parts:
        assert part in text, f'"{part}" is missing in: {text}'


def test_what_is_added(copy):
    """Color quantity, generator, genome, importer, panel, command."""
    targets = {"app/scene": "app_scene", "app/commands": "app_commands", "app/window/panels": "app_window_panels",
               "robots/importers": "importers", "robots/bar": "robots", "robots": "robots"}
    sources = []
    for heading in ("A color quantity", "A generator of robots", "A genome", "An importer", "A panel of the window",
                    "A command"):
        sources += [source for source in copy.change(heading) if source not in sources]
    run(["cmake", f"-DFOLDER={copy.folder}/app/commands", f"-DOUTPUT={copy.folder}/app/commands/command_table.h", "-P",
         ROOT / "cmake/CommandTable.cmake"], copy.folder)
    sources.append("app/commands/program.cpp")
    # Sources of a target together, as the build compiles them.
    objects = []
    for target in sorted({targets[str(Path(source).parent)] for source in sources}):
        together = [source for source in sources if targets[str(Path(source).parent)] == target]
        (copy.folder / f"{target}.cpp").write_text("".join(f'#include "{source}"\n' for source in together))
        objects += copy.compile([f"{target}.cpp"], copy.flags(target))
    program, scratch = copy.program(objects, PROGRAM), copy.folder
    mercury = lambda *words: run([program, *words], scratch)
    expect(run([program], scratch), "Stats\nCount\n")
    expect(mercury("render", "--help"), "height")
    bars = mercury("new", "bar", "--count", "3", "--bar-length", "6", "-o", "bars")
    expect(bars, "bar-1-2.json")
    expect(mercury("help", "count"), "Count masses, springs and faces of robots")
    expect(mercury("count", "bars/bar-1-0.json"), "bar-1-0: ", " masses, ")
    mercury("mutate", "bars/bar-1-0.json", "-o", "mutant.json")
    mercury("evolve", "./evolved", "--from", "bar", "--population", "4", "--generations", "1", "--seconds", "0.1")
    expect(mercury("info", "./evolved"), "bar")
    (scratch / "worm.drawing").write_text("####\n~  ~\n")
    mercury("import", "worm.drawing", "-o", "worms")
    expect(mercury("count", "worms/worm.json"), "worm: 28 masses")
    try:
        mercury("new", "bar", "--bar-length", "51", "-o", "none")
    except AssertionError as error:
        expect(str(error), "--bar-length: 51 is not accepted; give 1 to 50 voxels")
    else:
        raise AssertionError("a bar of 51 voxels was made")


def test_what_changes_headers(copy):
    """Parameters and environments."""
    for heading in ("A parameter of an environment", "An environment", "A parameter of a trial, an algorithm or an evolution"):
        copy.change(heading)
    compiler = [*itertools.takewhile(lambda word: not word.startswith("-"), copy.flags("sim")), "-std=c++20", "-O0",
                f"-I{copy.folder}", *(f"-I{copy.folder}/{part}/include" for part in ("sim", "robots", "evolution"))]
    names = [str(path.relative_to(copy.folder)) for pattern in ("*", "physics/*", "cpu/*", "cpu/grouping/*", "cpu/layout/*")
             for path in sorted(copy.folder.glob(f"sim/{pattern}.cpp"))]
    names = [name for name in names if not name.startswith("sim/evaluator")]
    names += ["sim/cuda/chip_bytes.cpp", "sim/cuda/rest_lengths.cpp", "sim/cuda/missing.cpp"]
    (copy.folder / "simulation.cpp").write_text("".join(f'#include "{name}"\n' for name in names))
    (copy.folder / "expectations.cpp").write_text(SIMULATION.replace("KERNEL", KERNEL))
    objects = copy.compile(["simulation.cpp", f"sim/cpu/kernels/kernel_{KERNEL}.cpp", "expectations.cpp"], compiler)
    run([*compiler, *objects, "-o", copy.folder / "simulation", "-ltbb", "-lhwy"], copy.folder)
    print(run([copy.folder / "simulation"], copy.folder), end="")
    (copy.folder / "table.cpp").write_text(TABLE)
    run([*compiler, *copy.compile(["table.cpp"], compiler), "-o", copy.folder / "table"], copy.folder)
    expect(run([copy.folder / "table"], copy.folder), "crossover immigrants ")
    for source, target in (("app/options/simulation_options.cpp", "app_options"),
                           ("evolution/run_folder/run_file_writing.cpp", "evolution")):
        copy.compile([source], [*copy.flags(target), "-fsyntax-only"])


def main():
    build = Path(sys.argv[1]).resolve()
    if not (build / "build.ninja").exists():
        return print("skipped: needs a build with Ninja")
    if re.search(r"^MERCURY_SANITIZE:\w+=.", (build / "CMakeCache.txt").read_text(), re.M):
        return print("skipped: sanitizers would make it slow, and find nothing in what it compiles without them")
    found = examples((ROOT / "CONTRIBUTING.md").read_text())
    kept = len(sys.argv) > 2
    folder = Path(sys.argv[2]).resolve() if kept else build / "tests/house/contributing"
    if not kept:
        shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)
    copy = Copy(build, folder, found)
    test_what_is_added(copy)
    test_what_changes_headers(copy)
    assert copy.changed == set(found), f"CONTRIBUTING.md: not tested: {set(found) - copy.changed}"
    if not kept:
        shutil.rmtree(folder)
    print(f"{sum(map(len, found.values()))} blocks of {len(found)} examples work")


if __name__ == "__main__":
    main()
