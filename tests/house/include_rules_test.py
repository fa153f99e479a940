# SPDX-License-Identifier: Apache-2.0
"""The include rules hold in this repository, the drawing shows them, and a breach of each rule is seen."""

import sys
import tempfile
import unittest
from pathlib import Path

import include_rules

ROOT = Path(__file__).resolve().parents[2]
SIM, ROBOTS = "sim/include/mercury", "robots/include/mercury"


def problems(files):
    """What the rules say of a tree of these files: {path: text}."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for path, text in files.items():
            (root / path).parent.mkdir(parents=True, exist_ok=True)
            (root / path).write_text(text)
        return include_rules.check(root)[1]


class IncludeRules(unittest.TestCase):
    def test_this_repository_keeps_them(self):
        count, found = include_rules.check(ROOT)
        self.assertGreater(count, 20)
        self.assertEqual(found, [])

    def test_what_is_allowed_is_not_reported(self):
        self.assertEqual(problems({
            f"{SIM}/robot.h": "#pragma once\n#include <vector>\n",
            f"{SIM}/simulation.h": '#pragma once\n#include <vector>\n#include "mercury/robot.h"\n',
            f"{SIM}/host_device.h": "#ifdef __CUDACC__\n#endif\n",
            f"{ROBOTS}/voxel.h": '#include "mercury/robot.h"\n',
            "sim/cuda/step.cu": '#include <cuda_runtime.h>\n#include "mercury/simulation.h"\n#include "sim/physics/a.h"\n',
            "sim/physics/a.h": "",
            "robots/voxel.cpp": '#include <nlohmann/json.hpp>\n#include "mercury/voxel.h"\n#include "mercury/robot.h"\n',
            "robots/alpha.cpp": "#include <CGAL/Alpha_shape_3.h>\n",
            "render/context.cpp": '#include <epoxy/egl.h>\n#include "render/png.h"\n',
            "render/png.h": "",
            "render/png.cpp": '#include <png.h>\n#include "render/png.h"\n',
            "app/video/bridge.cpp": '#include <cuda_gl_interop.h>\n#include "mercury/simulation.h"\n#include "render/png.h"\n',
            "app/video/version.cpp": '#include "app/base/version.h"\n',
            "tests/sim/step.h": "",
            "tests/sim/step_test.cpp": '#include <fstream>\n#include "sim/physics/a.h"\n#include "step.h"\n',
            "examples/a/main.cpp": "#include <mercury/simulation.h>\n",
        }), [])

    def test_two_headers_define_no_type_of_one_name(self):
        map_of = "#pragma once\nnamespace mercury {\nstruct Map {\n  int cells;\n};\n}  // namespace mercury\n"
        tree = {"robots/map.h": map_of, "app/scene/map.h": map_of.replace("mercury", "mercury::test"),
                "app/live/map.cpp": map_of}
        self.assertEqual(problems(tree), [])
        tree["app/live/map.h"] = map_of
        self.assertEqual(problems(tree), ["robots/map.h:3: app/live/map.h defines mercury::Map, too"])

    def test_a_header_of_another_folder_brings_no_heavy_library(self):
        tree = {"app/base/a.h": '#include "app/base/b.h"\n', "app/base/b.h": "#include <nlohmann/json.hpp>\n",
                "app/base/own.cpp": '#include "app/base/a.h"\n'}
        self.assertEqual(problems(tree), [])
        tree["app/scene/c.cpp"] = '#include "app/base/a.h"\n'
        self.assertEqual(problems(tree), [
            "app/base/a.h:1: app/scene/c.cpp gets app/base/b.h > nlohmann/json.hpp through it: "
            "hide the library in a source"])
        tree["app/base/b.h"] = "#include <nlohmann/json_fwd.hpp>\n"
        self.assertEqual(problems(tree), [])

    def test_breaches_are_reported_with_file_and_line(self):
        self.assertEqual(
            problems({"sim/step.cpp": '#include <vector>\n#include "app/scene/view.h"\n', "app/scene/view.h": ""}),
            ["sim/step.cpp:2: sim/ may not include app/scene/ (app/scene/view.h)"])

    def test_every_rule_sees_a_breach(self):
        there = {path: "" for path in (
            f"{SIM}/simulation.h", f"{SIM}/robot.h", f"{SIM}/vec3.h", f"{ROBOTS}/voxel.h", "sim/cpu/step.h",
            "sim/cuda/step.h", "sim/physics/muscle.h", "sim/parts.h", "robots/document.h", "render/scene.h",
            "app/base/a.h", "app/scene/a.h", "app/live/a.h", "app/window/panels/a.h", "bench/plot.h")}
        breaches = {
            "sim includes no robots": ("sim/a.cpp", '#include "mercury/voxel.h"'),
            "no core file includes a backend": ("sim/a.cpp", '#include "sim/cpu/step.h"'),
            "shared physics includes no backend": ("sim/physics/a.h", '#include "sim/cuda/step.h"'),
            "a backend includes no other": ("sim/cpu/a.cpp", '#include "sim/cuda/step.h"'),
            "a backend includes no core": ("sim/cpu/a.cpp", '#include "sim/parts.h"'),
            "a public header includes no internals": (f"{SIM}/a.h", '#include "sim/physics/muscle.h"'),
            "a public header of robots includes no internals": (f"{ROBOTS}/a.h", '#include "robots/document.h"'),
            "sim uses no OpenGL": ("sim/a.cpp", "#include <epoxy/gl.h>"),
            "sim uses no OpenGL, quoted": ("sim/a.cpp", '#include "GL/gl.h"'),
            "sim opens no files": ("sim/a.h", "#include <fstream>"),
            "sim reads no JSON": ("sim/a.cpp", "# include <nlohmann/json.hpp>"),
            "sim writes no HDF5": ("sim/a.cpp", "#include <hdf5.h>"),
            "sim uses no CGAL": ("sim/cpu/a.h", "#include <CGAL/Point_3.h>"),
            "sim uses no interop": ("sim/cuda/a.cu", "#include <cuda_gl_interop.h>"),
            "robots take only plain data of sim": ("robots/a.cpp", '#include "mercury/simulation.h"'),
            "so do their public headers": (f"{ROBOTS}/a.h", "#include <mercury/simulation.h>"),
            "robots draw nothing": ("robots/a.cpp", '#include "render/scene.h"'),
            "robots use no CUDA": ("robots/a.cpp", "#include <cuda_runtime.h>"),
            "plain data includes plain data": (f"{SIM}/material.h", '#include "mercury/simulation.h"'),
            "render includes no simulator": ("render/a.cpp", '#include "mercury/vec3.h"'),
            "render includes no robots": ("render/a.cpp", '#include "mercury/voxel.h"'),
            "render uses no CUDA": ("render/a.cpp", "#include <cuda_runtime.h>"),
            "app includes no internals of sim": ("app/scene/b.cpp", '#include "sim/physics/muscle.h"'),
            "app includes no backend": ("app/video/b.cpp", '#include "sim/cuda/step.h"'),
            "base is at the bottom of app": ("app/base/b.cpp", '#include "app/scene/a.h"'),
            "scene is below the window": ("app/scene/b.cpp", '#include "app/live/a.h"'),
            "live uses no window": ("app/live/b.cpp", '#include "app/window/panels/a.h"'),
            "nobody includes bench": ("app/live/b.cpp", '#include "bench/plot.h"'),
            "examples include only public headers": ("examples/a/main.cpp", '#include "sim/parts.h"'),
            "CGAL stays in robots": ("app/scene/b.cpp", "#include <CGAL/Point_3.h>"),
            "CLI11 is compiled once": ("app/live/b.cpp", "#include <CLI/CLI.hpp>"),
            "one place asks for nvcc": ("sim/cuda/a.cu", "#if defined(__CUDACC__)"),
            "names from the root": ("sim/cpu/a.cpp", '#include "../parts.h"'),
            "a neighbor with its folder": ("sim/cpu/a.cpp", '#include "step.h"'),
            "the header exists": ("sim/a.cpp", '#include "sim/lost.h"'),
            "the public header exists": ("app/scene/b.cpp", "#include <mercury/lost.h>"),
        }
        for rule, (path, line) in breaches.items():
            with self.subTest(rule):
                found = problems({**there, path: f"#pragma once\n{line}\n"})
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith(f"{path}:2: "), found[0])

    def test_files_that_include_each_other_are_reported(self):
        self.assertEqual(
            problems({"sim/a.h": '#include "sim/b.h"\n', "sim/b.h": '#include "sim/a.h"\n'}),
            ["sim/a.h:1: includes itself: sim/a.h -> sim/b.h -> sim/a.h"])

    def test_a_cycle_of_allowed_arrows_is_reported(self):
        self.assertEqual(list(include_rules.check_table({"a": "b", "b": "c", "c": "a", "d": "*"})),
                         ["the allowed arrows have a cycle: a -> b -> c -> a"])
        self.assertEqual(list(include_rules.check_table({"a": "lost"})), ["a/ may include lost/, which is not listed"])

    def test_comments_do_not_count(self):
        self.assertEqual(problems({"sim/a.h": '// #include "app/a.h"\n/*\n#include <fstream>\n__CUDACC__ */\n'}), [])

    def test_the_drawing_shows_the_current_includes(self):
        sys.path.insert(0, str(ROOT / "docs/drawings"))
        import includes
        self.assertEqual((ROOT / "docs/pictures/includes.svg").read_text(encoding="utf-8"),
                         includes.drawing(ROOT).document(),
                         "an arrow between folders is new or gone: run docs/drawings/draw.py")


if __name__ == "__main__":
    unittest.main()
