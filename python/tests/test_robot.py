# SPDX-License-Identifier: Apache-2.0
import copy
import gc
import json
import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import mercurysim
from mercurysim import InputError, Robot

TETRAHEDRON = np.array([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]])
SPRINGS = np.array([[0, 1, 1], [0, 2, 2], [0, 3, 21], [1, 2, 21], [1, 3, 21], [2, 3, 21]])
FACES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def tetrahedron(**changes):
    parts = {"masses": TETRAHEDRON, "springs": SPRINGS, "faces": FACES, "name": "tetrahedron"}
    return Robot(**{**parts, **changes})


def test_arrays_come_back_as_they_were_given():
    robot = tetrahedron()
    assert robot.name == "tetrahedron"
    np.testing.assert_array_equal(robot.masses, TETRAHEDRON.astype(np.float32))
    np.testing.assert_array_equal(robot.faces, FACES)
    for column, name in enumerate(["a", "b", "material"]):
        np.testing.assert_array_equal(robot.springs[name], SPRINGS[:, column])
    ends = robot.masses[robot.springs["a"]], robot.masses[robot.springs["b"]]
    np.testing.assert_allclose(robot.springs["rest_length"], np.linalg.norm(ends[1] - ends[0], axis=1), rtol=1e-6)


def test_the_views_rebuild_the_robot():
    robot = mercurysim.random_voxel(seed=3)[0]
    again = Robot(robot.masses, robot.springs, robot.faces, robot.materials, name=robot.name)
    assert again.body_hash == robot.body_hash
    for name in ("masses", "springs", "faces", "materials"):
        np.testing.assert_array_equal(getattr(again, name), getattr(robot, name))


def test_rest_lengths_are_taken_from_a_fourth_column():
    lengths = np.linspace(0.05, 0.2, 6)
    robot = tetrahedron(springs=np.column_stack([SPRINGS, lengths]))
    np.testing.assert_array_equal(robot.springs["rest_length"], lengths.astype(np.float32))


def test_layouts_and_types_of_arrays_do_not_matter():
    expected = tetrahedron()
    reversed_twice = TETRAHEDRON[::-1][::-1]
    for masses in (TETRAHEDRON.tolist(), np.asfortranarray(TETRAHEDRON), reversed_twice, TETRAHEDRON.astype(">f8"),
                   TETRAHEDRON.astype(np.float32)):
        for springs in (SPRINGS.tolist(), SPRINGS.astype(np.uint8), SPRINGS.astype(float), np.asfortranarray(SPRINGS)):
            assert tetrahedron(masses=masses, springs=springs) == expected


def test_a_structured_array_of_materials():
    table = np.zeros(3, dtype=[("stiffness", "f4"), ("amplitude", "f4"), ("frequency", "f8"), ("phase", "f4")])
    table["stiffness"], table["amplitude"], table["frequency"] = [0, 100, 200], [0, 0.25, 0], [0, 6, 0]
    springs = SPRINGS.copy()
    springs[:, 2] = [1, 1, 2, 2, 2, 2]
    robot = tetrahedron(materials=table, springs=springs)
    np.testing.assert_array_equal(robot.materials, [[0, 0, 0, 0], [100, 0.25, 6, 0], [200, 0, 0, 0]])


def test_half_waves_are_a_fifth_column():
    table = np.array([[0, 0, 0, 0, 0], [100, 0.25, 6, 0, 1], [200, 0, 0, 0, 0]], np.float32)
    springs = SPRINGS.copy()
    springs[:, 2] = [1, 1, 2, 2, 2, 2]
    robot = tetrahedron(materials=table, springs=springs)
    np.testing.assert_array_equal(robot.materials, table[:, :4])
    assert robot.half_wave.dtype == bool and robot.half_wave.tolist() == [False, True, False]
    assert not tetrahedron(materials=table[:, :4], springs=springs).half_wave.any()
    assert tetrahedron(materials=table[:, :4], springs=springs) != robot
    assert [material["half_wave"] for material in robot.info()["materials"]] == [True, False]
    fields = ["stiffness", "amplitude", "frequency", "phase", "half_wave"]
    structured = np.zeros(3, dtype=[(field, "f4") for field in fields])
    for field, column in zip(fields, table.T, strict=True):
        structured[field] = column
    assert tetrahedron(materials=structured, springs=springs) == robot
    assert pickle.loads(pickle.dumps(robot)) == robot
    table[1, 4] = 0.5
    with pytest.raises(mercurysim.InputError, match=r"/materials/1: half_wave must be 0 or 1, not 0.5"):
        tetrahedron(materials=table, springs=springs)


