# SPDX-License-Identifier: Apache-2.0
import gc
import inspect
import itertools
import pickle
import subprocess
import sys
import threading

import numpy as np
import pytest

import mercurysim

STEPS = 100  # of most trials here
SECONDS = STEPS * 1e-3


@pytest.fixture(scope="module")
def robots():
    return mercurysim.random_voxel(12, seed=1)


def endless():
    for i in itertools.count():
        yield mercurysim.random_voxel(1, seed=1, first=i)[0]


def evaluate(source, device="cpu", **options):
    return mercurysim.evaluate(source, options.pop("seconds", SECONDS), device=device, **options)


def same(a, b):
    """Whether measures agree bit for bit. What was not measured is not a number, and equal to nothing."""
    return a.tobytes() == b.tobytes()


def test_results_are_those_of_a_batch(robots, device):
    batch = mercurysim.Batch(robots, device=device)
    start = batch.telemetry()
    batch.step(STEPS)
    end = batch.telemetry()
    results = list(evaluate(robots, device, hashes=True, states=True))
    assert [result.index for result in results] == list(range(12))
    assert [result.hash for result in results] == batch.hashes().tolist()
    for i, result in enumerate(results):
        assert result.failure is None
        assert result.steps == STEPS
        assert not result.exploded
        assert same(result.start, start[i]) and same(result.end, end[i])
        assert np.array_equal(result.robot.masses, robots[i].masses)
        mine = slice(batch.offsets[i], batch.offsets[i + 1])
        assert np.array_equal(result.positions, batch.positions.numpy()[mine])
        assert np.array_equal(result.velocities, batch.velocities.numpy()[mine])
        moved = end[i]["center_of_mass"].astype(float) - start[i]["center_of_mass"]
        assert result.distance == pytest.approx(np.linalg.norm(moved), rel=1e-6)
        assert result.path >= result.distance * 0.999
        assert result.quantities["distance"] == result.distance
        assert result.quantities["seconds"] == pytest.approx(SECONDS)


def test_an_exploded_robot_never_leads(device):
    # A spring of 50 N/m between two masses of 1 kg is unstable from dt = 0.2 s on.
    pair = mercurysim.Robot([[0, 0, 0], [1, 0, 0]], [[0, 1, 1, 1]], np.zeros((0, 3)), name="pair")
    loose = mercurysim.Robot([[0, 0, 0], [1, 0, 0]], np.zeros((0, 3)), np.zeros((0, 3)), name="loose")
    exploded, sound = evaluate([pair, loose], device, seconds=200, dt=1.0)
    assert exploded.exploded and not sound.exploded
    assert exploded.distance == 0
    assert exploded.quantities["masses"] == 2
    assert not {"distance", "speed", "work", "strain"} & exploded.quantities.keys()
    assert {"distance", "speed", "work", "strain"} <= sound.quantities.keys()


def test_distance_on_land_is_along_the_ground(robots):
    for result in evaluate(robots[:2], environment=mercurysim.Land(), dt=5e-4):
        moved = (result.end["center_of_mass"] - result.start["center_of_mass"]).astype(float)
        assert abs(moved[2]) > 0
        assert result.distance == pytest.approx(np.hypot(moved[0], moved[1]), rel=1e-6)


@pytest.mark.parametrize(
    "source",
    [
        lambda robots: robots,
        tuple,
        iter,
        lambda robots: (robot for robot in robots),
        lambda robots: lambda index: robots[index] if index < len(robots) else None,
        lambda robots: np.array(robots, dtype=object),
    ],
)
def test_results_do_not_depend_on_the_kind_of_source(robots, source):
    expected = mercurysim.Batch(robots, device="cpu")
    expected.step(STEPS)
    results = list(evaluate(source(robots), hashes=True, portion=5))
    assert [result.hash for result in results] == expected.hashes().tolist()
    assert [result.index for result in results] == list(range(12))


def test_one_robot_and_none(robots):
    assert len(list(evaluate(robots[0]))) == 1
    for source in [[], iter([]), lambda index: None]:
        assert list(evaluate(source)) == []


def test_what_is_not_asked_for_is_none(robots):
    result = next(evaluate(robots[:1]))
    assert result.hash is None and result.positions is None and result.velocities is None


def test_settling_is_not_measured(robots):
    batch = mercurysim.Batch(robots[0], device="cpu")
    batch.step(40)
    settled = batch.telemetry()[0]
    batch.step(60)
    result = next(evaluate(robots[0], settle=0.04))
    assert result.steps == 60
    assert same(result.start, settled)
    assert same(result.end, batch.telemetry()[0])


def test_dense_samples_make_longer_paths(robots):
    ends = next(evaluate(robots[0], seconds=1.0, sample_every=1.0))
    dense = next(evaluate(robots[0], seconds=1.0, sample_every=0.01))
    assert ends.path == pytest.approx(ends.distance, rel=1e-5)
    assert dense.path > ends.path


