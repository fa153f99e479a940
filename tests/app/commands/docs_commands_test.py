# SPDX-License-Identifier: Apache-2.0
"""The commands of a page work: every line of it that begins with `mercury`, in the order of the page, in one folder.

    docs_commands_test.py MERCURY FOLDER            makes FOLDER for the pages
    docs_commands_test.py MERCURY FOLDER PAGE.md    tries a page in a copy of it

The folder holds what a reader would have: the sample robots, the folders my-robots, starts and hunters, scene.toml. Commands are shortened so that
they take moments: fewer robots, shorter trials, smaller pictures of low quality; pictures through a lens are only checked. Commands that need a scheduler or several hosts are left out. What
only shows, draws or measures, and stands on an earlier page word for word, is tried there.
"""

import os
import re
import shlex
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[3]
SHORT = {  # appended; the last value of an option counts
    "evolve": ["--population", "4", "--generations", "10", "--seconds", "0.05", "--settle", "0", "--no-confirm"],
    "run": ["--seconds", "0.1"],
    "check": ["--seconds", "0.1"],
    "render": ["--seconds", "0.1", "--size", "160x120", "--quality", "low"],
    "new": ["--seconds", "0.1"],
    "bench": ["--seconds", "0.05"],
}
MOST = {"--count": 2, "--best-of": 4, "--ancestors": 3, "--points": 200}  # values that are larger are lowered
EARLIEST = ("--still", "--from", "--to")  # of export: moments of a recording, which is short
WRITES = {"render", "check", "new", "mutate", "cross", "grow", "run", "bench", "export", "import"}  # repeated on a page, they replace their files
DEADLINE = 60  # seconds


def shortened(arguments):
    """The same command, but quick."""
    command = arguments[0] if arguments else ""
    result = list(arguments)
    for i in range(1, len(result)):
        limit = MOST.get(result[i - 1])
        if limit and result[i].isdigit():
            result[i] = str(min(int(result[i]), limit))
        if command == "export" and result[i - 1] in EARLIEST:
            result[i] = str(min(float(result[i]), 0.05))
        if result[i - 1] == "--random" and (match := re.fullmatch(r"(\w+):(\d+)(.*)", result[i])):
            result[i] = f"{match[1]}:{min(int(match[2]), 4)}{match[3]}"
    extra = list(SHORT.get(command, []))
    if command == "evolve" and any(word in arguments for word in ["--resume", "--shard", "--merge"]):
        extra = ["--generations", "11"] if "--resume" in arguments else []
    if command == "new" and "--best-of" not in arguments:
        extra = []
    if command == "export" and any(word.endswith(".html") for word in arguments) and not any(word.endswith(".h5") for word in arguments):
        extra = ["--seconds", "0.1"]  # the robots are simulated
    if command in ("new", "check") and "--settle" in arguments:
        extra += ["--settle", "0.05"]
    if "hero" in arguments:  # 32 pictures in one; tests of render make such ones
        extra.append("--dry-run")
    if command in WRITES:
        extra.append("--force")
    return result + extra


def show(program, arguments, cwd):
    """Opens a window on a display of its own, and closes it once it is ready."""
    sys.path.insert(0, str(PROJECT / "tests/app/window"))
    from window_driver import Display
    with tempfile.TemporaryDirectory() as scratch:
        report = Path(scratch) / "report.jsonl"
        display = Display(640, 480)
        environment = dict(os.environ, DISPLAY=display.name, XDG_CONFIG_HOME=scratch, LIBGL_ALWAYS_SOFTWARE="1")
        environment.pop("WAYLAND_DISPLAY", None)
        process = subprocess.Popen([program, *arguments, "--device", "cpu", "--quality", "low", "--size", "320x240",
                                    "--report", report], env=environment, cwd=cwd)
        try:
            deadline = time.monotonic() + DEADLINE
            while not (report.exists() and '"ready"' in report.read_text()):
                if process.poll() is not None or time.monotonic() > deadline:
                    return process.returncode or 1
                time.sleep(0.02)
        finally:
            process.terminate()
            process.wait()
            display.close()
    return 0


def commands(page):
    """(line number, text) of each command among the indented lines."""
    lines = page.read_text(encoding="utf-8").split("\n")
    fence = None
    number = 0
    while number < len(lines):
        line = lines[number]
        number += 1
        if line.startswith("```"):
            fence = None if fence is not None else line[3:]
            continue
        if fence is not None or not line.startswith("    "):
            continue
        first = number
        text = line.strip()
        while text.endswith("\\") and number < len(lines):
            text = text[:-1] + lines[number].strip()
            number += 1
        if re.match(r"(build/bin/)?mercury\s", text):
            # What stands two columns or more after a command explains it.
            yield first, re.split(r"\s{2,}(?![\s-])|\s+#\s", text)[0]


