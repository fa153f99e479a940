#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a command for a long time and shows whether its memory stays flat.

    bench/soak.py --minutes 60 -o memory.csv -- build/bin/mercury run --random voxel:64 --seconds 1e6 --record /tmp/a.h5
    MERCURY_WINDOW_PRESSES=100000000 bench/soak.py --minutes 60 -o memory.csv -- \\
      python3 tests/app/window/window_random_test.py build/bin/mercury robots/library/paper

Adds up the resident memory of all processes named `mercury` below the command (or of the command, if there is none) and, where
nvidia-smi is, what they use of GPUs. After the time it sends SIGINT. Prints the median of each sixth of the time in MB, and the
growth per hour: the slope of a line through the second half.
"""

import argparse
import csv
import os
import signal
import shutil
import statistics
import subprocess
import sys
import time

INTERVAL = 2  # seconds between two samples


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=60)
    parser.add_argument("-o", "--output", help="all samples as CSV, written as they come")
    parser.add_argument("command", nargs="+")
    return parser.parse_args()


def processes():
    """(parent, name, resident bytes) of each process."""
    table = {}
    for entry in filter(str.isdigit, os.listdir("/proc")):
        try:
            with open(f"/proc/{entry}/stat") as file:
                text = file.read()
        except OSError:
            continue
        name = text[text.index("(") + 1:text.rindex(")")]
        fields = text[text.rindex(")") + 2:].split()
        table[int(entry)] = (int(fields[1]), name, int(fields[21]) * os.sysconf("SC_PAGE_SIZE"))
    return table


def below(root, table):
    found, frontier = {root}, {root}
    while frontier := {pid for pid, (parent, _, _) in table.items() if parent in frontier} - found:
        found |= frontier
    return found & table.keys()


def gpu_bytes(pids):
    if not shutil.which("nvidia-smi"):
        return 0
    done = subprocess.run(["nvidia-smi", "--query-compute-apps=pid,used_memory", "--format=csv,noheader,nounits"],
                          capture_output=True, text=True)
    rows = [line.split(",") for line in done.stdout.splitlines() if line.count(",") == 1]
    own = [int(memory) for pid, memory in rows if pid.strip().isdigit() and int(pid) in pids and memory.strip().isdigit()]
    return sum(own) << 20


def sample(root):
    table = processes()
    pids = below(root, table)
    named = {pid for pid in pids if table[pid][1] == "mercury"} or pids
    return sum(table[pid][2] for pid in named), gpu_bytes(named)


def growth_per_hour(samples):
    """The least-squares slope of the second half [bytes/hour]."""
    half = samples[len(samples) // 2:]
    if len(half) < 2:
        return 0
    times = [moment for moment, _ in half]
    return 3600 * statistics.linear_regression(times, [size for _, size in half]).slope


def report(name, samples):
    if not any(size for _, size in samples):
        return
    sixths = [samples[len(samples) * i // 6:len(samples) * (i + 1) // 6] for i in range(6)]
    medians = [f"{statistics.median(size for _, size in part) / 1e6:.0f}" for part in sixths if part]
    print(f"{name}: median of each sixth {' '.join(medians)} MB, most {max(size for _, size in samples) / 1e6:.0f} MB, "
          f"growth in the second half {growth_per_hour(samples) / 1e6:+.1f} MB/h")


def main():
    options = arguments()
    # Shells let what they start in the background ignore it, and so would the command.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    table = csv.writer(open(options.output, "w", newline="", buffering=1)) if options.output else None
    if table:
        table.writerow(("seconds", "resident_bytes", "gpu_bytes"))
    process = subprocess.Popen(options.command)
    start = time.monotonic()
    rows = []
    while process.poll() is None and time.monotonic() - start < 60 * options.minutes:
        resident, on_gpu = sample(process.pid)
        rows.append((time.monotonic() - start, resident, on_gpu))
        if table:
            table.writerow(rows[-1])
        try:
            process.wait(INTERVAL)
        except subprocess.TimeoutExpired:
            pass
    ended_early = process.poll() is not None
    if not ended_early:
        process.send_signal(signal.SIGINT)
    status = process.wait()
    print(f"{rows[-1][0] / 60:.1f} minutes, exit status {status}{' (ended by itself)' if ended_early else ''}")
    report("resident", [(moment, resident) for moment, resident, _ in rows])
    report("GPU", [(moment, on_gpu) for moment, _, on_gpu in rows])


sys.exit(main())
