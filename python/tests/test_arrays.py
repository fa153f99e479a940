# SPDX-License-Identifier: Apache-2.0
"""Arrays of a batch in other libraries: one memory, no copy, and an owner."""

import gc
import pickle

import numpy as np
import pytest

import mercurysim

STATE = ["positions", "velocities", "centers", "center_velocities"]


@pytest.fixture
def batch(device):
    return mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device=device)


@pytest.fixture
def torch():
    return pytest.importorskip("torch")


def address(array):
    """Of the first element, on any device."""
    interface = getattr(array, "__array_interface__", None) or array.__cuda_array_interface__
    return interface["data"][0]


def test_shapes_types_and_devices(batch):
    masses = sum(len(robot.masses) for robot in batch.robots)
    assert batch.positions.shape == batch.velocities.shape == (masses, 3)
    assert batch.centers.shape == batch.center_velocities.shape == (3, 3)
    assert batch.exploded.shape == (3,)
    assert batch.exploded.dtype == np.bool_
    for name in STATE:
        array = getattr(batch, name)
        assert array.dtype == np.float32
        assert array.ndim == 2
        assert array.size == array.shape[0] * 3
        assert array.nbytes == 4 * array.size
        assert len(array) == array.shape[0]
        assert array.device == batch.device
        assert array.__dlpack_device__()[0] == (1 if batch.device == "cpu" else 2)
        assert repr(array).startswith(f"Array(shape={array.shape}, dtype=float32, device='{batch.device}')\n")


def test_arrays_are_the_same_objects_and_memory_while_robots_stay(batch):
    before = {name: getattr(batch, name) for name in [*STATE, "exploded"]}
    addresses = {name: address(array) for name, array in before.items()}
    batch.step(10)
    batch.reset()
    for name, array in before.items():
        assert getattr(batch, name) is array
        assert address(array) == addresses[name]
    assert batch.actuation is batch.actuation
    assert batch.actuation.drive is batch.actuation.drive


def test_torch_shares_memory(batch, torch):
    for name in STATE:
        array = getattr(batch, name)
        tensor = torch.from_dlpack(array)
        assert tensor.data_ptr() == address(array)
        assert tuple(tensor.shape) == array.shape
        assert tensor.dtype == torch.float32
        assert str(tensor.device) == batch.device
    assert batch.positions.torch().data_ptr() == address(batch.positions)
    before = batch.positions.torch().clone()
    positions = batch.positions.torch()
    batch.step(100)
    assert (positions != before).any()
    assert np.array_equal(positions.cpu().numpy(), batch.positions.numpy())


def test_torch_takes_the_interface_of_cuda(batch, torch):
    if batch.device == "cpu":
        pytest.skip("the memory of the CPU has no __cuda_array_interface__")
    assert torch.as_tensor(batch.positions, device="cuda").data_ptr() == address(batch.positions)
    assert torch.from_dlpack(batch.exploded).dtype == torch.bool
    assert batch.positions.__cuda_array_interface__["version"] == 3
    assert batch.positions.__cuda_array_interface__["stream"] == 1
    with pytest.raises(AttributeError):
        batch.positions.__array_interface__
    with pytest.raises(TypeError, match="memory of a GPU"):
        np.asarray(batch.positions)
    with pytest.raises(TypeError, match="memory of a GPU"):
        batch.positions[0]


def test_cupy_shares_memory(batch):
    cupy = pytest.importorskip("cupy")
    if batch.device == "cpu":
        pytest.skip("CuPy takes no memory of the CPU")
    assert cupy.from_dlpack(batch.positions).data.ptr == address(batch.positions)
    assert cupy.asarray(batch.positions).data.ptr == address(batch.positions)
    assert cupy.from_dlpack(batch.exploded).dtype == cupy.bool_


def test_jax_takes_arrays(batch):
    jax = pytest.importorskip("jax")
    try:
        array = jax.dlpack.from_dlpack(batch.positions)
    except (RuntimeError, ValueError) as error:  # such as a jaxlib without CUDA
        pytest.skip(str(error))
    assert np.array_equal(np.asarray(array), batch.positions.numpy())


