# SPDX-License-Identifier: Apache-2.0
"""A recording as others see it, through h5py alone: H5MD 1.1, its units and time axis; the numbers are those of a second
run bit for bit; and the file holds enough to run it again.

    recording_h5py_test.py MERCURY
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

MERCURY = sys.argv.pop()
OPTIONS = ["--seed", "3", "--seconds", "0.3", "--device", "cpu", "--quiet"]


def mercury(*arguments):
    return subprocess.run([MERCURY, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def text(value):
    return value.decode() if isinstance(value, bytes) else value


def robot_document(group):
    """The robot file of a recorded robot, from the recording alone."""
    names = [text(name) for name in group["material_names"]] if "material_names" in group else None
    materials = []
    for i, (stiffness, amplitude, frequency, phase) in enumerate(group["materials"][()].tolist()):
        materials.append({"name": names[i] if names else f"material {i}", "stiffness": stiffness,
                          "amplitude": amplitude, "frequency": frequency, "phase": phase})
    springs = zip(group["springs"][()].tolist(), group["spring_material"][()].tolist(),
                  group["spring_rest_length"][()].tolist())
    return {"format": "mercury-robot", "version": 1, "name": text(group.attrs["name"]), "materials": materials,
            "masses": group["rest_position"][()].tolist(), "faces": group["faces"][()].tolist(),
            "springs": [[a, b, material, length] for (a, b), material, length in springs]}


def options_of(parameters):
    """The program's options that give the recorded configuration."""
    options = []
    for name, value in parameters.attrs.items():
        if name in ("format", "device_name", "seed"):
            continue
        if name == "self_collision":
            options += [] if value else ["--no-self-collision"]
            continue
        words = ",".join(repr(float(x)) for x in value) if np.ndim(value) else text(value)
        options.append(f"--{name.replace('_', '-')}={words}")
    return options