def test_relaxation_times_are_a_sixth_column():
    table = np.array([[0, 0, 0, 0, 0, 0], [100, 0.25, 6, 0, 1, 0.02], [200, 0, 0, 0, 0, 0.5]], np.float32)
    springs = SPRINGS.copy()
    springs[:, 2] = [1, 1, 2, 2, 2, 2]
    robot = tetrahedron(materials=table, springs=springs)
    np.testing.assert_array_equal(robot.relaxation_time, table[:, 5])
    np.testing.assert_array_equal(robot.materials, table[:, :4])
    assert not tetrahedron(materials=table[:, :5], springs=springs).relaxation_time.any()
    assert tetrahedron(materials=table[:, :5], springs=springs) != robot
    assert [material["relaxation_time"] for material in robot.info()["materials"]] == table[1:, 5].tolist()
    # A field that is missing before one that is there is zero.
    fields = ["stiffness", "amplitude", "frequency", "phase", "relaxation_time"]
    structured = np.zeros(3, dtype=[(field, "f4") for field in fields])
    for field, column in zip(fields, table[:, [0, 1, 2, 3, 5]].T, strict=True):
        structured[field] = column
    table[:, 4] = 0
    assert tetrahedron(materials=structured, springs=springs) == tetrahedron(materials=table, springs=springs)
    assert pickle.loads(pickle.dumps(robot)) == robot
    table[1, 5] = -1
    with pytest.raises(InputError, match=r"/materials/1: relaxation_time must be a finite number >= 0 s"):
        tetrahedron(materials=table, springs=springs)


def test_masses_velocities_and_fixed_points():
    plain = tetrahedron()
    np.testing.assert_array_equal(plain.mass, np.ones(4, np.float32))
    np.testing.assert_array_equal(plain.velocity, np.zeros((4, 3), np.float32))
    assert plain.fixed.dtype == np.uint16 and plain.fixed.tolist() == []
    mass, velocity = np.array([0.5, 1, 2, 3], np.float32), np.arange(12, dtype=np.float32).reshape(4, 3)
    robot = tetrahedron(mass=mass, velocity=velocity, fixed=[3, 0])
    np.testing.assert_array_equal(robot.mass, mass)
    np.testing.assert_array_equal(robot.velocity, velocity)
    assert robot.fixed.tolist() == [3, 0]
    assert robot != plain and robot.body_hash != plain.body_hash
    assert pickle.loads(pickle.dumps(robot)) == robot
    for name in ("mass", "velocity", "fixed"):
        assert getattr(robot, name).ctypes.data == getattr(robot, name).ctypes.data
        assert not getattr(robot, name).flags.writeable
    one_for_all = tetrahedron(mass=0.25, velocity=[0, 0, 1], fixed=np.array([True, False, False, True]))
    assert one_for_all.mass.tolist() == [0.25] * 4
    assert one_for_all.velocity.tolist() == [[0, 0, 1]] * 4
    assert one_for_all.fixed.tolist() == [0, 3]


def test_info_says_mass_and_vibrations():
    # w = sqrt(k (1/m + 1/m')), and the force solver is stable up to 2 / w.
    robot = Robot([[0, 0, 0], [0.1, 0, 0]], [[0, 1, 1]], materials=[[0, 0, 0, 0], [30, 0, 0, 0]], mass=[0.5, 2])
    info = robot.info()
    w = np.sqrt(30 * (1 / 0.5 + 1 / 2))
    assert info["mass"] == 2.5 and info["density"] is None and info["modulus"] is None
    assert info["lowest_frequency"] == pytest.approx(w / (2 * np.pi))
    assert info["largest_dt"] == pytest.approx(2 / w)
    cube = mercurysim.voxel(np.ones((1, 1, 1), np.uint8), edge=0.1).info()
    assert cube["density"] == pytest.approx(8 / 0.1**3)
    assert cube["modulus"] == pytest.approx(8 * 50 / 0.1)


@pytest.mark.parametrize(("arguments", "message"), [
    ({"mass": [1, 1]}, r"mass: must have the shape (4,), one per mass, not (2,)"),
    ({"mass": [1, 1, 0, 1]}, "/mass/2: a mass must be a finite number above 0 kg"),
    ({"mass": float("nan")}, "/mass/0: a mass must be a finite number above 0 kg"),
    ({"velocity": np.zeros((3, 3))}, r"velocity: must have the shape (4, 3), one per mass, not (3, 3)"),
    ({"velocity": np.zeros(4)}, r"velocity: must have the shape (4, 3), one per mass, not (4,)"),
    ({"velocity": [0, 0, float("inf")]}, "/velocity/0: a velocity must be finite"),
    ({"fixed": [4]}, "fixed: mass 4 is out of range, the robot has 4"),
    ({"fixed": [1, 1]}, "/fixed/1: mass 1 is listed twice"),
    ({"fixed": [0.5]}, "fixed: mass 0.5 is not a whole number"),
    ({"fixed": [True]}, "fixed: a mask of 1 masses is not accepted, the robot has 4"),
    ({"fixed": 0}, "fixed: must be a list of mass indices, or a mask with one bool per mass"),
])
def test_what_masses_may_not_be(arguments, message):
    with pytest.raises(InputError) as refused:
        tetrahedron(**arguments)
    assert str(refused.value) == message


