# SPDX-License-Identifier: Apache-2.0
"""Programs of others read what mercury export writes, and find the robot's numbers in it.

    export_readers_test.py MERCURY READER

READER is the name of a class below. Exit status 77: that reader is not installed.
"""

import importlib
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import page_reading

MERCURY = sys.argv[1]


def mercury(*arguments):
    return subprocess.run([MERCURY, *map(str, arguments), "--quiet"], check=True, capture_output=True, text=True).stdout


class Case(unittest.TestCase):
    """A robot, its recording, and what both are according to Mercury's own files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        mercury("new", "voxel", "--seed", 7, "--voxels", "4x3x3", "-o", self.folder / "eel.json")
        robot = json.loads((self.folder / "eel.json").read_text())
        self.masses = np.array(robot["masses"], np.float32)
        self.faces = np.array(robot["faces"])
        self.springs = np.array([spring[:2] for spring in robot["springs"]])
        self.spring_materials = np.array([spring[2] for spring in robot["springs"]])
        self.skin = np.unique(self.faces)  # the masses that the skin has, in the order of the vertices

    def export(self, name, *options):
        mercury("export", self.folder / "eel.json", "-o", self.folder / name, *options)
        return str(self.folder / name)

    def export_motion(self, name, *options):
        if not (self.folder / "swim.h5").exists():
            mercury("run", self.folder / "eel.json", "--seconds", 0.3, "--every", 20, "--device", "cpu",
                    "--record", self.folder / "swim.h5")
        mercury("export", self.folder / "swim.h5", "-o", self.folder / name, *options)
        return str(self.folder / name)

    def recorded(self):
        """Times, positions and velocities of the recording."""
        import h5py
        with h5py.File(self.folder / "swim.h5") as file:
            group = next(iter(file["particles"].values()))
            return group["position/time"][:], group["position/value"][:], group["velocity/value"][:]

    def volume(self):
        a, b, c = (self.masses[self.faces[:, i]].astype(float) for i in range(3))
        return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


class Trimesh(Case):
    needs = "trimesh"

    def test_volume_and_size_are_those_of_the_robot(self):
        import trimesh
        for name in ("eel.obj", "eel.ply", "eel.stl"):
            with self.subTest(name):
                mesh = trimesh.load(self.export(name), force="mesh")
                self.assertEqual(len(mesh.faces), len(self.faces))
                self.assertAlmostEqual(mesh.volume, self.volume(), 6)
                np.testing.assert_allclose(mesh.bounds, [self.masses.min(0), self.masses.max(0)], atol=1e-7)

    def test_faces_of_a_ply_have_the_colors_of_its_materials(self):
        import trimesh
        mesh = trimesh.load(self.export("eel.ply"), process=False)
        np.testing.assert_array_equal(np.asarray(mesh.vertices, np.float32), self.masses[self.skin])
        self.assertGreater(len(np.unique(mesh.visual.face_colors, axis=0)), 2)

    def test_glb_stands_upright(self):
        import trimesh
        scene = trimesh.load(self.export("eel.glb"))
        low, high = self.masses.min(0), self.masses.max(0)
        np.testing.assert_allclose(scene.bounds, [[low[0], low[2], -high[1]], [high[0], high[2], -low[1]]], atol=1e-6)
        self.assertEqual(sum(len(mesh.faces) for mesh in scene.geometry.values()), len(self.faces))


class Meshio(Case):
    needs = "meshio"

    def test_grid_has_points_cells_and_values(self):
        import meshio
        grid = meshio.read(self.export("eel.vtu"))
        np.testing.assert_array_equal(grid.points.astype(np.float32), self.masses)
        cells = {block.type: block.data for block in grid.cells}
        np.testing.assert_array_equal(cells["triangle"], self.faces)
        np.testing.assert_array_equal(cells["line"], self.springs)
        np.testing.assert_array_equal(grid.cell_data["material"][1], self.spring_materials)
        np.testing.assert_allclose(grid.cell_data["strain"][1], 0, atol=1e-5)  # it is at rest

    def test_series_has_every_frame_of_the_recording(self):
        import meshio
        self.export_motion("swim.pvd")
        times, positions, velocities = self.recorded()
        for frame, name in enumerate(sorted((self.folder / "swim-frames").iterdir())):
            grid = meshio.read(name)
            np.testing.assert_array_equal(grid.points.astype(np.float32), positions[frame])
            np.testing.assert_array_equal(grid.point_data["velocity"], velocities[frame])
            self.assertEqual(grid.field_data["TimeValue"], times[frame])
        self.assertEqual(frame + 1, len(times))

    def test_description_of_a_recording_plays_as_a_series(self):
        import meshio
        (self.folder / "below").mkdir()
        file = self.export_motion("below/swim.xdmf", "--every", 2)  # not beside the recording
        times, positions, velocities = (values[::2] for values in self.recorded())
        with meshio.xdmf.TimeSeriesReader(file) as reader:
            points, cells = reader.read_points_cells()
            np.testing.assert_array_equal(points, positions[0])
            self.assertEqual([block.type for block in cells], ["triangle"])
            np.testing.assert_array_equal(cells[0].data, self.faces)
            self.assertEqual(reader.num_steps, len(times))
            for frame in range(len(times)):
                time, of_points, _ = reader.read_data(frame)
                self.assertEqual(time, times[frame])
                np.testing.assert_array_equal(of_points["position"], positions[frame])
                np.testing.assert_array_equal(of_points["velocity"], velocities[frame])

    def test_surfaces_open_too(self):
        import meshio
        for name in ("eel.obj", "eel.stl"):  # meshio reads no .ply whose faces have colors
            with self.subTest(name):
                mesh = meshio.read(self.export(name))
                self.assertEqual(sum(len(block.data) for block in mesh.cells), len(self.faces))


class Pygltflib(Case):
    needs = "pygltflib"

    def test_motion_has_a_target_per_frame(self):
        import pygltflib
        gltf = pygltflib.GLTF2().load(self.export_motion("swim.glb"))
        times, positions, _ = self.recorded()

        def numbers(index):
            accessor = gltf.accessors[index]
            view = gltf.bufferViews[accessor.bufferView]
            width = {"SCALAR": 1, "VEC3": 3}[accessor.type]
            start = (view.byteOffset or 0) + (accessor.byteOffset or 0)
            return np.frombuffer(gltf.binary_blob()[start:start + 4 * width * accessor.count],
                                 np.float32).reshape(-1, width).squeeze()

        primitive = gltf.meshes[0].primitives[0]
        base = numbers(primitive.attributes.POSITION)
        np.testing.assert_array_equal(base, positions[0][self.skin])
        sampler = gltf.animations[0].samplers[0]
        np.testing.assert_allclose(numbers(sampler.input), times - times[0], rtol=1e-6)
        weights = numbers(sampler.output).reshape(len(times), -1)
        self.assertEqual(weights.shape[1], len(primitive.targets))
        for frame in range(len(times)):
            shape = base + sum(weight * numbers(target["POSITION"])
                               for weight, target in zip(weights[frame], primitive.targets))
            np.testing.assert_allclose(shape, positions[frame][self.skin], atol=1e-6)


    def test_scene_has_a_floor_and_a_camera_that_sees_everything(self):
        import pygltflib
        gltf = pygltflib.GLTF2().load(self.export_motion("swim.glb", "--floor", "--with-camera"))
        positions = self.recorded()[1][:, self.skin].reshape(-1, 3).astype(float)
        nodes = {node.name: node for node in gltf.nodes}
        self.assertEqual({gltf.nodes[child].name for child in gltf.nodes[0].children}, {"voxel-7-0", "floor", "camera"})
        floor = gltf.accessors[gltf.meshes[nodes["floor"].mesh].primitives[0].attributes.POSITION]
        self.assertLess(floor.max[2], positions[:, 2].min())
        x, y, z, w = nodes["camera"].rotation  # to the axes of the scene
        turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        seen = (positions - nodes["camera"].translation) @ turn
        perspective = gltf.cameras[0].perspective
        up = np.tan(perspective.yfov / 2)
        self.assertTrue((-seen[:, 2] > perspective.znear).all() and (-seen[:, 2] < perspective.zfar).all())
        self.assertTrue((np.abs(seen[:, 1]) < -seen[:, 2] * up).all())
        self.assertTrue((np.abs(seen[:, 0]) < -seen[:, 2] * up * perspective.aspectRatio).all())
        self.assertGreater(turn[2, 1], 0)  # up is up

    def test_curved_skins_have_normals_in_motion(self):
        import pygltflib
        mercury("new", "shell", "--seed", 3, "-o", self.folder / "shell.json")
        mercury("export", self.folder / "shell.json", "--seconds", 0.1, "-o", self.folder / "shell.glb")
        primitive = pygltflib.GLTF2().load(str(self.folder / "shell.glb")).meshes[0].primitives[0]
        self.assertIsNotNone(primitive.attributes.NORMAL)
        self.assertTrue(all("NORMAL" in target for target in primitive.targets))
        flat = pygltflib.GLTF2().load(self.export("eel.glb")).meshes[0].primitives[0]
        self.assertIsNone(flat.attributes.NORMAL)  # sides of voxels are flat

    def test_several_robots_stand_side_by_side_and_move(self):
        import pygltflib
        mercury("new", "voxel", "--seed", 8, "--voxels", "3x3x3", "-o", self.folder / "other.json")
        robots = [self.folder / "eel.json", self.folder / "other.json"]
        file = self.folder / "both.glb"
        mercury("export", *robots, "-o", file, "--seconds", 0.1, "--device", "cpu")
        gltf = pygltflib.GLTF2().load(str(file))
        first, second = (gltf.nodes[index] for index in gltf.nodes[0].children)
        self.assertEqual([first.name, second.name], [json.loads(robot.read_text())["name"] for robot in robots])
        apart = np.linalg.norm(np.subtract(first.translation, second.translation))
        width = np.ptp(self.masses, axis=0).max()
        self.assertGreater(apart, 0.5 * width)
        for mesh in gltf.meshes:
            self.assertEqual({len(primitive.targets) for primitive in mesh.primitives}, {3})  # after the first frame
        self.assertEqual([channel.target.node for channel in gltf.animations[0].channels], gltf.nodes[0].children)
        mercury("export", *robots, "-o", file, "--force")  # at rest
        still = pygltflib.GLTF2().load(str(file))
        self.assertEqual((len(still.meshes), len(still.animations)), (2, 0))


class Vtk(Case):
    needs = "vtkmodules.vtkIOXML"

    def test_grid_has_points_cells_and_values(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        self.export_motion("swim.pvd")
        times, positions, velocities = self.recorded()
        reader = vtkXMLUnstructuredGridReader()
        for frame, name in enumerate(sorted((self.folder / "swim-frames").iterdir())):
            reader.SetFileName(str(name))
            reader.Update()
            self.assertEqual(reader.GetErrorCode(), 0)
            grid = reader.GetOutput()
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), positions[frame])
            np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("velocity")), velocities[frame])
            self.assertEqual(grid.GetNumberOfCells(), len(self.faces) + len(self.springs))
            ends = positions[frame][self.springs].astype(float)
            rest = np.linalg.norm(np.diff(self.masses[self.springs].astype(float), axis=1)[:, 0], axis=1)
            strain = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / rest - 1
            found = vtk_to_numpy(grid.GetCellData().GetArray("strain"))[len(self.faces):]
            np.testing.assert_allclose(found, strain, atol=1e-5)


class Usd(Case):
    needs = "pxr"

    def test_stage_has_a_floor_and_a_camera_that_sees_everything(self):
        from pxr import Gf, Usd as usd, UsdGeom
        stage = usd.Stage.Open(self.export_motion("swim.usda", "--floor", "--with-camera"))
        positions = self.recorded()[1][:, self.skin].reshape(-1, 3)
        corners = np.array(UsdGeom.Mesh(stage.GetPrimAtPath("/floor")).GetPointsAttr().Get())
        self.assertEqual(len(corners), 4)
        self.assertLess(corners[0, 2], positions[:, 2].min())
        self.assertTrue((corners.min(0) < positions.min(0)).all() and (corners.max(0)[:2] > positions.max(0)[:2]).all())
        camera = UsdGeom.Camera(stage.GetPrimAtPath("/camera")).GetCamera(0)
        self.assertAlmostEqual(camera.frustum.ComputeAspectRatio(), 16 / 9, 4)
        for position in positions[::7]:
            self.assertTrue(camera.frustum.Intersects(Gf.Vec3d(*map(float, position))))
        self.assertFalse(usd.Stage.Open(self.export_motion("bare.usda")).GetPrimAtPath("/floor"))

    def test_curved_skins_have_normals(self):
        from pxr import Usd as usd, UsdGeom
        mercury("new", "nn", "--seed", 3, "-o", self.folder / "net.json")
        mercury("export", self.folder / "net.json", "-o", self.folder / "net.usda")
        stage = usd.Stage.Open(str(self.folder / "net.usda"))  # which its parts do not keep open
        mesh = UsdGeom.Mesh(stage.GetDefaultPrim().GetChild("skin"))
        points, normals = np.array(mesh.GetPointsAttr().Get()), np.array(mesh.GetNormalsAttr().Get())
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
        faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
        sums = np.zeros_like(points)
        for a, b, c in faces:
            area = np.cross(points[b] - points[a], points[c] - points[a])
            for vertex in (a, b, c):
                sums[vertex] += area
        sums /= np.linalg.norm(sums, axis=1, keepdims=True)
        np.testing.assert_allclose(normals, sums, atol=1e-4)
        flat_stage = usd.Stage.Open(self.export("eel.usda"))
        flat = UsdGeom.Mesh(flat_stage.GetDefaultPrim().GetChild("skin"))
        self.assertIsNone(flat.GetNormalsAttr().Get())  # sides of voxels are flat

    def test_stage_has_meters_z_up_and_a_time_code_per_frame(self):
        from pxr import Usd as usd, UsdGeom
        stage = usd.Stage.Open(self.export_motion("swim.usda", "--springs"))
        times, positions, _ = self.recorded()
        self.assertEqual(UsdGeom.GetStageMetersPerUnit(stage), 1)
        self.assertEqual(UsdGeom.GetStageUpAxis(stage), UsdGeom.Tokens.z)
        self.assertEqual((stage.GetStartTimeCode(), stage.GetEndTimeCode()), (0, len(times) - 1))
        self.assertAlmostEqual(stage.GetTimeCodesPerSecond(), (len(times) - 1) / (times[-1] - times[0]), 9)
        root = stage.GetDefaultPrim()
        mesh = UsdGeom.Mesh(root.GetChild("skin"))
        curves = UsdGeom.BasisCurves(root.GetChild("springs"))
        self.assertEqual(mesh.GetPointsAttr().GetTimeSamples(), list(range(len(times))))
        for frame, expected in enumerate(positions):
            points = mesh.GetPointsAttr().Get(frame)
            np.testing.assert_array_equal(np.array(points), expected)
            np.testing.assert_array_equal(np.array(mesh.GetExtentAttr().Get(frame)), [expected.min(0), expected.max(0)])
            np.testing.assert_array_equal(np.array(curves.GetPointsAttr().Get(frame)), expected[self.springs].reshape(-1, 3))
        np.testing.assert_array_equal(np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3), self.faces)
        self.assertEqual(set(mesh.GetFaceVertexCountsAttr().Get()), {3})
        self.assertEqual(sum(curves.GetCurveVertexCountsAttr().Get()), 2 * len(self.springs))

    def test_each_face_has_a_color(self):
        from pxr import Usd as usd, UsdGeom
        stage = usd.Stage.Open(self.export("eel.usda"))
        mesh = UsdGeom.Mesh(stage.GetDefaultPrim().GetChild("skin"))
        np.testing.assert_array_equal(np.array(mesh.GetPointsAttr().Get()), self.masses[self.skin])
        color = mesh.GetDisplayColorPrimvar()
        self.assertEqual(color.GetInterpolation(), UsdGeom.Tokens.uniform)
        self.assertEqual(len(color.Get()), len(self.faces))
        self.assertGreater(len(set(map(tuple, color.Get()))), 2)


    def test_archives_hold_the_same(self):
        from pxr import Usd as usd, UsdGeom
        stage = usd.Stage.Open(self.export_motion("swim.usdz"))
        mesh = UsdGeom.Mesh(stage.GetDefaultPrim().GetChild("skin"))
        for frame, expected in enumerate(self.recorded()[1]):
            np.testing.assert_array_equal(np.array(mesh.GetPointsAttr().Get(frame)), expected[self.skin])
        content = (self.folder / "swim.usdz").read_bytes()
        self.assertEqual(content.index(b"#usda") % 64, 0)

    def test_velocities_are_those_of_the_recording(self):
        from pxr import Usd as usd, UsdGeom
        stage = usd.Stage.Open(self.export_motion("swim.usda"))
        mesh = UsdGeom.Mesh(stage.GetDefaultPrim().GetChild("skin"))
        for frame, expected in enumerate(self.recorded()[2]):
            np.testing.assert_array_equal(np.array(mesh.GetVelocitiesAttr().Get(frame)), expected[self.skin])

    def test_each_face_has_a_material_of_its_color(self):
        from pxr import Usd as usd, UsdGeom, UsdShade
        stage = usd.Stage.Open(self.export("eel.usda"))
        mesh = UsdGeom.Mesh(stage.GetDefaultPrim().GetChild("skin"))
        subsets = UsdShade.MaterialBindingAPI(mesh).GetMaterialBindSubsets()
        valid, reason = UsdGeom.Subset.ValidateSubsets(subsets, len(self.faces), UsdGeom.Tokens.partition)
        self.assertTrue(valid, reason)
        colors = mesh.GetDisplayColorPrimvar().Get()
        for subset in subsets:
            material = UsdShade.MaterialBindingAPI(subset).ComputeBoundMaterial()[0]
            surface = material.ComputeSurfaceSource()[0]
            color = surface.GetInput("diffuseColor").Get()
            for face in subset.GetIndicesAttr().Get():
                np.testing.assert_allclose(color, colors[face], rtol=1e-6)

    def test_several_robots_are_prims_of_their_own(self):
        from pxr import Usd as usd, UsdGeom
        mercury("new", "voxel", "--seed", 8, "--voxels", "3x3x3", "-o", self.folder / "other.json")
        robots = [self.folder / "eel.json", self.folder / "other.json"]
        mercury("export", *robots, "-o", self.folder / "both.usda", "--seconds", 0.1, "--device", "cpu")
        stage = usd.Stage.Open(str(self.folder / "both.usda"))
        self.assertEqual(stage.GetTimeCodesPerSecond(), 30)
        first, second = stage.GetDefaultPrim().GetChildren()
        places = [np.array(UsdGeom.XformCommonAPI(prim).GetXformVectors(0)[0]) for prim in (first, second)]
        self.assertGreater(np.linalg.norm(places[0] - places[1]), 0.5 * np.ptp(self.masses, axis=0).max())
        for prim in (first, second):
            self.assertEqual(len(UsdGeom.Mesh(prim.GetChild("skin")).GetPointsAttr().GetTimeSamples()), 4)


class VtkXdmf(Case):
    needs = "vtkmodules.vtkIOXdmf2"

    def test_reader_finds_the_recording(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline
        from vtkmodules.vtkIOXdmf2 import vtkXdmfReader
        reader = vtkXdmfReader()
        reader.SetFileName(self.export_motion("swim.xdmf", "--every", 2))
        reader.UpdateInformation()
        steps = reader.GetExecutive().GetOutputInformation(0)
        times, positions, velocities = (values[::2] for values in self.recorded())
        self.assertEqual(steps.Length(Pipeline.TIME_STEPS()), len(times))
        for frame, time in enumerate(times):
            self.assertEqual(steps.Get(Pipeline.TIME_STEPS(), frame), time)
            reader.UpdateTimeStep(time)
            springs, skin = (reader.GetOutputDataObject(0).GetBlock(block) for block in range(2))
            for grid in (skin, springs):
                np.testing.assert_array_equal(vtk_to_numpy(grid.GetPoints().GetData()), positions[frame])
                np.testing.assert_array_equal(vtk_to_numpy(grid.GetPointData().GetArray("velocity")), velocities[frame])
            self.assertEqual(skin.GetNumberOfCells(), len(self.faces))
            np.testing.assert_array_equal(vtk_to_numpy(springs.GetCellData().GetArray("material")), self.spring_materials)


class XdmfItems(Case):
    """What the description refers to, by the rules of XDMF, through h5py."""

    needs = "h5py"

    def item(self, folder, element):
        import h5py
        file, _, path = element.text.partition(":")
        with h5py.File(folder / file) as recording:
            values = recording[path][()]
        kind = {"Float": "f", "UInt": "u", "UChar": "u"}[element.get("NumberType")] + element.get("Precision")
        self.assertEqual(values.dtype, np.dtype(kind))
        self.assertEqual(values.shape, tuple(int(n) for n in element.get("Dimensions").split()))
        return values

    def test_items_are_the_frames(self):
        from xml.etree import ElementTree
        (self.folder / "below").mkdir()
        file = Path(self.export_motion("below/swim.xdmf", "--every", 3))  # not beside the recording
        times, positions, velocities = (values[::3] for values in self.recorded())
        springs, skin = ElementTree.parse(file).getroot().find("Domain")
        for series, cells in ((skin, self.faces), (springs, self.springs)):
            self.assertEqual(len(series), len(times))
            for grid, time, position, velocity in zip(series, times, positions, velocities):
                self.assertEqual(float(grid.find("Time").get("Value")), time)
                topology = grid.find("Topology")
                self.assertEqual(topology.get("NumberOfElements"), str(len(cells)))
                np.testing.assert_array_equal(self.item(file.parent, topology[0]), cells)
                np.testing.assert_array_equal(self.item(file.parent, grid.find("Geometry")[0]), position)
                for name, values in (("position", position), ("velocity", velocity)):
                    item = grid.find(f"Attribute[@Name='{name}']")[0]
                    np.testing.assert_array_equal(self.item(file.parent, item), values)
        material = springs[0].find("Attribute[@Name='material']")
        np.testing.assert_array_equal(self.item(file.parent, material[0]), self.spring_materials)


class WebPage(Case):
    """What the page holds, without a browser; page_test.py opens it in one."""

    needs = "h5py"

    def test_positions_are_within_a_quarter_of_a_millimeter(self):
        mercury("run", self.folder / "eel.json", "--seconds", 0.5, "--every", 40, "--device", "cpu", "--record",
                self.folder / "swim.h5")
        page = page_reading.Page(Path(self.export_motion("swim.html")))
        times, recorded, _ = self.recorded()
        robot = page.robots[0]
        self.assertEqual(robot["step"], 0.0005)
        np.testing.assert_allclose(robot["start"] + np.arange(robot["frames"]) / robot["rate"], times, atol=1e-9)
        np.testing.assert_allclose(page.positions(0), recorded, atol=0.00025 + 1e-6)
        tables = page.tables(0)
        np.testing.assert_array_equal(tables["faces"], self.faces)
        np.testing.assert_array_equal(tables["springs"][:, :2], self.springs)
        lengths = np.linalg.norm(self.masses[self.springs[:, 0]] - self.masses[self.springs[:, 1]], axis=1)
        np.testing.assert_allclose(tables["springs"][:, 2] * robot["rest_step"], lengths, atol=robot["rest_step"] / 2 + 1e-6)

    def test_many_frames_per_second_are_thinned_to_30(self):
        mercury("run", self.folder / "eel.json", "--seconds", 0.5, "--every", 1, "--device", "cpu", "--record",
                self.folder / "swim.h5")
        page = page_reading.Page(Path(self.export_motion("swim.html")))
        times, recorded, _ = self.recorded()
        self.assertEqual((page.robots[0]["rate"], page.robots[0]["frames"]), (30, 16))
        for frame, shown in enumerate(page.positions(0)):
            expected = [[np.interp(frame / 30, times, recorded[:, mass, axis]) for axis in range(3)]
                        for mass in range(recorded.shape[1])]
            np.testing.assert_allclose(shown, expected, atol=0.00025 + 2e-6)

    def test_sizes_and_hash(self):
        def exported(*robots):
            mercury("export", *robots, "--seconds", 10, "--device", "cpu", "-o", self.folder / "robots.html", "--force")
            return page_reading.Page(self.folder / "robots.html")
        page = exported("sample:paper/eel")
        print("viewer", page.viewer_bytes(), "B; eel,", page.robots[0]["masses"], "masses, 10 s:", len(page.text), "B")
        self.assertLessEqual(page.viewer_bytes(), 100_000)
        self.assertLessEqual(len(page.text) * 336 / page.robots[0]["masses"], 1_000_000)
        result = json.loads(mercury("run", "sample:paper/eel", "--seconds", 10, "--device", "cpu", "--json"))
        facts = dict(page.robots[0]["facts"])
        self.assertEqual(facts["final state"], result["robots"][0]["hash"] + " at 10 s")
        six = exported(*(f"sample:paper/{name}" for name in ("eel", "fish", "manta", "squid", "ray", "turtle")))
        print("six robots:", len(six.text), "B")
        self.assertLessEqual(len(six.text), 4_000_000)

    def test_names_cannot_break_the_page(self):
        robot = json.loads((self.folder / "eel.json").read_text())
        robot["name"] = "</script><b>&\"{{page}}"
        (self.folder / "eel.json").write_text(json.dumps(robot))
        page = page_reading.Page(Path(self.export_motion("swim.html")))
        self.assertEqual(page.robots[0]["name"], robot["name"])
        self.assertNotIn("<b>", page.text)


if __name__ == "__main__":
    case = globals()[sys.argv[2]]
    try:
        importlib.import_module(case.needs)
    except ImportError as error:
        print(f"skipped: {error}")
        sys.exit(77)
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(case)
    sys.exit(0 if unittest.TextTestRunner(verbosity=1).run(suite).wasSuccessful() else 1)