def write_files_of(page, folder):
    """Runs the blocks of Python that need nothing but json: they write the files that the page's commands read."""
    for block in re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE):
        if re.findall(r"^(?:import|from) .*", block, re.MULTILINE) == ["import json"]:
            subprocess.run([sys.executable, "-c", block], cwd=folder, check=True)


def tried_before(page):
    """The commands of earlier pages that leave nothing that a later command reads."""
    pages = [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]
    return {words_of(text) for earlier in pages[:pages.index(page)] for _, text in commands(earlier)
            if words_of(text).split()[1] in ("view", "render", "bench", "info")}


def words_of(text):
    return re.sub(r"^build/bin/", "", text)


def is_for_one_host(text):
    return not re.search(r"\.\.\.|\bRUN\b|\bFILE\b|SLURM", text)


def make_folder(folder, program):
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(PROJECT / "robots/library", folder / "robots/library",
                    ignore=lambda _, names: [name for name in names if name != "paper" and not name.endswith((".json", ".cbor"))])
    for robot in (folder / "robots/library/paper").iterdir():
        shutil.copy(robot, folder)
    run = dict(check=True, cwd=folder, capture_output=True)
    subprocess.run([program, "new", "voxel", "--count", "3", "--seed", "7", "-o", "my-robots"], **run)
    subprocess.run([program, "run", "my-robots", "--seconds", "0.1", "--record", "run.h5"], **run)
    (folder / "scene.toml").write_text('format = "mercury-scene"\nversion = 1\nrobots = ["eel.json", "fish.json"]\n')
    subprocess.run([sys.executable, PROJECT / "robots/library/animals/brains.py", "starts"], **run)
    subprocess.run([sys.executable, PROJECT / "robots/library/animals/school.py", "hunter", "3x5", "hunters"], **run)
    subprocess.run([program, *shortened(["evolve", "swim", "--from", "voxel:2x2x2"])], **run)
    for name in ["bin", "build/bin"]:
        shim = folder / name / "mercury"
        shim.parent.mkdir(parents=True)
        shim.write_text(f'#!/bin/sh\nexec "{sys.executable}" -B "{Path(__file__).resolve()}" --as "{program}" "$@"\n')
        shim.chmod(shim.stat().st_mode | stat.S_IXUSR)


def run_line(program, text, folder):
    """The exit status of a command and what it printed to stderr."""
    words = words_of(text)
    if not re.search(r"[][|&;<>()$`*?{}~#!\\]", words):  # the shell would only split it
        return run_command(program, shlex.split(words)[1:], cwd=folder)
    environment = dict(os.environ, PATH=f"{folder / 'bin'}:{os.environ['PATH']}")
    done = subprocess.run(["bash", "-c", text], cwd=folder, env=environment, capture_output=True, text=True)
    return done.returncode, done.stderr


def run_command(program, arguments, cwd=None):
    if arguments[:1] == ["view"]:
        return show(program, arguments, cwd), ""
    done = subprocess.run([program, *shortened(arguments)], cwd=cwd, capture_output=cwd is not None, text=True)
    return done.returncode, done.stderr


def test(program, made, page):
    before = tried_before(page)
    found = [(line, text) for line, text in commands(page) if is_for_one_host(text) and words_of(text) not in before]
    if not found:
        print(f"{page.name} has no commands", file=sys.stderr)
        return 1
    failures = 0
    with tempfile.TemporaryDirectory(prefix="mercury-docs-") as scratch:
        folder = Path(scratch)
        shutil.copytree(made, folder, dirs_exist_ok=True)
        if any("evolve swim" in text for _, text in found):  # else the page looks at a run of another page
            shutil.rmtree(folder / "swim")
        write_files_of(page, folder)
        for line, text in found:
            status, stderr = run_line(program, text, folder)
            # Whether a result holds in a moment is no matter of the page.
            accepted = (0, 1) if text.startswith("mercury check") else (0,)
            print(f"{'ok    ' if status in accepted else 'FAILED'} {page.name}:{line}: {text}")
            if status not in accepted:
                failures += 1
                print(stderr, file=sys.stderr)
    return 1 if failures else 0


def main():
    if sys.argv[1] == "--as":
        return run_command(sys.argv[2], sys.argv[3:])[0]
    program, folder = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    if len(sys.argv) == 3:
        return make_folder(folder, program)
    return test(program, folder, Path(sys.argv[3]).resolve())


sys.exit(main())