def test_fixed_points_stay_and_a_start_velocity_moves():
    robot = tetrahedron(velocity=[0.5, 0, 0], fixed=[0])
    batch = mercurysim.Batch(robot, device="cpu")
    np.testing.assert_array_equal(batch.velocities.numpy()[:2], np.array([[0, 0, 0], [0.5, 0, 0]], np.float32))
    batch.step(10)
    np.testing.assert_array_equal(batch.positions.numpy()[0], np.zeros(3))
    assert batch.positions.numpy()[1, 0] > TETRAHEDRON[1, 0]


def test_the_robot_copies_what_it_is_given():
    masses = TETRAHEDRON.astype(np.float32)
    robot = tetrahedron(masses=masses)
    masses[:] = 7
    np.testing.assert_array_equal(robot.masses, TETRAHEDRON.astype(np.float32))


@pytest.mark.parametrize("name", ["masses", "springs", "faces", "materials", "half_wave", "relaxation_time"])
def test_views_are_read_only_and_share_memory(name):
    robot = tetrahedron()
    view = getattr(robot, name)
    assert view.ctypes.data == getattr(robot, name).ctypes.data
    with pytest.raises(ValueError, match="read-only"):
        view[0] = view[1]
    with pytest.raises(ValueError):
        view.flags.writeable = True


def test_views_keep_the_robot():
    views = [getattr(tetrahedron(), name) for name in ("masses", "springs", "faces", "materials")]
    expected = [view.copy() for view in views]
    gc.collect()
    for _ in range(100):
        tetrahedron(masses=TETRAHEDRON + 1)
    for view, before in zip(views, expected, strict=True):
        np.testing.assert_array_equal(view, before)


def test_a_robot_without_springs_and_faces():
    robot = Robot([[0, 0, 0]], [])
    assert (len(robot.springs), robot.faces.shape, robot.materials.shape) == (0, (0, 3), (254, 4))


def nan(array, value=np.nan):
    changed = np.array(array, dtype=float)
    changed[-1, -1] = value
    return changed


