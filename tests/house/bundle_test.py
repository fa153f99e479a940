#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the bundle in a root file system that holds nothing but glibc and the few programs that its launcher needs.

    bundle_test.py BUILD-DIR
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
PROGRAMS = ["sh", "basename", "dirname", "head", "readlink", "sed", "sort", "tail", "ldconfig"]
# The bundle leaves these to the machine that it runs on.
NAME_SERVICE = ["libnss_files.so.2", "libresolv.so.2", "librt.so.1", "libdl.so.2", "libpthread.so.0", "libutil.so.1"]


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(0)


def fail(message):
    print(message, file=sys.stderr)
    sys.exit(1)


def loaded_by(program):
    """What the dynamic linker loads for a program, and the linker itself."""
    output = subprocess.run(["ldd", program], capture_output=True, text=True).stdout
    return re.findall(r"(/\S+)(?= \(0x)", output)


def copy_into(root, path):
    """Copies a file of this machine to the same place under the root."""
    target = root / str(path).lstrip("/")
    target.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy2(path, target)  # follows links


def make_root(root, bundle):
    for name in PROGRAMS:
        program = shutil.which(name, path="/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin")
        if not program:
            skip(f"this machine has no {name}")
        copy_into(root, program)
        for library in loaded_by(program):
            copy_into(root, library)
    libc = next(path for path in loaded_by("/bin/sh") if "libc.so" in path)
    for library in Path(libc).parent.glob("lib*.so.*"):
        if library.name in NAME_SERVICE or re.match(r"lib(m|mvec)\.so", library.name):
            copy_into(root, library)
    for name in ["dev", "tmp", "proc", "etc", "bin"]:
        (root / name).mkdir(exist_ok=True)
    (root / "dev/null").touch()
    if not (root / "bin/sh").exists():
        (root / "bin/sh").symlink_to(shutil.which("sh"))
    shutil.copytree(bundle, root / "mercury", symlinks=True)


def main():
    build = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory(prefix="mercury-bundle-") as scratch:
        scratch = Path(scratch)
        made = subprocess.run([PROJECT / "scripts/bundle", "--folder", scratch / "out", build], capture_output=True, text=True)
        if made.returncode != 0:
            fail(made.stderr)
        root = scratch / "root"
        root.mkdir()
        make_root(root, made.stdout.splitlines()[0])
        foreign = [path.name for path in root.rglob("lib*") if "/mercury/" not in str(path) and "stdc++" in path.name]
        if foreign:
            fail(f"the root is not empty: {foreign}")
        enter = ["chroot", root] if os.geteuid() == 0 else ["unshare", "--map-root-user", "chroot", root]
        probe = subprocess.run([*enter, "/bin/sh", "-c", "exit 0"], capture_output=True, text=True)
        if probe.returncode != 0:
            skip(f"chroot does not work here: {probe.stderr.strip()}")

        # The root has no /proc, where the linker would find out where the program lies.
        environment = {"PATH": "/usr/bin:/bin:/usr/sbin:/sbin", "HOME": "/tmp", "LD_ORIGIN_PATH": "/mercury/libexec"}

        def mercury(*arguments):
            return subprocess.run([*enter, "/mercury/bin/mercury", *arguments], capture_output=True, text=True,
                                  env=environment)

        def expect(status, *arguments):
            outcome = mercury(*arguments)
            if outcome.returncode != status:
                fail(f"{arguments}: exit status {outcome.returncode}, {outcome.stderr}")
            return outcome

        # The same bits as outside: the same code runs on the same processor.
        task = ["run", "--random", "voxel:3", "--seconds", "0.2", "--json", "--device", "cpu", "--quiet"]
        here = subprocess.run([build / "bin/mercury", *task], capture_output=True, text=True)
        hashes = re.findall(r'"hash": *"(\w+)"', here.stdout)
        if len(hashes) != 3:
            fail(f"no hashes outside: {here.stderr}")
        inside = expect(0, *task).stdout
        if re.findall(r'"hash": *"(\w+)"', inside) != hashes:
            fail("the bundle gives other states than the program it was made from")

        expect(0, "info")
        expect(0, "new", "voxel", "--count", "2", "--seed", "7", "-o", "/tmp/robots")
        expect(0, "run", "/tmp/robots", "--seconds", "0.1", "--record", "/tmp/a.h5", "--csv", "/tmp/a.csv")
        expect(0, "info", "/tmp/a.h5")
        expect(0, "evolve", "/tmp/run", "--from", "voxel:2x2x2", "--population", "4", "--generations", "1", "--seconds", "0.1")
        # No driver for OpenGL is there: one line says so.
        drawing = expect(1, "render", "/tmp/robots", "--still", "0", "-o", "/tmp/a.png")
        lines = [line for line in drawing.stderr.splitlines() if line]
        if not lines or not all(line.startswith("mercury: ") for line in lines):
            fail(f"not one line: {drawing.stderr}")


main()