def test_numpy_copy_has_the_values_and_memory_of_its_own(batch):
    batch.step(20)
    copy = batch.positions.numpy()
    assert copy.flags.writeable
    again = batch.positions.numpy()
    copy[:] = 0
    assert np.array_equal(batch.positions.numpy(), again)
    assert np.abs(again).max() > 0


def test_arrays_live_longer_than_their_batch(device):
    batch = mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device=device)
    batch.step(5)
    arrays = {name: getattr(batch, name) for name in [*STATE, "exploded"]}
    values = {name: array.numpy() for name, array in arrays.items()}
    drive = batch.actuation.drive
    del batch
    gc.collect()
    mercurysim.Batch(mercurysim.random_voxel(3, seed=2), device=device).step(5)  # takes memory that was freed
    for name, array in arrays.items():
        assert np.array_equal(array.numpy(), values[name])
    assert np.isnan(drive.numpy()).all()


def test_views_live_longer_than_array_and_batch(device):
    batch = mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device=device)
    values = batch.positions.numpy()
    if device == "cpu":
        views = [np.asarray(batch.positions), np.from_dlpack(batch.positions), batch.positions[1:]]
        expected = [values, values, values[1:]]
    else:
        views, expected = [pytest.importorskip("torch").from_dlpack(batch.positions)], [values]
    del batch
    gc.collect()
    for view, values in zip(views, expected):
        assert np.array_equal(view if device == "cpu" else view.cpu().numpy(), values)


def test_capsules_that_nobody_takes_release_the_memory(batch):
    for _ in range(3):
        capsule = batch.positions.__dlpack__()
        assert '"dltensor"' in repr(capsule)
        del capsule
        assert '"dltensor_versioned"' in repr(batch.positions.__dlpack__(max_version=(1, 0)))
    gc.collect()


# NumPy on the CPU


@pytest.fixture
def on_cpu():
    return mercurysim.Batch(mercurysim.random_voxel(3, seed=1), device="cpu")


def test_numpy_shares_memory_and_does_not_write(on_cpu):
    for name in [*STATE, "exploded"]:
        array = getattr(on_cpu, name)
        for view in [np.asarray(array), np.from_dlpack(array) if name != "exploded" else np.asarray(array)]:
            assert view.ctypes.data == address(array)
            assert not view.flags.writeable
            with pytest.raises(ValueError, match="read-only"):
                view[0] = 1
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_what_torch_writes_has_no_effect_on_robots(torch):
    batch, other = (mercurysim.Batch(mercurysim.random_voxel(2, seed=1), device="cpu") for _ in range(2))
    torch.from_dlpack(batch.positions)[:] = 7
    batch.step(10)
    other.step(10)
    assert list(batch.hashes()) == list(other.hashes())
    assert np.array_equal(batch.positions[:], other.positions[:])


def test_array_protocol(on_cpu):
    positions = on_cpu.positions
    assert np.asarray(positions, dtype=np.float32).ctypes.data == address(positions)
    assert np.asarray(positions, dtype=np.float64).dtype == np.float64
    assert np.array(positions).ctypes.data != address(positions)
    assert positions.__array__(copy=True).ctypes.data != address(positions)
    assert positions.__array__(copy=False).ctypes.data == address(positions)
    with pytest.raises(ValueError, match="copy is False"):
        positions.__array__(dtype="f8", copy=False)
    assert np.mean(positions) == np.mean(positions.numpy())


def test_arrays_take_part_in_expressions_of_numpy(on_cpu):
    centers = on_cpu.centers.numpy()
    assert np.array_equal(centers - on_cpu.centers, np.zeros((3, 3)))
    assert np.array_equal(on_cpu.centers - centers, np.zeros((3, 3)))
    assert not np.any(on_cpu.exploded)
    assert [row.tolist() for row in on_cpu.centers] == centers.tolist()
    with pytest.raises(ValueError, match="numpy.any"):
        bool(on_cpu.exploded)