@pytest.mark.parametrize(
    "changes, error, message",
    [
        ({"masses": np.zeros((3, 8))}, InputError, r"^masses: must have the shape \(n, 3\), not \(3, 8\)$"),
        ({"masses": np.zeros(12)}, InputError, r"^masses: must have the shape \(n, 3\), not \(12,\)$"),
        ({"masses": np.zeros((4, 3, 1))}, InputError, r"^masses: must have the shape \(n, 3\), not \(4, 3, 1\)$"),
        ({"masses": 5}, InputError, r"^masses: must have the shape \(n, 3\), not \(\)$"),
        ({"masses": []}, InputError, "^/masses: a robot needs at least one mass$"),
        ({"masses": None}, TypeError, "^masses: must be an array of numbers, not of object$"),
        ({"masses": "abc"}, TypeError, "^masses: must be an array of numbers, not of <U3$"),
        ({"masses": np.zeros((4, 3), complex)}, TypeError, "^masses: must be an array of numbers, not of complex128$"),
        ({"masses": np.zeros((4, 3), bool)}, TypeError, "^masses: must be an array of numbers, not of bool$"),
        ({"masses": np.zeros((4, 3), object)}, TypeError, "^masses: must be an array of numbers, not of object$"),
        ({"masses": np.zeros((4, 3), "M8[s]")}, TypeError, "^masses: must be an array of numbers, not of datetime64"),
        ({"masses": [[0, 0, 0], [1, 2]]}, InputError, "^masses: must be an array of numbers: "),
        ({"masses": np.zeros((70000, 3))}, InputError, "^/masses: 70000 masses, at most 65535 are accepted$"),
        ({"masses": nan(TETRAHEDRON)}, InputError, "^/masses/3: a position must be finite"),
        ({"masses": nan(TETRAHEDRON, 1e300)}, InputError, "^/masses/3: a position must be finite"),
        ({"springs": np.zeros((6, 5), int)}, InputError, r"^springs: must have the shape \(n, 3\) or \(n, 4\), not \(6, 5\)$"),
        ({"springs": None}, TypeError, "^springs: must be an array of numbers, not of object$"),
        ({"springs": [[0, 4, 1]]}, InputError, "^/springs/0: mass 4 is out of range, the robot has 4$"),
        ({"springs": [[0, 70000, 1]]}, InputError, "^/springs/0: mass 70000 is out of range, the robot has 4$"),
        ({"springs": [[0, 65537, 1]]}, InputError, "^/springs/0: mass 65537 is out of range, the robot has 4$"),
        ({"springs": [[-1, 1, 1]]}, InputError, "^/springs/0: mass -1 is out of range, the robot has 4$"),
        ({"springs": [[0, 1, 1], [0, 1.5, 1]]}, InputError, "^/springs/1: mass 1.5 is not a whole number$"),
        ({"springs": [[np.nan, 1, 1]]}, InputError, "^/springs/0: mass nan is not a whole number$"),
        ({"springs": [[np.inf, 1, 1]]}, InputError, "^/springs/0: mass inf is not a whole number$"),
        ({"springs": [[0, 1e19, 1]]}, InputError, "^/springs/0: mass 10000000000000000000 is out of range, the robot has 4$"),
        ({"springs": [[0, 0, 1]]}, InputError, "^/springs/0: joins mass 0 to itself$"),
        ({"springs": [[0, 1, 0]]}, InputError, "^/springs/0: material 0 is air, a spring needs another$"),
        ({"springs": [[0, 1, 254]]}, InputError, "^/springs/0: material 254 is out of range, the table has 254$"),
        ({"springs": [[0, 1, 257]]}, InputError, "^/springs/0: material 257 is out of range, the table has 254$"),
        ({"springs": [[0, 1, 1, np.nan]]}, InputError, "^/springs/0: rest length nan m, at least 0.001 m is accepted$"),
        ({"springs": np.zeros(2, [("a", int), ("b", int)])}, InputError, '^springs: the field "material" is missing$'),
        ({"springs": np.zeros(2, [("a", int), ("b", int), ("materiel", int)])}, InputError,
         '^springs: has no field "materiel"; did you mean material\\?$'),
        ({"springs": np.zeros(2, [("a", "U3"), ("b", int), ("material", int)])}, TypeError,
         r'^springs\["a"\]: must be an array of numbers, not of <U3$'),
        ({"springs": np.zeros((2, 2), [("a", int), ("b", int), ("material", int)])}, InputError,
         "^springs: a structured array must have the shape"),
        ({"faces": [[0, 1, 4]]}, InputError, "^/faces/0: mass 4 is out of range, the robot has 4$"),
        ({"faces": [[0, 1, 65536]]}, InputError, "^/faces/0: mass 65536 is out of range, the robot has 4$"),
        ({"faces": [[0, 1, 1]]}, InputError, "^/faces/0: a face needs three different masses$"),
        ({"materials": []}, InputError, "^/materials: a table needs at least row 0, which stands for air$"),
        ({"materials": np.zeros((257, 4))}, InputError, "^/materials: 257 materials, at most 256 are accepted$"),
        ({"materials": np.zeros((22, 3))}, InputError, r"^materials: must have the shape \(n, 4\) to \(n, 6\), not \(22, 3\)$"),
        ({"materials": nan(np.zeros((22, 4)))}, InputError, "^/materials/21: "),
        ({"name": 5}, TypeError, "^name: must be a text, not int$"),
        ({"name": "\ud800"}, InputError, "^name: is not valid Unicode$"),
        ({"actuators": [1, 2]}, TypeError, "^actuators: must be a dict of names and spring indices, not list$"),
        ({"actuators": {1: [1]}}, TypeError, "^actuators: must be a text, not int$"),
        ({"actuators": {"fin": [6]}}, InputError, "^actuator fin: spring 6 is out of range, the robot has 6$"),
        ({"actuators": {"fin": [-1]}}, InputError, "^actuator fin: spring -1 is out of range, the robot has 6$"),
        ({"actuators": {"fin": [1.5]}}, InputError, "^actuator fin: spring 1.5 is not a whole number$"),
        ({"actuators": {"fin": [2**40]}}, InputError, "^actuator fin: spring 1099511627776 is out of range"),
        ({"actuators": {"fin": 3}}, InputError, "^actuator fin: must be a list of spring indices, or a mask"),
        ({"actuators": {"fin": [True, False]}}, InputError, "^actuator fin: a mask of 2 springs is not accepted, the robot has 6$"),
        ({"actuators": {"fin": []}}, InputError, "an actuator needs at least one material or spring$"),
        ({"actuators": {"": [0]}}, InputError, "an actuator needs a name"),
        ({"actuators": {"a": [2], "b": [2]}}, InputError, "^actuator b: springs of material .* have an actuator already$"),
    ],
)
def test_bad_parts_are_refused_in_one_line(changes, error, message):
    with pytest.raises(error, match=message) as caught:
        tetrahedron(**changes)
    assert "\n" not in str(caught.value)
    assert type(caught.value) is error


