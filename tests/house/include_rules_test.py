# SPDX-License-Identifier: Apache-2.0
"""The include rules hold in this repository, and a breach of each of them is seen."""

import tempfile
import unittest
from pathlib import Path

import include_rules


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
        count, found = include_rules.check(Path(__file__).resolve().parents[2])
        self.assertGreater(count, 20)
        self.assertEqual(found, [])

    def test_what_is_allowed_is_not_reported(self):
        self.assertEqual(problems({
            "mercury/simulation.h": '#pragma once\n#include <vector>\n#include "mercury/robot.h"\n',
            "mercury/host_device.h": "#ifdef __CUDACC__\n#endif\n",
            "sim/cuda/step.cu": '#include <cuda_runtime.h>\n#include "mercury/simulation.h"\n',
            "robots/voxel.cpp": '#include <nlohmann/json.hpp>\n#include "mercury/voxel.h"\n#include "mercury/robot.h"\n',
            "robots/alpha.cpp": "#include <CGAL/Alpha_shape_3.h>\n",
            "render/context.cpp": '#include <epoxy/egl.h>\n#include "render/context.h"\n',
            "render/png.h": "",
            "render/png.cpp": '#include <png.h>\n#include "render/png.h"\n',
            "app/bridge.cpp": '#include <cuda_gl_interop.h>\n#include "mercury/simulation.h"\n#include "render/scene.h"\n',
            "tests/sim/step_test.cpp": '#include <fstream>\n#include "sim/cpu/step.h"\n',
        }), [])

    def test_breaches_are_reported_with_file_and_line(self):
        self.assertEqual(
            problems({"sim/step.cpp": '#include <vector>\n#include "app/view.h"\n'}),
            ["sim/step.cpp:2: sim/ may not include app/ (app/view.h)"])

    def test_every_rule_sees_a_breach(self):
        breaches = {
            "sim includes nothing of ours": ("sim/a.cpp", '#include "mercury/voxel.h"'),
            "sim knows no OpenGL": ("sim/a.cpp", "#include <epoxy/gl.h>"),
            "sim knows no OpenGL, quoted": ("sim/a.cpp", '#include "GL/gl.h"'),
            "sim opens no files": ("sim/a.h", "#include <fstream>"),
            "sim reads no JSON": ("sim/a.cpp", "# include <nlohmann/json.hpp>"),
            "sim writes no HDF5": ("sim/a.cpp", "#include <hdf5.h>"),
            "sim knows no CGAL": ("sim/cpu/a.h", "#include <CGAL/Point_3.h>"),
            "sim knows no interop": ("sim/cuda/a.cu", "#include <cuda_gl_interop.h>"),
            "robots take only plain data of sim": ("robots/a.cpp", '#include "mercury/simulation.h"'),
            "robots draw nothing": ("robots/a.cpp", '#include "render/scene.h"'),
            "robots know no CUDA": ("robots/a.cpp", "#include <cuda_runtime.h>"),
            "plain data stays plain": ("mercury/robot.h", '#include "mercury/simulation.h"'),
            "render includes no simulator": ("render/a.cpp", '#include "mercury/vec3.h"'),
            "render includes no robots": ("render/a.cpp", '#include "mercury/voxel.h"'),
            "render knows no CUDA": ("render/a.cpp", "#include <cuda_runtime.h>"),
            "render knows no interop": ("render/a.cpp", "#include <cuda_gl_interop.h>"),
            "nothing includes bench": ("app/a.cpp", '#include "bench/plot.h"'),
            "CGAL stays in robots": ("app/a.cpp", "#include <CGAL/Point_3.h>"),
            "one place asks for nvcc": ("sim/cuda/a.cu", "#if defined(__CUDACC__)"),
            "names from the root": ("sim/cpu/a.cpp", '#include "../robot.h"'),
        }
        for rule, (path, line) in breaches.items():
            with self.subTest(rule):
                found = problems({path: f"#pragma once\n{line}\n"})
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith(f"{path}:2: "), found[0])

    def test_a_neighbour_without_its_folder_is_reported(self):
        self.assertEqual(problems({"sim/cpu/a.cpp": '#include "a.h"\n', "sim/cpu/a.h": ""}),
                         ["sim/cpu/a.cpp:1: name the header from the root: a.h"])

    def test_comments_do_not_count(self):
        self.assertEqual(problems({"sim/a.h": '// #include "app/a.h"\n/*\n#include <fstream>\n__CUDACC__ */\n'}), [])


if __name__ == "__main__":
    unittest.main()