def test_dlpack_copies_only_on_request(on_cpu):
    class Copied:
        def __init__(self, array, **options):
            self.array, self.options = array, options

        def __dlpack__(self, **options):
            return self.array.__dlpack__(**options, **self.options)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    positions = on_cpu.positions
    assert np.from_dlpack(Copied(positions, copy=True)).ctypes.data != address(positions)
    assert np.from_dlpack(Copied(positions, copy=False)).ctypes.data == address(positions)
    assert np.from_dlpack(Copied(positions, dl_device=(1, 0))).ctypes.data == address(positions)
    with pytest.raises(BufferError):
        positions.__dlpack__(dl_device=(2, 0))
    with pytest.raises(TypeError):
        positions.__dlpack__(dl_device=3)
    with pytest.raises(TypeError):
        positions.__dlpack__(1)


def test_dlpack_of_a_gpu_copies_to_the_cpu_on_request(batch):
    if batch.device == "cpu":
        pytest.skip("is about the memory of a GPU")
    with pytest.raises(BufferError):
        batch.positions.__dlpack__(dl_device=(1, 0), copy=False)
    with pytest.raises(BufferError):
        batch.positions.__dlpack__(copy=True)
    assert "dltensor" in repr(batch.positions.__dlpack__(dl_device=(1, 0)))


def test_host_arrays_have_no_interface_of_cuda(on_cpu):
    assert not hasattr(on_cpu.positions, "__cuda_array_interface__")
    assert on_cpu.positions.__array_interface__["version"] == 3


def test_arrays_cannot_be_pickled(on_cpu):
    with pytest.raises(TypeError, match="cannot be pickled"):
        pickle.dumps(on_cpu.positions)
    with pytest.raises(TypeError):
        mercurysim.Array()


def test_arrays_of_an_empty_batch(device):
    batch = mercurysim.Batch([], device=device)
    batch.step(3)
    assert batch.positions.shape == (0, 3)
    assert batch.positions.numpy().shape == (0, 3)
    assert batch.exploded.numpy().tolist() == []
    assert batch.actuation.drive.numpy().size == 0
    if device == "cpu":
        assert np.asarray(batch.positions).shape == (0, 3)
        assert np.from_dlpack(batch.centers).shape == (0, 3)


def test_old_arrays_keep_their_values_when_robots_come(batch):
    batch.step(10)
    old, values = batch.positions, batch.positions.numpy()
    batch.add(mercurysim.random_voxel(1, seed=9))
    assert batch.positions is not old
    assert batch.positions.shape[0] > old.shape[0]
    batch.step(10)
    assert np.array_equal(old.numpy(), values)


def test_streams_are_recognized(batch):
    class WithProtocol:
        def __cuda_stream__(self):
            return (0, 0)

    class OfTorch:
        cuda_stream = 0

    class OfCupy:
        ptr = 1

    for stream in [None, 0, 1, WithProtocol(), OfTorch(), OfCupy()]:
        batch.step(1, stream=stream)
    assert batch.steps == 6
    for stream in ["default", 1.0, True, -1, 2**70, object()]:
        with pytest.raises(TypeError, match="handle of a CUDA stream"):
            batch.step(1, stream=stream)
    assert batch.steps == 6


def test_steps_in_a_stream_of_torch_are_ordered(torch, device):
    if device == "cpu":
        pytest.skip("the CPU has no streams")
    robots = mercurysim.random_voxel(64, seed=1)
    expected = mercurysim.Batch(robots, device=device)
    batch = mercurysim.Batch(robots, device=device)
    expected.step(300)
    stream = torch.cuda.Stream()
    with torch.cuda.stream(stream):
        positions = torch.from_dlpack(batch.positions)
        for _ in range(3):
            batch.step(100, stream=stream)
        copy = positions.clone()
    other = torch.from_dlpack(batch.positions).clone()  # in the default stream: the array waits
    stream.synchronize()
    assert torch.equal(copy.cpu(), torch.from_numpy(expected.positions.numpy()))
    assert torch.equal(other.cpu(), copy.cpu())
    assert list(batch.hashes()) == list(expected.hashes())