class Hostile:
    """What NumPy cannot make an array of, such as a tensor in the memory of a GPU."""

    def __init__(self, error):
        self.error = error

    def __array__(self, *_, **__):
        raise self.error

    __len__ = __index__ = __float__ = __array__


def test_errors_of_other_libraries_become_one_line_or_pass():
    with pytest.raises(TypeError, match="^masses: must be an array of numbers: cuda:0 is no place for NumPy$"):
        tetrahedron(masses=Hostile(TypeError("cuda:0 is no place for NumPy\nsecond line")))
    with pytest.raises(InputError, match="^springs: must be an array of numbers: ragged$"):
        tetrahedron(springs=Hostile(ValueError("ragged")))
    for error in (KeyboardInterrupt, MemoryError, ZeroDivisionError):
        for call in (lambda bad: tetrahedron(faces=bad), lambda bad: tetrahedron(actuators={"fin": bad}),
                     lambda bad: mercurysim.random_voxel(seed=bad), lambda bad: mercurysim.Ocean(density=bad)):
            with pytest.raises(error):
                call(Hostile(error()))


def test_a_dict_of_actuators_may_change_while_it_is_read():
    class Clears:
        def __array__(self, *_, **__):
            actuators.clear()
            actuators.update({str(i): [0] for i in range(1000)})
            gc.collect()
            return np.array([0])

    actuators = {"fin": Clears(), "tail": [1]}
    assert list(tetrahedron(actuators=actuators).actuators) == ["fin", "tail"]


def test_hostile_arrays_make_a_robot_or_an_error():
    """Random numbers of random types and shapes. A robot that is accepted has the numbers that were given."""
    chance = np.random.default_rng(1)
    numbers = [0, 1, 2, 3, 4, 21, -1, 0.5, 255, 256, 65535, 65536, 2.0**31, 2.0**63, 1e39, np.nan, np.inf, -np.inf]
    types = ["f2", "f4", "f8", "i1", "u2", "i4", "u8", "?", "c8", "U2", "O"]

    def hostile(columns):
        shape = [(chance.integers(0, 5), columns + chance.integers(-1, 2)), (chance.integers(0, 5), columns)][chance.integers(2)]
        array = chance.choice(numbers[: chance.integers(4, len(numbers) + 1)], shape)
        with np.errstate(all="ignore"):
            array = array.astype(types[chance.integers(3 if chance.random() < 0.7 else len(types))])
        return array[:: chance.choice([1, -1, 2])] if chance.random() < 0.3 else array

    accepted = 0
    for _ in range(5000):
        masses = hostile(3) if chance.random() < 0.3 else chance.random((4, 3))
        springs = hostile(3 + chance.integers(2)) if chance.random() < 0.8 else SPRINGS
        faces = hostile(3) if chance.random() < 0.5 else FACES
        try:
            robot = Robot(masses, springs, faces)
        except (InputError, TypeError) as error:
            assert "\n" not in str(error)
            continue
        accepted += 1
        for i, spring in enumerate(robot.springs):
            assert [spring["a"], spring["b"], spring["material"]] == list(springs[i][:3])
        np.testing.assert_array_equal(robot.faces, np.reshape(faces, (-1, 3)))
    assert 100 < accepted < 4900


def test_actuators_by_index_and_by_mask():
    by_index = tetrahedron(actuators={"left": [0, 3], "right": [1]})
    mask = np.zeros((2, 6), bool)
    mask[0, [0, 3]] = mask[1, 1] = True
    by_mask = tetrahedron().with_actuators({"left": mask[0], "right": mask[1]})
    assert by_index == by_mask
    assert list(by_index.actuators) == ["left", "right"]
    for name, springs in {"left": [0, 3], "right": [1]}.items():
        driven = np.isin(by_index.springs["material"], by_index.actuators[name])
        np.testing.assert_array_equal(np.flatnonzero(driven), springs)
    before = tetrahedron()
    np.testing.assert_array_equal(by_index.materials[by_index.springs["material"]],
                                  before.materials[before.springs["material"]])


def test_with_actuators_replaces_those_of_the_robot():
    robot = tetrahedron(actuators={"fin": [0]})
    assert list(robot.with_actuators({"tail": [0, 1]}).actuators) == ["tail"]
    assert list(robot.actuators) == ["fin"]


def test_muscles_that_move_alike_are_one_actuator_by_default():
    robot = tetrahedron()
    moving = {tuple(robot.materials[i][2:]) for i in robot.springs["material"] if robot.materials[i][1] != 0}
    assert len(robot.actuators) == len(moving) == 2


