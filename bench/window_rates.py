#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Frames and steps per second of the window, beside the steps of the same robots without a window.

    bench/window_rates.py build/bin/mercury --robots 1 12 100 1000 --seconds 8 --csv rates.csv

Robots are full lattices of 10x10x10 voxels (1,331 masses, 14,230 springs). Each count runs in real time, where frames
count, and as fast as possible, where steps count, with positions on the GPU and through the host. The window is
unpaced: it draws as often as it can. It needs a display; the device is --device. An X server without a screen copies
each frame from the GPU to the host, which takes 4 to 5 ms: "present", and "without_display" are the frames without it.
"""
import argparse
import csv
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import mean

PREFIX = {"": 1, "k": 1e3, "M": 1e6, "G": 1e9, "T": 1e12}


def steps_per_second(program, robots, device, seconds):
    """Of the same robots without a window."""
    simulated = 0.05
    while True:
        begin = time.monotonic()
        out = subprocess.run([program, "run", robots, "--device", device, "--seconds", str(simulated)], check=True,
                             capture_output=True, text=True).stdout
        springs, wall, rate, prefix = re.search(
            r"(\d+) springs, ([0-9.]+) s of wall time, ([0-9.]+) ?(\w?) springs/s", out).groups()
        if float(wall) > seconds / 2 or time.monotonic() - begin > 60:
            return float(rate) * PREFIX[prefix] / int(springs)
        simulated = round(simulated * max(2.0, seconds / max(float(wall), 0.02)), 3)


def frames_of(report):
    for line in report.read_text().splitlines():
        try:
            event = json.loads(line)
        except json.JSONDecodeError:
            continue
        if event["event"] == "frame":
            yield event


def window_rates(program, robots, arguments, seconds, extra, environment):
    """Per second: frames, frames if bringing them to the display took no time, drawn robots, steps; and the time of
    each part of a frame [ms]."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.jsonl"
        window = subprocess.Popen([program, "view", robots, "--fresh", "--unpaced", "--device", arguments.device, "--size",
                                   arguments.size, "--report", str(report), *extra], env=environment,
                                  stderr=subprocess.PIPE, text=True)
        begin = time.monotonic()
        ready = None
        while ready is None or time.monotonic() - ready < seconds:
            if window.poll() is not None:
                sys.exit(f"the window ended: {window.stderr.read()}")
            if time.monotonic() - begin > 120:
                window.kill()
                sys.exit("the window showed no robots in 120 s")
            time.sleep(0.2)
            if ready is None and report.exists() and any(f["steps"] > 0 for f in frames_of(report)):
                ready = time.monotonic()
                counted = len(list(frames_of(report)))
            elif ready and time.monotonic() - ready > seconds / 2 and len(list(frames_of(report))) < counted + 4:
                ready += 0.2  # too few reports for a rate; the limit of 120 s holds
        window.send_signal(signal.SIGINT)
        window.wait()
        frames = list(frames_of(report))[counted:]
    wall = frames[-1]["clock"] - frames[0]["clock"]
    count = frames[-1]["number"] - frames[0]["number"]
    present = mean(f["cost"]["present"] for f in frames)
    return {"frames_per_second": count / wall, "without_display": count / (wall - count * present),
            "robots_drawn_per_second": (frames[-1]["drawn"] - frames[0]["drawn"]) / wall,
            **{f"{part}_ms": 1e3 * mean(f["cost"][part] for f in frames) for part in frames[0]["cost"]},
            "steps_per_second": (frames[-1]["steps"] - frames[0]["steps"]) / wall,
            "on_device": int(frames[-1]["on_device"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program")
    parser.add_argument("--robots", type=int, nargs="+", default=[1, 12, 100, 1000])
    parser.add_argument("--voxels", default="10x10x10")
    parser.add_argument("--seconds", type=float, default=8)
    parser.add_argument("--device", default="auto")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--csv")
    arguments = parser.parse_args()
    environment = dict(os.environ, __GL_SYNC_TO_VBLANK="0", vblank_mode="0")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for count in arguments.robots:
            robots = f"{folder}/{count}"
            subprocess.run([arguments.program, "new", "voxel", "-q", "--voxels", arguments.voxels, "--air", "0", "--count",
                            str(count), "--format", "cbor", "-o", robots + "/"], check=True, stdout=subprocess.DEVNULL)
            alone = steps_per_second(arguments.program, robots, arguments.device, arguments.seconds)
            for bridge in ("GPU", "host"):
                for speed in ("1", "max"):
                    extra = ["--speed", speed] + (["--no-interop"] if bridge == "host" else [])
                    rates = window_rates(arguments.program, robots, arguments, arguments.seconds, extra, environment)
                    rows.append({"robots": count, "bridge": bridge, "speed": speed, **rates, "steps_alone": alone,
                                 "share": rates["steps_per_second"] / alone})
                    print("  ".join(f"{name} {value:.4g}" if isinstance(value, float) else f"{name} {value}"
                                    for name, value in rows[-1].items()), flush=True)
    if arguments.csv:
        with open(arguments.csv, "w", newline="") as file:
            writer = csv.DictWriter(file, rows[0])
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
