# SPDX-License-Identifier: Apache-2.0
"""Batches in several threads and processes."""

import multiprocessing
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import mercurysim


def hashes_after(steps, robots, device):
    batch = mercurysim.Batch(robots, device=device)
    batch.step(steps)
    return batch.hashes().tolist()


@pytest.fixture
def robots():
    return mercurysim.random_voxel(4, seed=1)


def test_threads_take_turns_with_a_batch(robots, device):
    batch = mercurysim.Batch(robots, device=device)
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda _: [batch.step(3) for _ in range(10)], range(4)))
    assert batch.steps == 120
    assert batch.hashes().tolist() == hashes_after(120, robots, device)


def test_many_batches_in_many_threads(device):
    def run(seed):
        return hashes_after(50, mercurysim.random_voxel(3, seed=seed), device)

    expected = [run(seed) for seed in range(16)]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(run, range(16))) == expected


def test_threads_read_while_another_one_steps_and_changes_robots(robots, device):
    batch = mercurysim.Batch(robots, device=device)
    stop = threading.Event()

    def read():
        while not stop.is_set():
            assert batch.positions.numpy().shape[1] == 3
            assert batch.telemetry().shape[0] >= 4
            assert batch.centers is not None and batch.exploded.numpy() is not None
            batch.actuation.drive.numpy()
            len(batch), batch.time, batch.offsets, repr(batch)

    with ThreadPoolExecutor(3) as pool:
        readers = [pool.submit(read) for _ in range(3)]
        try:
            for _ in range(20):
                batch.step(2)
                batch.add(robots[0])
                batch.reset([True] * 5)
                batch.keep(range(4))
        finally:
            stop.set()
        for reader in readers:
            reader.result()
    assert len(batch) == 4


def test_the_arrays_are_those_of_the_robots_after_threads_have_changed_them(robots, device):
    batch = mercurysim.Batch(robots, device=device)

    def change(_):
        for _ in range(10):
            batch.add(robots[0])
            batch.positions, batch.actuation

    with ThreadPoolExecutor(4) as pool:
        list(pool.map(change, range(4)))
    assert len(batch) == 44
    assert batch.positions.shape == (batch.offsets[-1], 3)
    assert batch.actuation.drive.shape[0] == 44


RUNNING = """
import threading
import mercurysim
batch = mercurysim.Batch(mercurysim.random_voxel(4, seed=1), device="cpu")
positions = batch.positions
started = threading.Event()
def run():
    started.set()
    while True:
        batch.step(20)
threads = [threading.Thread(target=run, daemon=True) for _ in range(3)]
for thread in threads: thread.start()
started.wait()
batch.step(5)
print("done", flush=True)
"""


def test_the_interpreter_ends_while_threads_step():
    for _ in range(5):
        done = subprocess.run([sys.executable, "-c", RUNNING], capture_output=True, text=True, timeout=120)
        assert (done.returncode, done.stdout, done.stderr) == (0, "done\n", "")


FORK = """
import multiprocessing, os, sys
import mercurysim
robots = mercurysim.random_voxel(8, seed=1)
batch = mercurysim.Batch(robots, device="cpu")
batch.step(50)
expected = mercurysim.Batch(robots, device="cpu")
expected.step(100)
def child(which):
    other = batch if which == "old" else mercurysim.Batch(mercurysim.random_voxel(8, seed=1), device="cpu")
    other.step(50 if which == "old" else 100)
    return other.hashes().tolist()
with multiprocessing.get_context("fork").Pool(2, maxtasksperchild=1) as pool:
    results = pool.map(child, ["old", "new", "old", "new"], chunksize=1)
    assert results == [expected.hashes().tolist()] * 4, results
print("done")
"""


def test_forked_processes_step():
    done = subprocess.run([sys.executable, "-c", FORK], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (0, "done\n"), done.stderr


FORK_WHILE_STEPPING = """
import os, sys, threading
import mercurysim
robots = mercurysim.random_voxel(8, seed=1)
batch = mercurysim.Batch(robots, device="cpu")
stop = threading.Event()
def run():
    while not stop.is_set():
        batch.step(20)
threads = [threading.Thread(target=run) for _ in range(3)]
for thread in threads: thread.start()
children = []
for _ in range(8):
    pid = os.fork()
    if pid == 0:
        start = batch.steps
        batch.step(10)
        other = mercurysim.Batch(robots, device="cpu")
        other.step(50)
        os._exit(0 if batch.steps == start + 10 and other.steps == 50 else 1)
    children.append(pid)
states = [os.waitpid(pid, 0)[1] for pid in children]
stop.set()
for thread in threads: thread.join()
print(states)
"""


def test_a_process_may_fork_while_threads_step():
    done = subprocess.run([sys.executable, "-c", FORK_WHILE_STEPPING], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout) == (0, f"{[0] * 8}\n"), done.stderr


FORK_WHILE_EVALUATING = """
import os
import mercurysim
results = mercurysim.evaluate(mercurysim.random_voxel(200, seed=1), 2, device="cpu")
next(results)
pid = os.fork()
if pid == 0:
    try:
        next(results)
    except mercurysim.DeviceError as error:
        print(error, flush=True)
    results.close()
    own = list(mercurysim.evaluate(mercurysim.random_voxel(3, seed=1), 1, device="cpu"))
    os._exit(len(own))
assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 3
assert len(list(results)) == 199
"""


def test_results_belong_to_the_process_that_asked_for_them():
    done = subprocess.run([sys.executable, "-c", FORK_WHILE_EVALUATING], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("these results are those of the process that was forked")


def child(seed):
    return hashes_after(20, mercurysim.random_voxel(2, seed=seed), "cpu")


def test_spawned_processes_step():
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert pool.map(child, [1, 2]) == [child(1), child(2)]