@pytest.mark.parametrize("extension", ["json", "cbor"])
def test_files_give_the_robot_again(tmp_path, extension):
    robot = mercurysim.random_voxel(seed=5)[0]
    robot.save(tmp_path / f"robot.{extension}")
    assert mercurysim.load(tmp_path / f"robot.{extension}") == robot
    assert mercurysim.load(str(tmp_path / f"robot.{extension}")).origin == robot.origin


def test_samples_have_names():
    assert mercurysim.load("sample:eel").name == "eel"
    with pytest.raises(InputError, match="^sample:ell: there is no such sample; give .*paper/beetle, .*did you mean eel"):
        mercurysim.load("sample:ell")


def test_a_folder_gives_its_robots_sorted_by_file(tmp_path):
    robots = mercurysim.random_voxel(3)
    for robot, name in zip(robots, "cab", strict=True):
        robot.save(tmp_path / f"{name}.json")
    assert mercurysim.load(tmp_path) == [robots[1], robots[2], robots[0]]


def test_files_that_cannot_be_used(tmp_path):
    with pytest.raises(InputError, match="missing.json: "):
        mercurysim.load(tmp_path / "missing.json")
    (tmp_path / "eel.json").write_text('{"format": "mercury robot"}')
    with pytest.raises(InputError, match="eel.json: "):
        mercurysim.load(tmp_path / "eel.json")
    with pytest.raises(InputError, match="robot.txt"):
        tetrahedron().save(tmp_path / "robot.txt")
    with pytest.raises(TypeError, match=r"^path: must be a path \(str or os.PathLike\), not int$"):
        mercurysim.load(3)
    with pytest.raises(TypeError, match=r"^path: must be a path \(str or os.PathLike\), not NoneType$"):
        tetrahedron().save(None)


def test_the_program_reads_what_python_writes(tmp_path, mercury):
    robots = mercurysim.random_voxel(2, seed=9)
    for robot in robots:
        robot.save(tmp_path / f"{robot.name}.cbor")
    report = json.loads(mercury("run", tmp_path, "--seconds", "0.5", "--device", "cpu", "--json", "--quiet"))
    batch = mercurysim.Batch(mercurysim.load(tmp_path), device="cpu")
    batch.step(500)
    assert [int(robot["hash"], 16) for robot in report["robots"]] == [batch.hash(0), batch.hash(1)]


def test_the_program_describes_a_robot_as_python_does(tmp_path, mercury):
    robot = mercurysim.random_voxel(1, seed=9)[0]
    robot.save(tmp_path / "a.json")
    [described] = json.loads(mercury("info", "--json", tmp_path / "a.json"))["robots"]
    info = robot.info()
    assert described.keys() - info.keys() == {"file", "name", "kind", "environment", "actuators", "brain", "chip"}
    for key, value in info.items():
        if key == "materials":
            assert [use["name"] for use in described[key]] == [use.pop("name") for use in value]
            for mine, other in zip(described[key], value):
                assert other == pytest.approx({name: mine[name] for name in other}, rel=1e-6)
        elif isinstance(value, str):
            assert described[key] == value
        else:
            assert described[key] == pytest.approx(list(value) if isinstance(value, tuple) else value, rel=1e-6), key


def test_mutants_and_crosses_depend_on_their_arguments_alone():
    a, b = mercurysim.random_voxel(2, seed=4)
    assert a.mutate(seed=7) == a.mutate(seed=7)
    assert a.mutate(seed=7).body_hash != a.mutate(seed=8).body_hash
    assert a.mutate(seed=7).name == "voxel-4-0-m7"
    assert a.mutate(name="child").name == "child"
    assert a.mutate(strength=0, muscles=1).faces.tolist() == a.faces.tolist()
    assert a.cross(b, seed=2) == a.cross(b, seed=2)
    assert a.cross(b, seed=2).name == "voxel-4-0-x2"
    assert a.cross(b).origin["ancestry"]["parents"] == [a.name, b.name]