def test_endless_sources_are_taken_lazily(device):
    made = []

    def source():
        for i, robot in enumerate(endless()):
            made.append(i)
            yield robot

    with evaluate(source(), device, portion=4, seconds=0.01) as results:
        some = [next(results).index for _ in range(10)]
    assert some == list(range(10))
    assert made == list(range(len(made)))
    assert len(list(results)) == 0  # it is closed


def test_an_endless_function():
    results = evaluate(lambda index: mercurysim.random_voxel(1, seed=1, first=index)[0], seconds=0.01, hashes=True, portion=8)
    some = [next(results).hash for _ in range(20)]
    batch = mercurysim.Batch(mercurysim.random_voxel(20, seed=1), device="cpu")
    batch.step(10)
    assert some == batch.hashes().tolist()
    results.close()
    results.close()


def test_iterators_run_in_the_thread_that_waits(robots):
    threads = set()

    def source():
        for robot in robots:
            threads.add(threading.get_ident())
            yield robot

    assert len(list(evaluate(source()))) == 12
    assert threads == {threading.get_ident()}


class Unlucky(Exception):
    pass


def test_exceptions_of_an_iterator_come_after_the_results_before(robots):
    def source():
        yield from robots[:7]
        raise Unlucky("number 7")

    results = evaluate(source(), portion=3)
    assert [next(results).index for _ in range(7)] == list(range(7))
    with pytest.raises(Unlucky, match="number 7"):
        next(results)
    with pytest.raises(StopIteration):
        next(results)


def test_exceptions_of_a_function_come_after_the_results_before(robots):
    def source(index):
        if index >= 7:
            raise Unlucky(f"number {index}")
        return robots[index]

    results = evaluate(source, portion=3)
    assert [next(results).index for _ in range(7)] == list(range(7))
    with pytest.raises(Unlucky, match="number 7"):
        next(results)
    assert list(results) == []


def test_ctrl_c_in_an_iterator_comes_at_once():
    def source():
        yield mercurysim.random_voxel(1, seed=1)[0]
        raise KeyboardInterrupt

    results = evaluate(source(), seconds=1e6)
    with pytest.raises(KeyboardInterrupt):
        next(results)
    results.close()


def test_sources_of_other_things_are_refused(robots):
    for source in ["eel", [1], [robots], 3, None, object()]:
        with pytest.raises(TypeError):
            list(evaluate(source))
    for source in [iter([robots[0], 1]), lambda index: robots[0] if index == 0 else 1]:
        results = evaluate(source)
        assert next(results).index == 0
        with pytest.raises(TypeError, match="robot 1 of the source is a int"):
            next(results)


def test_input_errors_of_a_function_are_failures(robots):
    def source(index):
        if index == 1:
            raise mercurysim.InputError("the genome has no muscles")
        return robots[index] if index < 3 else None

    results = list(evaluate(source))
    assert [result.failure for result in results] == [None, "the genome has no muscles", None]
    failed = results[1]
    assert failed.robot is None
    assert failed.quantities == {}
    assert (failed.distance, failed.path, failed.steps, failed.hash) == (0, 0, 0, None)
    assert "no muscles" in repr(failed)


@pytest.mark.parametrize(
    "wrong, message",
    [
        ({"seconds": -1}, "seconds"),
        ({"seconds": float("nan")}, "seconds"),
        ({"seconds": float("inf")}, "seconds"),
        ({"seconds": 1e300}, "seconds"),
        ({"settle": 1}, "settle"),
        ({"settle": -1}, "settle"),
        ({"sample_every": -1}, "sample_every"),
        ({"dt": 0}, "dt"),
        ({"solver": "verlet"}, "force"),
        ({"environment": "swamp"}, "ocean"),
        ({"device": "tpu"}, "cpu"),
    ],
)
def test_values_that_break_a_rule_are_refused(robots, wrong, message):
    with pytest.raises(mercurysim.InputError, match=message) as error:
        evaluate(robots, **wrong)
    assert "\n" not in str(error.value)


def test_a_missing_device_is_an_error_of_the_machine(robots):
    for source in [robots, iter(robots)]:
        with pytest.raises(mercurysim.DeviceError):
            next(evaluate(source, device="cuda:99"))


def test_results_that_nobody_takes_are_given_up():
    for source in [endless(), lambda index: mercurysim.random_voxel(1, seed=1, first=index)[0]]:
        results = evaluate(source, seconds=1e6)
        del results
        gc.collect()


def test_a_source_that_refers_to_its_results_is_collected():
    def source():
        yield from endless()
        holder["results"]

    holder = {}
    generator = source()
    holder["results"] = evaluate(generator, seconds=0.01, portion=2)
    next(holder["results"])
    alive = __import__("weakref").ref(holder["results"])
    del generator, holder, source
    gc.collect()
    assert alive() is None


