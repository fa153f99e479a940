# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest

import mercurysim


def test_a_block_of_voxels_has_a_mass_at_each_corner_and_is_centered():
    robot = mercurysim.voxel(np.ones((3, 2, 1), np.uint8), edge=0.2, name="block")
    assert robot.name == "block"
    assert robot.masses.shape == (4 * 3 * 2, 3)
    np.testing.assert_allclose(robot.masses.max(axis=0), [0.3, 0.2, 0.1], atol=1e-6)
    np.testing.assert_allclose(robot.masses.min(axis=0), [-0.3, -0.2, -0.1], atol=1e-6)


def test_air_is_left_out():
    grid = np.ones((3, 1, 1), np.uint8)
    grid[1:] = 0
    assert mercurysim.voxel(grid).masses.shape == (8, 3)


def test_own_materials_move_the_robot():
    def travel(amplitude):
        materials = np.array([[0, 0, 0, 0], [50, amplitude, 6, 0]], np.float32)
        batch = mercurysim.Batch(mercurysim.voxel(np.ones((2, 1, 1), np.uint8), materials=materials), device="cpu")
        before = np.array(batch.positions)
        batch.step(100)
        return np.abs(np.asarray(batch.positions) - before).max()

    assert travel(0) < 1e-6  # rest lengths are distances in single precision, so the robot is at rest within rounding
    assert travel(0.2) > 1e-3


@pytest.mark.parametrize(
    "grid, options, message",
    [
        (np.zeros((2, 2, 2), np.uint8), {}, "air"),
        (np.full((1, 1, 1), 23, np.uint8), {}, "23"),
        (np.ones((0, 1, 1), np.uint8), {}, "voxel grid"),
        (np.ones((1, 1, 1), np.uint8), {"edge": 0.0}, "edge"),
        (np.ones((1, 1, 1), np.uint8), {"materials": np.zeros((1, 4), np.float32)}, "materials: 1 rows"),
        (np.ones((1, 1, 1), np.uint8), {"materials": np.full((2, 4), np.nan, np.float32)}, "materials: row 1"),
    ],
)
def test_bad_grids_are_refused_in_one_line(grid, options, message):
    with pytest.raises(mercurysim.InputError, match=message) as error:
        mercurysim.voxel(grid, **options)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "grid, options, error, message",
    [
        (np.ones((2, 2)), {}, mercurysim.InputError, r"^grid: must have the shape \(x, y, z\), not \(2, 2\)$"),
        (None, {}, TypeError, "^grid: must be an array of numbers, not of object$"),
        (np.ones((1, 1, 1), complex), {}, TypeError, "^grid: must be an array of numbers, not of complex128$"),
        (np.full((1, 1, 1), 257), {}, mercurysim.InputError, "^grid: material 257.0 is not accepted; give 0 to 22$"),
        (np.full((1, 1, 1), 1.5), {}, mercurysim.InputError, "^grid: material 1.5 is not accepted"),
        (np.full((1, 1, 1), np.nan), {}, mercurysim.InputError, "^grid: material nan is not accepted"),
        (np.full((1, 1, 1), -1), {}, mercurysim.InputError, "^grid: material -1.0 is not accepted"),
        (np.ones((1, 1, 1)), {"edge": "wide"}, TypeError, "^edge: must be a number, not str$"),
        (np.ones((1, 1, 1)), {"edge": 1e300}, mercurysim.InputError, "edge"),
        (np.ones((1, 1, 1)), {"name": None}, TypeError, "^name: must be a text, not NoneType$"),
    ],
)
def test_values_of_the_wrong_kind_are_refused_in_one_line(grid, options, error, message):
    with pytest.raises(error, match=message) as caught:
        mercurysim.voxel(grid, **options)
    assert "\n" not in str(caught.value)


def test_layouts_and_types_of_grids_do_not_matter():
    grid = np.random.default_rng(1).integers(1, 23, (4, 3, 2))
    expected = mercurysim.voxel(grid)
    for other in (grid.tolist(), grid.astype(np.uint8), grid.astype(float), np.asfortranarray(grid), grid[::-1][::-1]):
        assert mercurysim.voxel(other) == expected