@pytest.mark.parametrize(
    "call, error, message",
    [
        (lambda robot: robot.mutate(strength=-1), InputError, "^strength: -1 is not accepted; give 0 or more$"),
        (lambda robot: robot.mutate(strength=float("nan")), InputError, "^strength: nan is not accepted"),
        (lambda robot: robot.mutate(strength="much"), TypeError, "^strength: must be a number, not str$"),
        (lambda robot: robot.mutate(strength=0), InputError, "^strength, muscles: both are 0"),
        (lambda robot: robot.mutate(seed=-1), InputError, "^seed: -1 is not accepted; give a whole number of 0 to"),
        (lambda robot: robot.mutate(seed=2**64), InputError, "^seed: 18446744073709551616 is not accepted"),
        (lambda robot: robot.mutate(seed=10**5000), InputError, "^seed: a number this large is not accepted"),
        (lambda robot: robot.mutate(seed=1.5), TypeError, "^seed: must be a whole number, not float$"),
        (lambda robot: robot.mutate(seed=True), TypeError, "^seed: must be a whole number, not bool$"),
        (lambda robot: robot.cross(5), TypeError, "^other: must be a Robot, not int$"),
        (lambda robot: robot.cross(tetrahedron()), InputError, "^tetrahedron: cannot be crossed"),
        (lambda robot: tetrahedron(name="").mutate(), InputError, "^a robot without a name: cannot be mutated"),
        (lambda robot: tetrahedron().mutate(), InputError, "^tetrahedron: cannot be mutated"),
    ],
)
def test_mutations_and_crosses_that_cannot_be(call, error, message):
    with pytest.raises(error, match=message):
        call(mercurysim.random_voxel()[0])


def test_origin_says_how_a_robot_was_made():
    assert mercurysim.random_voxel()[0].origin["kind"] == "voxel"
    assert tetrahedron().origin is None


def test_a_real_body_is_that_of_the_generator():
    paper = mercurysim.random_voxel(1, seed=3)[0]
    made = mercurysim.random_voxel(1, seed=3, physics="real", modulus=2e5, body_density=900, relaxation_time=0.02)[0]
    real = paper.with_real_body(2e5, body_density=900, relaxation_time=0.02)
    for field in ("masses", "mass", "springs", "faces", "materials", "relaxation_time"):
        assert np.array_equal(getattr(real, field), getattr(made, field)), field
    assert real.info()["physics"] == "real" and paper.info()["physics"] == "paper"
    with pytest.raises(mercurysim.InputError, match="the robot has a real body already"):
        real.with_real_body()


def test_materials_of_a_real_body_may_differ():
    solid = tetrahedron()
    springs = [(spring["a"], spring["b"], 1) for spring in solid.springs]
    robot = mercurysim.Robot(solid.masses, springs, solid.faces, [[0, 0, 0, 0], [50, 0.1, 6, 0]])
    light = robot.with_real_body([0, 1e5], body_density=[0, 500], relaxation_time=[0, 0.01])
    heavy = robot.with_real_body([0, 3e5], body_density=[0, 1500], relaxation_time=[0, 0])
    assert heavy.info()["mass"] == pytest.approx(3 * light.info()["mass"])
    assert heavy.info()["mass"] == pytest.approx(1500 * robot.info()["volume"], rel=1e-5)
    assert heavy.materials[1, 0] == pytest.approx(3 * light.materials[1, 0])
    assert light.relaxation_time[1] == np.float32(0.01) and heavy.relaxation_time[1] == 0
    with pytest.raises(mercurysim.InputError, match="^modulus: 3 numbers, and the robot has 2 materials; give one"):
        robot.with_real_body([0, 1, 2])
    with pytest.raises(mercurysim.InputError, match="^modulus: one number beside a list; give one per material, too"):
        robot.with_real_body(1e5, body_density=[0, 1])
    with pytest.raises(TypeError, match=r"^modulus\[1\]: must be a number, not str"):
        robot.with_real_body([0, "x"])


def test_info_measures_a_tetrahedron():
    info = tetrahedron().info()
    assert (info["masses"], info["springs"], info["faces"], info["muscles"]) == (4, 6, 4, 2)
    assert info["closed"] and info["euler_characteristic"] == 2
    assert info["volume"] == pytest.approx(0.1**3 / 6, rel=1e-6)
    assert info["extent"] == pytest.approx((0.1, 0.1, 0.1))
    assert {use["name"]: use["springs"] for use in info["materials"]} == {"muscle 1": 1, "muscle 2": 1, "tissue": 4}


def test_repr_names_and_counts():
    assert repr(tetrahedron()) == "Robot 'tetrahedron': 4 masses, 6 springs, 4 faces, 2 actuators"
    large = Robot(np.random.default_rng(1).random((1500, 3)), [])
    assert repr(large).startswith("Robot '': 1,500 masses, 0 springs")


def test_equality_and_hashes():
    robot = tetrahedron()
    assert robot == tetrahedron() and hash(robot) == hash(tetrahedron())
    assert robot != tetrahedron(name="other") and robot.body_hash == tetrahedron(name="other").body_hash
    assert robot != tetrahedron(masses=TETRAHEDRON * 2)
    assert robot != 5 and not robot == None  # noqa: E711
    assert len({robot, tetrahedron(), tetrahedron(name="other")}) == 2


