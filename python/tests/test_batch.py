# SPDX-License-Identifier: Apache-2.0
import inspect
import os
import re
import subprocess
import sys

import pickle

import numpy as np
import pytest

import mercurysim


def test_step_advances_time(batch):
    batch.step()
    assert batch.steps == 1
    batch.step(9)
    batch.step(n=0)
    assert batch.steps == 10
    assert batch.time == pytest.approx(10e-3)
    assert batch.dt == 1e-3
    assert len(batch) == batch.size == 4


def test_hashes_do_not_depend_on_the_batch_nor_on_how_steps_are_split(robots, device):
    together = mercurysim.Batch(robots, device=device)
    together.step(200)
    for i, robot in enumerate(robots):
        alone = mercurysim.Batch(robot, device=device)
        for n in [1, 99, 0, 100]:
            alone.step(n)
        assert alone.hash(0) == together.hash(i)
    assert together.hashes().dtype == np.uint64
    assert together.hashes().tolist() == [together.hash(i) for i in range(4)]


def test_offsets_are_the_first_masses_of_the_robots(batch, robots):
    offsets = batch.offsets
    assert offsets.dtype == np.int64
    positions = batch.positions.numpy()
    for i, robot in enumerate(robots):
        assert np.array_equal(positions[offsets[i] : offsets[i + 1]], robot.masses)
    assert offsets[0] == 0 and offsets[-1] == len(positions)


def test_robots_begin_at_rest_and_centers_are_means(batch, robots):
    assert not batch.velocities.numpy().any()
    for i, robot in enumerate(robots):
        assert np.allclose(batch.centers.numpy()[i], robot.masses.mean(axis=0), atol=1e-5)
    batch.step(500)
    x, v, offsets = batch.positions.numpy(), batch.velocities.numpy(), batch.offsets
    for i in range(4):
        mine = slice(offsets[i], offsets[i + 1])
        assert np.allclose(batch.centers.numpy()[i], x[mine].mean(axis=0), atol=1e-5)
        assert np.allclose(batch.center_velocities.numpy()[i], v[mine].mean(axis=0), atol=1e-5)


def test_telemetry_agrees_with_the_arrays(batch):
    batch.step(300)
    telemetry = batch.telemetry()
    assert telemetry.shape == (4,)
    assert np.array_equal(telemetry["center_of_mass"], batch.centers.numpy())
    assert np.array_equal(telemetry["velocity"], batch.center_velocities.numpy())
    v, offsets = batch.velocities.numpy().astype(float), batch.offsets
    for i in range(4):
        energy = (v[offsets[i] : offsets[i + 1]] ** 2).sum() / 2
        assert telemetry["kinetic_energy"][i] == pytest.approx(energy, rel=1e-5)
    assert (telemetry["largest_strain"] > 0).all()
    assert not telemetry["exploded"].any()
    assert (telemetry["culprit_spring"] == -1).all()
    assert (telemetry["exploded_at"] == 0).all()


def test_folding_is_measured_where_it_is_asked_for():
    batch = mercurysim.Batch(mercurysim.random_voxel(2), device="cpu")
    assert not batch.measure_folding
    assert np.isnan(batch.telemetry()["inverted"]).all()
    batch.measure_folding = True
    assert (batch.telemetry()["inverted"] == 0).all()
    assert (batch.telemetry()["overlap"] == 0).all()
    result = next(mercurysim.evaluate(mercurysim.random_voxel(1), 0.1, device="cpu", folding=True))
    assert result.inverted == result.quantities["inverted"] == 0



def test_docstring_of_telemetry_names_every_field(batch):
    for name in batch.telemetry().dtype.names:
        assert name in inspect.getdoc(mercurysim.Batch.telemetry)


def test_reset_of_all(batch):
    begin = batch.hashes()
    batch.step(50)
    assert not np.array_equal(batch.hashes(), begin)
    batch.reset()
    assert batch.time == 0
    assert np.array_equal(batch.hashes(), begin)


@pytest.mark.parametrize(
    "as_mask",
    [
        list,
        tuple,
        np.array,
        lambda mask: np.array(mask, dtype=np.uint8),
        lambda mask: np.repeat(np.array(mask), 2)[::2],
        lambda mask: pytest.importorskip("torch").tensor(mask),
    ],
)
def test_reset_of_some_robots(batch, as_mask):
    begin = batch.hashes()
    batch.step(50)
    moved = batch.hashes()
    batch.reset(as_mask([True, False, False, True]))
    now = batch.hashes()
    assert now[0] == begin[0] and now[3] == begin[3]
    assert now[1] == moved[1] and now[2] == moved[2]
    assert batch.steps == 50
    assert np.array_equal(batch.positions.numpy()[: batch.offsets[1]], batch.robots[0].masses)