class Recording(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return Path(self.folder.name) / name

    def record(self, name, *options, robots=("--random", "voxel:3")):
        mercury("run", *robots, *OPTIONS, "--record", self.path(name), "--force", *options)
        file = h5py.File(self.path(name))
        self.addCleanup(file.close)
        return file

    def assert_same_frames(self, a, b):
        self.assertEqual(list(a["particles"]), list(b["particles"]))
        for robot in a["particles"]:
            for element in ("position", "velocity"):
                first, second = a[f"particles/{robot}/{element}/value"][()], b[f"particles/{robot}/{element}/value"][()]
                self.assertEqual(first.tobytes(), second.tobytes(), f"{robot} {element}")

    def test_is_h5md(self):
        file = self.record("a.h5", "--every", 10)
        self.assertEqual(file["h5md"].attrs["version"].tolist(), [1, 1])
        self.assertEqual(file["h5md/creator"].attrs["name"], b"mercury")
        self.assertTrue(file["h5md/creator"].attrs["version"])
        self.assertTrue(file["h5md/author"].attrs["name"])
        self.assertEqual(file["h5md/modules/units"].attrs["version"].tolist(), [1, 0])
        self.assertEqual(file["h5md/modules/units"].attrs["system"], "SI")
        for name, robot in file["particles"].items():
            self.assertEqual(robot["box"].attrs["dimension"], 3)
            self.assertEqual(robot["box"].attrs["boundary"].tolist(), [b"none"] * 3)
            connectivity = file["connectivity"][name]
            for element, count in (("springs", 2), ("faces", 3)):
                self.assertEqual(connectivity[element].shape[1], count)
                self.assertEqual(file[connectivity[element].attrs["particles_group"]], robot)
                self.assertEqual(connectivity[element], robot[element])

    def test_shapes_units_and_time_axis(self):
        file = self.record("a.h5", "--every", 7, "--dt", "0.002")
        self.assertEqual(len(file["particles"]), 3)
        for robot in file["particles"].values():
            masses = len(robot["rest_position"])
            for element, unit in (("position", "m"), ("velocity", "m s-1")):
                series = robot[element]
                self.assertEqual(series["value"].shape, (22, masses, 3))
                self.assertEqual(series["value"].dtype, np.float32)
                self.assertEqual(series["value"].attrs["unit"], unit)
                self.assertEqual(series["step"][()].tolist(), list(range(0, 150, 7)))
                np.testing.assert_allclose(series["time"], 0.002 * series["step"][()], rtol=1e-15)
                self.assertEqual(series["time"].attrs["unit"], "s")
            self.assertEqual(robot["mass"].shape, (masses,))
            self.assertTrue((robot["mass"][()] == 1).all())
            self.assertEqual(robot["mass"].attrs["unit"], "kg")
            self.assertEqual(robot["rest_position"].attrs["unit"], "m")
            self.assertEqual(robot["spring_rest_length"].attrs["unit"], "m")
            self.assertLess(robot["springs"][()].max(), masses)
            np.testing.assert_array_equal(robot["position/value"][0], robot["rest_position"])

    def test_senses_and_neurons_are_observables_with_names(self):
        hunter = ["sample:hunter", "--target", "1,2,0"]
        file = self.record("a.h5", "--every", 10, "--brains", robots=hunter)
        self.assertEqual(list(file["observables"]), list(file["particles"]))
        (robot,) = file["observables"].values()
        body = json.loads(mercury("info", "sample:hunter", "--json"))["robots"][0]["brain"]
        for element in ("senses", "neurons"):
            series = robot[element]
            self.assertEqual([text(name) for name in series["name"]], body[element])
            self.assertEqual(series["value"].shape, (31, len(body[element])))
            self.assertEqual(series["value"].dtype, np.float32)
            self.assertEqual(series["step"], file["parameters/step"])
            self.assertEqual(series["time"][()].tolist(), file["parameters/time"][()].tolist())
            self.assertGreater(np.ptp(series["value"], axis=0).max(), 0.1)
        without = self.record("b.h5", "--every", 10, robots=hunter)
        self.assertNotIn("observables", without)
        self.assert_same_frames(file, without)

    def test_velocities_are_those_of_the_positions(self):
        # v = zeta (x' - x) / dt with zeta = exp(-damping dt); positions are rounded to float.
        file = self.record("a.h5", "--every", 1, "--damping", "0.5")
        robot = next(iter(file["particles"].values()))
        x, v = robot["position/value"][()].astype(float), robot["velocity/value"][()].astype(float)
        expected = np.exp(-0.5e-3) * np.diff(x, axis=0) / 1e-3
        np.testing.assert_allclose(v[1:], expected, atol=2e-4)
        self.assertGreater(abs(v).max(), 0.01)

    def test_positions_are_those_of_a_second_run(self):
        every = self.record("a.h5", "--every", 1, "--threads", 1)
        tenth = self.record("b.h5", "--every", 10, "--compress")
        for robot in every["particles"]:
            for element in ("position", "velocity"):
                name = f"particles/{robot}/{element}/value"
                self.assertEqual(every[name][::10].tobytes(), tenth[name][()].tobytes())

    def test_last_frame_is_the_final_state(self):
        report = json.loads(mercury("run", "--random", "voxel:3", *OPTIONS, "--record", self.path("a.h5"), "--every", 300,
                                    "--json"))
        with h5py.File(self.path("a.h5")) as file:
            for robot in report["robots"]:
                group = file["particles"][robot["name"]]
                hashed = 0xCBF29CE484222325
                for byte in group["position/value"][-1].tobytes() + group["velocity/value"][-1].tobytes():
                    hashed = (hashed ^ byte) * 0x100000001B3 % 2**64
                self.assertEqual(robot["hash"], f"{hashed:016x}")

    def test_holds_enough_to_run_it_again(self):
        for options in (["--environment", "land", "--friction", "0.3", "--solver", "xpbd"],
                        ["--environment", "land", "--no-self-collision", "--gravity", "0.5,0,-3"],
                        ["--flow", "0.1,0,0", "--density", "900", "--dt", "0.0007"],
                        ["--environment", "ocean-simple", "--point-drag", "2.5", "--damping", "0.2"]):
            with self.subTest(options):
                first = self.record("a.h5", "--every", 25, *options)
                for name, group in first["particles"].items():
                    self.path(name + ".json").write_text(json.dumps(robot_document(group)))
                second = self.record("b.h5", *options_of(first["parameters"]),
                                     robots=[self.path(name + ".json") for name in first["particles"]])
                self.assert_same_frames(first, second)
                first.close()
                second.close()

    def test_nothing_outside_the_file_is_read(self):
        """External links, external storage and virtual datasets lead to a pipe, which nobody writes to."""
        self.record("whole.h5").close()
        pipe = self.path("pipe.h5")
        os.mkfifo(pipe)

        def replaced(change):
            with h5py.File(self.path("whole.h5")) as whole, h5py.File(self.path("changed.h5"), "w", libver="latest") as changed:
                for name in whole:
                    whole.copy(name, changed)
                robot = changed["particles"][list(changed["particles"])[0]]
                rest = robot["rest_position"][()]
                del robot["rest_position"]
                change(robot, rest)
            result = subprocess.run([MERCURY, "info", str(self.path("changed.h5"))], capture_output=True, text=True, timeout=60)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            return result.stderr

        def link(robot, rest):
            robot["rest_position"] = h5py.ExternalLink(str(pipe), "/a")

        def soft_link(robot, rest):
            robot["other"] = rest
            robot["rest_position"] = h5py.SoftLink("/particles/pipe")
            robot.file["particles/pipe"] = h5py.ExternalLink(str(pipe), "/a")

        def storage(robot, rest):
            robot.create_dataset("rest_position", rest.shape, rest.dtype, external=[(str(pipe), 0, rest.nbytes)])

        def virtual(robot, rest):
            layout = h5py.VirtualLayout(rest.shape, rest.dtype)
            layout[:] = h5py.VirtualSource(str(pipe), "a", rest.shape)
            robot.create_virtual_dataset("rest_position", layout)

        self.assertIn("is a link", replaced(link))
        self.assertIn("is a link", replaced(soft_link))
        self.assertIn("has its values in other files", replaced(storage))
        self.assertIn("has its values in other files", replaced(virtual))

    def test_a_recording_that_was_killed_opens_with_the_frames_so_far(self):
        options = ["--random", "voxel:2", "--seed", "3", "--device", "cpu", "--threads", "1", "--every", "1"]
        messages = open(self.path("messages"), "w+")
        self.addCleanup(messages.close)
        child = subprocess.Popen([MERCURY, "run", *options, "--seconds", "1e6", "--record", self.path("a.h5")],
                                 stdout=subprocess.DEVNULL, stderr=messages)
        self.addCleanup(child.kill)
        while True:  # as another program watches a run
            if child.poll() is not None:
                said = Path(messages.name).read_text()
                if child.returncode == -9 or "memory" in said or "disk is full" in said:  # -9: the kernel found no more
                    self.skipTest("the machine ran out of memory or disk: " + said)
                self.fail(f"the run ended with {child.returncode}: {said}")
            part = next(iter(Path(self.folder.name).glob("a.h5.*.part")), None)
            try:
                with h5py.File(part, swmr=True) as file:
                    if len(file["parameters/step"]) > 0:
                        break
            except (OSError, TypeError, AttributeError):  # not yet
                pass
        child.kill()
        child.wait()
        with h5py.File(part, swmr=True) as killed:
            frames = len(killed["parameters/step"])
            self.assertEqual(killed["parameters/step"][()].tolist(), list(range(frames)))
            whole = self.record("b.h5", "--every", 1, "--threads", 1, robots=("--random", "voxel:2"))
            frames = min(frames, len(whole["parameters/step"]))
            for name in killed["particles"]:
                for element in ("position", "velocity"):
                    path = f"particles/{name}/{element}/value"
                    self.assertEqual(killed[path][:frames].tobytes(), whole[path][:frames].tobytes())


if __name__ == "__main__":
    unittest.main()