def test_pickles_and_copies_are_equal():
    for robot in (mercurysim.random_voxel(seed=2)[0], tetrahedron(), Robot([[0, 0, 0]], [])):
        assert pickle.loads(pickle.dumps(robot)) == robot
        assert copy.copy(robot) is robot and copy.deepcopy(robot) is robot


def test_a_broken_pickle_is_refused():
    robot = Robot.__new__(Robot)
    with pytest.raises(TypeError), pytest.warns(RuntimeWarning, match="uninitialized"):
        robot.masses
    with pytest.raises(InputError):
        robot.__setstate__(b"abc")
    with pytest.raises(TypeError):
        robot.__setstate__(5)


def test_a_robot_cannot_be_changed():
    robot = tetrahedron()
    for name in ("name", "masses", "springs", "origin", "body_hash"):
        with pytest.raises(AttributeError):
            setattr(robot, name, None)


def test_threads_may_share_robots(tmp_path):
    robots = mercurysim.random_voxel(8, seed=6)

    def work(i):
        robot = robots[i % 8]
        robot.save(tmp_path / f"{i}.cbor")
        again = mercurysim.load(tmp_path / f"{i}.cbor")
        child = robot.cross(robots[(i + 1) % 8], seed=i).mutate(seed=i)
        return again == robot, child.body_hash, robot.masses.sum()

    alone = [work(i) for i in range(64)]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(work, range(64))) == alone
    assert all(same for same, *_ in alone)


def test_load_imports_files_of_other_simulators(tmp_path):
    structure = "<X_Voxels>2</X_Voxels><Y_Voxels>1</Y_Voxels><Z_Voxels>1</Z_Voxels>"
    material = "<Name>Muscle</Name><Mechanical><Elastic_Mod>1e5</Elastic_Mod><Density>1000</Density><CTE>0.01</CTE></Mechanical>"
    thermal = ("<TempEnabled>1</TempEnabled><VaryTempEnabled>1</VaryTempEnabled><TempAmplitude>20</TempAmplitude>"
               "<TempPeriod>1</TempPeriod>")
    (tmp_path / "pair.vxa").write_text(
        f"<VXA><Environment><Thermal>{thermal}</Thermal></Environment><VXC><Palette><Material>{material}</Material></Palette>"
        f'<Structure Compression="ASCII_READABLE">{structure}<Data><Layer>11</Layer></Data></Structure></VXC></VXA>')
    robot = mercurysim.load(tmp_path / "pair.vxa")
    assert robot.name == "pair"
    assert len(robot.masses) == 12
    assert robot.origin["cells"] == [1, 1]
    (tmp_path / "bad.vxa").write_text("<VXA/>")
    with pytest.raises(mercurysim.InputError, match="bad.vxa: /VXA: has no element VXC"):
        mercurysim.load(tmp_path / "bad.vxa")


def test_members_of_a_file_that_this_version_does_not_know_are_kept(tmp_path):
    robot = mercurysim.random_voxel(1, seed=1)[0]
    robot.save(tmp_path / "plain.json")
    document = json.loads((tmp_path / "plain.json").read_text())
    document |= {"lab": {"strain": [1, 2.5, None, True], "name": "B\u00e4r"}, "weight": 3}
    (tmp_path / "noted.json").write_text(json.dumps(document))
    noted = mercurysim.load(tmp_path / "noted.json")
    for path in ("again.json", "again.cbor"):
        noted.save(tmp_path / path)
        noted = mercurysim.load(tmp_path / path)
    pickle.loads(pickle.dumps(noted.with_actuators({"a": [0]}))).save(tmp_path / "last.json")
    last = json.loads((tmp_path / "last.json").read_text())
    assert last["lab"] == document["lab"] and last["weight"] == 3
    robot.save(tmp_path / "plain.json")
    assert noted != robot and set(json.loads((tmp_path / "plain.json").read_text())) == set(document) - {"lab", "weight"}


def test_robots_of_a_run():
    run = Path(__file__).parents[2] / "tests/data/run-of-version-0.2"
    second = mercurysim.load(run, robot=1)
    assert second.name == "run-of-version-0.2-1"
    best = mercurysim.load(run, robot="best")
    elites = mercurysim.load(run, robot="elites")
    assert elites[0] == best and len(elites) == 4  # its population
    assert mercurysim.load(run, robot=[1, "best"]) == [second, best]
    assert [robot.name for robot in mercurysim.load(run)] == ["two-3"]  # as its file in best/ names it
    for choice, message in [
        (99, '^robot: "99" is not accepted; give best, elites, champions, or one of the 12 robots of'),
        ("worst", '^robot: "worst" is not accepted'),
    ]:
        with pytest.raises(InputError, match=message):
            mercurysim.load(run, robot=choice)
    with pytest.raises(InputError, match="this is none$"):
        mercurysim.load(run.parent, robot=1)