def test_a_source_may_not_ask_for_its_own_results():
    def source():
        yield from mercurysim.random_voxel(2, seed=1)
        next(results)

    results = evaluate(source(), portion=1)
    with pytest.raises(ValueError, match="has not returned"):
        list(results)


def test_a_source_may_close_its_own_results():
    def source():
        yield from mercurysim.random_voxel(2, seed=1)
        results.close()

    results = evaluate(source())
    assert list(results) == []


def test_results_can_be_closed_by_another_thread():
    results = evaluate(endless(), seconds=1e6)
    threading.Timer(0.2, results.close).start()
    assert list(results) == []


def test_results_cannot_be_pickled(robots):
    with pytest.raises(TypeError, match="collect them"):
        pickle.dumps(evaluate(robots))
    with pytest.raises(TypeError):
        mercurysim.Results()


def test_everything_public_has_a_docstring():
    assert inspect.getdoc(mercurysim.evaluate)
    for kind in [mercurysim.Result, mercurysim.Results]:
        for name in vars(kind):
            if not name.startswith("_"):
                assert inspect.getdoc(getattr(kind, name)), f"{kind.__name__}.{name}"


INTERRUPTED = """
import os, signal, threading
import mercurysim
results = mercurysim.evaluate(mercurysim.random_voxel(4, seed=1), 1e6, device="cpu")
threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
try:
    next(results)
except KeyboardInterrupt:
    print("interrupted", flush=True)
results.close()
"""


def test_ctrl_c_ends_the_wait_for_a_result():
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, timeout=120)
    assert (done.returncode, done.stdout, done.stderr) == (0, "interrupted\n", "")


SHUTDOWN = """
import itertools, threading
import mercurysim
def source():
    for i in itertools.count():
        yield mercurysim.random_voxel(1, seed=1, first=i)[0]
def function(index):
    return mercurysim.random_voxel(1, seed=1, first=index)[0]
open_results = [mercurysim.evaluate(each, 1e6, device="cpu") for each in [source(), function, mercurysim.random_voxel(4)]]
short = mercurysim.evaluate(source(), 0.01, device="cpu", portion=2)
next(short)
{}
print("done", flush=True)
"""
DAEMON = "threading.Thread(target=lambda: list(open_results[0]), daemon=True).start()"


@pytest.mark.parametrize("more", ["", DAEMON])
def test_the_interpreter_ends_while_evaluations_run(more):
    done = subprocess.run([sys.executable, "-c", SHUTDOWN.format(more)], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "done\n"
    assert done.stderr == ""


def test_trials_are_medians_of_robots_that_begin_with_jitter():
    robots = mercurysim.random_voxel(4, seed=2)
    several = list(mercurysim.evaluate(robots, 0.5, trials=3, hashes=True, environment="land"))
    assert [result.index for result in several] == [0, 1, 2, 3]
    for result in several:
        each = [trial.distance for trial in result.trials]
        assert len(each) == 3 and len(set(each)) == 3
        assert result.distance == np.median(each) == result.quantities["distance"]
        assert result.quartiles == pytest.approx(tuple(np.quantile(each, [0.25, 0.75])), rel=1e-12)
        assert result.work == np.median([trial.work for trial in result.trials])
    # One robot alone has the same trials; another seed has others.
    alone = next(mercurysim.evaluate(robots[3:], 0.5, trials=3, hashes=True, environment="land"))
    assert [trial.hash for trial in alone.trials] == [trial.hash for trial in several[3].trials]
    other = next(mercurysim.evaluate(robots[3:], 0.5, trials=3, seed=2, hashes=True, environment="land"))
    assert other.hash != alone.hash
    exact = next(mercurysim.evaluate(robots[3:], 0.5, hashes=True, environment="land"))
    assert len(exact.trials) == 1 and exact.hash not in [trial.hash for trial in alone.trials]


def test_trials_work_with_iterators_and_functions():
    expected = [r.distance for r in mercurysim.evaluate(mercurysim.random_voxel(5, seed=2), 0.2, trials=2)]
    source = (robot for robot in mercurysim.random_voxel(5, seed=2))
    assert [r.distance for r in mercurysim.evaluate(source, 0.2, trials=2)] == expected
    function = lambda i: mercurysim.random_voxel(1, seed=2, first=i)[0] if i < 5 else None
    assert [r.distance for r in mercurysim.evaluate(function, 0.2, trials=2)] == expected


def test_trials_out_of_range_are_refused():
    with pytest.raises(mercurysim.InputError, match="trials: 0 is not accepted"):
        mercurysim.evaluate([], 1, trials=0)
    with pytest.raises(mercurysim.InputError, match="jitter: -1"):
        mercurysim.evaluate([], 1, jitter=-1.0)