def test_reset_by_a_mask_on_the_gpu(batch):
    torch = pytest.importorskip("torch")
    if batch.device == "cpu":
        pytest.skip("is about the memory of a GPU")
    begin = batch.hashes()
    for dtype in [torch.bool, torch.uint8]:
        batch.step(50)
        moved = batch.hashes()
        batch.reset(torch.tensor([1, 0, 0, 1], device=batch.device).to(dtype))
        assert batch.hashes().tolist() == [begin[0], moved[1], moved[2], begin[3]]
    with pytest.raises(mercurysim.InputError, match="3 elements"):
        batch.reset(torch.ones(3, dtype=torch.bool, device=batch.device))
    with pytest.raises(TypeError, match="bool or uint8"):
        batch.reset(torch.ones(4, device=batch.device))
    with pytest.raises(TypeError, match="one after another"):
        batch.reset(torch.ones(8, dtype=torch.bool, device=batch.device)[::2])


def test_add_and_keep(batch):
    batch.step(30)
    before = batch.hashes()
    more = mercurysim.random_voxel(2, seed=5)
    assert batch.add(more) == 4
    assert batch.add(more[0]) == 6
    assert batch.add([]) == 7
    assert np.array_equal(batch.hashes()[:4], before)
    assert np.array_equal(batch.positions.numpy()[batch.offsets[6] : batch.offsets[7]], more[0].masses)
    batch.keep([5, 2, 0])
    assert len(batch) == 3
    assert batch.hashes()[1:].tolist() == [before[2], before[0]]
    assert len(batch.robots) == 3
    assert len(batch.robots[0].masses) == len(more[1].masses)
    batch.keep(np.array([1]))
    batch.step(1)
    assert len(batch) == 1
    batch.keep([])
    assert len(batch) == 0
    batch.step(1)


def test_set_state(batch):
    offsets = batch.offsets
    masses = int(offsets[2] - offsets[1])
    x = batch.robots[1].masses + np.array([1, 2, 3], dtype=np.float32)
    batch.set_state(1, x, np.full((masses, 3), 0.5))
    assert np.array_equal(batch.positions.numpy()[offsets[1] : offsets[2]], x)
    assert (batch.velocities.numpy()[offsets[1] : offsets[2]] == 0.5).all()
    assert not batch.velocities.numpy()[offsets[2] :].any()
    batch.set_state(1, x.tolist())
    assert not batch.velocities.numpy().any()
    batch.set_state(1, np.asfortranarray(x)[::1])
    assert np.array_equal(batch.positions.numpy()[offsets[1] : offsets[2]], x)


def test_a_robot_that_leaves_the_finite_is_reported(batch):
    x = batch.robots[2].masses.copy()
    x[0] = np.nan
    before = batch.hash(1)
    batch.step(3)
    batch.set_state(2, x)
    batch.step(5)
    assert batch.exploded.numpy().tolist() == [False, False, True, False]
    telemetry = batch.telemetry()
    assert telemetry["exploded"].tolist() == [False, False, True, False]
    assert telemetry["exploded_at"][2] == pytest.approx(3e-3)
    assert batch.hash(1) != before
    batch.reset([False, False, True, False])
    assert not batch.exploded.numpy().any()


def test_configure(batch):
    batch.step(10)
    batch.configure(dt=2e-3, solver="xpbd", damping=0.5)
    batch.step(10)
    assert batch.time == pytest.approx(30e-3)
    assert (batch.dt, batch.solver, batch.damping) == (2e-3, "xpbd", 0.5)
    batch.configure(environment=mercurysim.Land())
    assert isinstance(batch.environment, mercurysim.Land)
    z = batch.positions.numpy()[:, 2]
    assert [z[a:b].min() for a, b in zip(batch.offsets, batch.offsets[1:])] == pytest.approx([0] * 4, abs=1e-6)
    with pytest.raises(mercurysim.InputError, match="dt"):
        batch.configure(dt=-1)
    with pytest.raises(TypeError):
        batch.configure(device="cpu")
    assert batch.dt == 2e-3


def test_an_empty_batch_counts_steps(device):
    batch = mercurysim.Batch([], device=device)
    batch.step(2)
    batch.reset([])
    assert batch.time == pytest.approx(2e-3)
    assert batch.telemetry().shape == (0,)
    assert batch.hashes().size == 0
    assert batch.offsets.tolist() == [0]
    assert batch.add(mercurysim.random_voxel(1, seed=1)) == 0
    batch.step(2)
    assert batch.time == pytest.approx(4e-3)


