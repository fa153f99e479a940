#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Hostile command lines. Commands and options come from the program itself (`mercury describe-options json`).

    options_fuzzer.py MERCURY [--runs N] [--minutes M] [--seed S]

Each command line is drawn from (seed, number) alone. It runs as an unprivileged user, in a scratch folder, with limits on
time, memory and file size. It must end with a documented status, print only lines of its own on standard error, die of no
signal, and leave its inputs and everything outside its own folder as they were. --only NUMBER repeats one.
"""

import argparse
import hashlib
import json
import os
import random
import re
import resource
import shlex
import shutil
import stat
import subprocess
import sys
import tempfile
import time
from pathlib import Path

NOBODY = 65534
STATUSES = {0, 1, 2, *range(130, 144)}
LIMIT = 60  # seconds; only a hang takes as long
SKIPPED = 77
MOST_LINES = 40  # of messages: a folder of bad files has a line for each
LIBRARY_WORDS = re.compile(r"json\.exception|std::|basic_string|vector::|bad_alloc|CLI::|toml::|filesystem error|terminate called|"
                           r"HDF5-DIAG|AddressSanitizer|runtime error|Assertion|tbb::|GNU MP")
PROGRESS = re.compile(r"[a-z ]+: \d+/\d+ \w+ \(\d+ %\)")  # what takes long says how far it is
PICTURES = ["out.mp4", "out.png", "frames/"]
ROBOTS = ["out.json", "out.cbor", "robots/"]
WORDS = ["", " ", "-", "--", "---", "-1", "0", "1", "2", "7", "1e-30", "1e30", "1e999", "nan", "-nan", "inf", "-inf", "0x10",
         "2147483647", "2147483648", "4294967296", "9223372036854775807", "9223372036854775808", "-9223372036854775808",
         "1e-320", "1,2,3", "1,2", "1,,2", "nan,0,0", "1x1", "0x0x0", "16385x1", "2x2x2..1x1x1", "a=b", "y:nan", "voxel:2",
         "nn:1", "shell:1", "cppn:1", "voxel:0", "voxel:-1", "voxel:1:2:3:4", "voxel:99999999999", "follow:", "eel", "\u00e9\u202e",
         "\x1b[31mred\x1b[0m", "two\nlines", "%s%n", "'", '"', "$(id)", "../..", "a" * 300, "x" * 100_000, b"\xff\xfe", b"\xc3"]


def can_be_run(program):
    try:
        return subprocess.run([program, "--version"], stdout=subprocess.DEVNULL, preexec_fn=nobody).returncode == 0
    except OSError:
        return False


def nobody():
    """In the child: no privileges, no endless resources."""
    if os.geteuid() == 0:
        os.setgroups([])
        os.setresgid(NOBODY, NOBODY, NOBODY)
        os.setresuid(NOBODY, NOBODY, NOBODY)
    os.nice(10)
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    resource.setrlimit(resource.RLIMIT_FSIZE, (64 << 20, 64 << 20))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def digest(folder):
    """What is in a folder, by path."""
    found = {}
    for path in sorted(folder.rglob("*")):
        mode = path.lstat().st_mode
        content = hashlib.sha256(path.read_bytes()).hexdigest() if stat.S_ISREG(mode) else ""
        found[str(path)] = (mode, content)
    return found


class Scratch:
    """inputs/: must not change. work/: where the program runs and may write. outside/: must not change."""

    def __init__(self, program):
        self.root = Path(tempfile.mkdtemp(prefix="mercury-options-"))
        self.root.chmod(0o755)
        self.inputs, self.outside, self.work = (self.root / name for name in ("inputs", "outside", "work"))
        for folder in (self.inputs, self.outside):
            folder.mkdir()
        (self.outside / "keep").write_text("keep")
        subprocess.run([program, "new", "voxel", "-o", self.inputs / "robot.json"], check=True, capture_output=True)
        subprocess.run([program, "run", self.inputs / "robot.json", "--device", "cpu", "--seconds", "0.05", "--record",
                        self.inputs / "swim.h5"], check=True, capture_output=True)
        (self.inputs / "bad.json").write_text('{"format": "mercury-robot", "version": 1, "name": "\\u001b[31m')
        (self.inputs / "bytes.cbor").write_bytes(bytes(range(256)))
        (self.inputs / "sim.toml").write_text("dt = 0.001\n[run]\nseconds = 0.05\n")
        (self.inputs / "bad.toml").write_text("dt = [[\n")
        (self.inputs / "camera.json").write_text('{"format": "mercury-camera", "version": 1, "mode": "top"}')
        (self.inputs / "empty").write_text("")
        (self.inputs / "folder").mkdir()
        (self.inputs / "dangling").symlink_to("nowhere")
        for name in ("fifo", "fifo.json", "fifo.h5", "fifo.toml"):
            os.mkfifo(self.inputs / name)
        self.before = digest(self.inputs), digest(self.outside)

    def paths(self):
        inputs = [self.inputs / name for name in ("robot.json", "swim.h5", "bad.json", "bytes.cbor", "sim.toml", "bad.toml",
                                                  "camera.json", "empty", "folder", "dangling", "fifo", "fifo.json",
                                                  "fifo.h5", "fifo.toml", "missing.json", "missing.h5")]
        outputs = ["out.json", "out.cbor", "out.h5", "out.csv", "out.mp4", "out.png", "out.txt", "frames/", "no/such/out.json",
                   self.outside / "out.h5", "/proc/self/mem", "/dev/null", "/dev/full", "/dev/zero", "/", ".", "/dev/stdout"]
        return [str(path) for path in inputs + outputs]

    def fresh_work(self):
        shutil.rmtree(self.work, ignore_errors=True)
        self.work.mkdir()
        if os.geteuid() == 0:
            os.chown(self.work, NOBODY, NOBODY)

    def changes(self):
        now = digest(self.inputs), digest(self.outside)
        return [name for old, new in zip(self.before, now) for name in {**old, **new} if old.get(name) != new.get(name)]


class Drawing:
    """Command lines."""

    def __init__(self, program, scratch):
        document = json.loads(subprocess.run([program, "describe-options", "json"], check=True, capture_output=True).stdout)
        self.commands = [command for command in document["commands"] if command["words"] or command["options"]]
        self.paths = scratch.paths()

    def value(self, option, draw):
        kind = draw.random()
        if option["choices"] and kind < 0.35:
            return draw.choice(option["choices"]) + draw.choice(["", "", "", ":1", ":", "x"])
        if option["kind"] == "path" and kind < 0.8 or kind < 0.15:
            return draw.choice(self.paths)
        if "number" in option["kind"] and kind < 0.7:
            return draw.choice(["0", "1", "2", "0.5", "0.01", "-1", "1e9", "1e-9"])
        return draw.choice(WORDS)

    def option(self, option, draw):
        if option["positional"]:
            return [self.value(option, draw)]
        name = draw.choice(option["names"])
        if option["kind"] == "switch" and draw.random() < 0.9:
            return [name]
        value = self.value(option, draw)
        if isinstance(value, str) and draw.random() < 0.4:
            return [f"{name}={value}" if name.startswith("--") else name + value]
        return [name, value]

    def line(self, draw):
        command = draw.choice(self.commands)
        words = list(command["words"])
        options = [o for o in command["options"] if "--help" not in o["names"] or draw.random() < 0.05]
        if command["words"]:  # small and quick, so that a command gets to its work and ends
            for names in (["--seconds", "0.02"], ["--device", "cpu"], ["--size", "32x32" if {"render", "view"} & set(words) else "2x2x2"], ["--generations", "1"],
                          ["--population", "3"], ["--random", "voxel:2"], ["-o", draw.choice(PICTURES if "render" in words else ROBOTS)]):
                if any(names[0] in o["names"] for o in options) and (names[0] not in ("--random", "-o") or draw.random() < 0.8):
                    words += names
            if words[0] == "bench":
                words += ["--count", "4"]  # a sweep ends there; by itself, at a quarter of the memory
            if any(o["positional"] for o in options) and "--random" not in words:
                words.append(draw.choice(self.paths[:2]))
        for _ in range(draw.choice([0, 0, 1, 1, 1, 2, 2, 3, 5])):
            if options:
                option = draw.choice(options)
                for _ in range(draw.choice([1, 1, 1, 1, 2])):
                    words += self.option(option, draw)
        if draw.random() < 0.05:
            words.insert(draw.randrange(len(words) + 1), draw.choice(WORDS))
        if draw.random() < 0.05:
            draw.shuffle(words)
        return [os.fsencode(word) if isinstance(word, str) else word for word in words]


def complaint(outcome, scratch):
    """What is wrong with what a command line did; empty = nothing."""
    status, messages = outcome
    if status is None:
        return f"did not end within {LIMIT} s"
    if status not in STATUSES:
        return f"ended with status {status}"
    lines = [line for line in re.split(rb"[\n\r]", messages) if line]
    if len(lines) > MOST_LINES:
        return f"printed {len(lines)} lines"
    for line in lines:
        try:
            text = line.decode()
        except UnicodeDecodeError:
            return f"printed bytes that are not UTF-8: {line[:200]}"
        if not text.startswith(("mercury: ", '{"error": {"message": "')) and not PROGRESS.match(text):
            return f"printed a line that is not its own: {text[:300]!r}"
        if any(ord(letter) < 32 or ord(letter) == 127 for letter in text):
            return f"printed control characters: {text[:300]!r}"
        if len(text) > 2000:
            return f"printed a line of {len(text)} characters"
        if LIBRARY_WORDS.search(text):
            return f"printed words of a library: {text[:300]!r}"
    if status == 2 and not lines:
        return "ended with status 2 without a message"
    changed = scratch.changes()
    return f"changed {changed[:3]}" if changed else ""


def run(program, words, scratch):
    scratch.fresh_work()
    environment = {"PATH": os.environ.get("PATH", "/usr/bin"), "HOME": str(scratch.work), "TMPDIR": str(scratch.work),
                   "LC_ALL": "C.UTF-8", "XDG_CONFIG_HOME": str(scratch.work)}
    with tempfile.TemporaryFile() as messages:
        child = subprocess.Popen([os.fsencode(program), *words], cwd=scratch.work, env=environment, stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=messages, preexec_fn=nobody, start_new_session=True)
        try:
            status = child.wait(LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, 9)
            child.wait()
            status = None
        messages.seek(0)
        return status, messages.read(1 << 20)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=lambda text: str(Path(text).resolve()))
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--minutes", type=float, help="instead of a number of runs")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int)
    arguments = parser.parse_args()
    if not can_be_run(arguments.program):
        print(f"skipped: the user nobody, as whom this runs, cannot read {arguments.program}")
        return SKIPPED
    scratch = Scratch(arguments.program)
    failures, number, statuses, end = 0, 0, {}, time.monotonic() + 60 * (arguments.minutes or 0)
    try:
        drawing = Drawing(arguments.program, scratch)
        while time.monotonic() < end if arguments.minutes else number < arguments.runs:
            if arguments.only is not None:
                number = arguments.only
            words = drawing.line(random.Random(f"{arguments.seed} {number}"))
            words = [word.replace(b"\0", b"") for word in words]
            outcome = run(arguments.program, words, scratch)
            problem = complaint(outcome, scratch)
            statuses[outcome[0]] = statuses.get(outcome[0], 0) + 1
            if problem:
                failures += 1
                line = shlex.join(word[:200].decode(errors="backslashreplace") for word in words)
                print(f"{number}: {problem}\n    mercury {line[:1000]}", flush=True)
                scratch.before = digest(scratch.inputs), digest(scratch.outside)
            number += 1
            if arguments.only is not None:
                print(outcome[0], outcome[1].decode(errors="backslashreplace"))
                break
    finally:
        shutil.rmtree(scratch.root, ignore_errors=True)
    print(f"{number} command lines, statuses {dict(sorted(statuses.items(), key=str))}, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