def test_names_for_people(batch, device):
    assert batch.device == ("cpu" if device == "cpu" else "cuda:0")
    assert repr(batch) == f"<Batch of 4 robots on {batch.device}>"
    assert batch.device_name
    assert isinstance(batch.notes, list)


def test_everything_public_has_a_docstring():
    for kind in [mercurysim.Batch, mercurysim.Array, mercurysim.Actuation]:
        assert inspect.getdoc(kind)
        for name in vars(kind):
            if not name.startswith("_"):
                assert inspect.getdoc(getattr(kind, name)), f"{kind.__name__}.{name}"


LONG_RUN = """
import os, signal, threading, time
import mercurysim
batch = mercurysim.Batch(mercurysim.random_voxel(4, seed=1), device="cpu")
def interrupt():
    while batch.steps == 0:
        time.sleep(0.01)
    os.kill(os.getpid(), signal.SIGINT)
threading.Thread(target=interrupt).start()
try:
    batch.step(10**15)
except KeyboardInterrupt:
    print("interrupted", 0 < batch.steps < 10**15, flush=True)
batch.step(1)
"""


def test_ctrl_c_ends_a_long_run_and_leaves_the_batch_usable():
    done = subprocess.run([sys.executable, "-c", LONG_RUN], capture_output=True, text=True, timeout=120)
    assert done.stdout == "interrupted True\n", done.stderr
    assert done.returncode == 0


LITTLE_MEMORY = """
import os, resource
import mercurysim
few = mercurysim.random_voxel(16, seed=1, voxels=(14, 14, 14), air=0)
many = mercurysim.random_voxel(20, seed=1) * 1000
mercurysim.Batch(many[:1], device="cpu", threads=1).step(1)
taken = int(open("/proc/self/statm").read().split()[0]) * os.sysconf("SC_PAGE_SIZE")
resource.setrlimit(resource.RLIMIT_AS, (taken + 2**23, resource.RLIM_INFINITY))
small = mercurysim.Batch(many[:1], device="cpu", threads=1)
for call in (lambda: mercurysim.Batch(many, device="cpu", threads=1), lambda: small.add(many),
             lambda: [mercurysim.Batch(few, device="cpu", threads=1) for _ in range(1000)]):
    try:
        call()
    except MemoryError as error:
        print(error, flush=True)
small.step(1)
print(small.steps)
"""


@pytest.mark.skipif("asan" in os.environ.get("LD_PRELOAD", ""), reason="the sanitizer ends a program without memory")
def test_robots_that_do_not_fit_into_memory_are_refused_in_one_line():
    done = subprocess.run([sys.executable, "-c", LITTLE_MEMORY], capture_output=True, text=True, timeout=120)
    needed = r"about \d+ MB of memory are needed, \d+(\.\d)? MB can be used\n"
    assert re.fullmatch(needed + needed + r"not enough memory: more is needed than the limit, \d+ MiB \(ulimit -v\)\n1\n",
                        done.stdout), done.stdout + done.stderr
    assert done.returncode == 0


def test_a_saved_state_is_returned_to_bit_for_bit(batch):
    batch.step(100)
    state = batch.save()
    assert state.time == batch.time and np.array_equal(state.positions, batch.positions.numpy())
    before = batch.hashes()
    batch.step(200)
    after = batch.hashes()
    for saved in (state, pickle.loads(pickle.dumps(state))):
        batch.restore(saved)
        assert batch.steps == 100 and np.array_equal(batch.hashes(), before)
        batch.step(200)
        assert np.array_equal(batch.hashes(), after)


def test_a_saved_state_holds_explosions(device):
    batch = mercurysim.Batch(mercurysim.random_voxel(2, seed=1), device=device)
    batch.actuation.driven
    batch.step(10)
    state = batch.save()
    masses = len(batch.robots[1].masses)
    batch.set_state(1, batch.robots[1].masses, np.full((masses, 3), 1e30))
    batch.step(10)
    exploded = pickle.loads(pickle.dumps(batch.save()))
    batch.restore(state)
    assert not batch.exploded.numpy().any()
    batch.restore(exploded)
    assert batch.exploded.numpy().tolist() == [False, True]


def test_the_state_of_other_robots_is_refused(batch):
    state = batch.save()
    batch.keep([0])
    with pytest.raises(ValueError):
        batch.restore(state)
