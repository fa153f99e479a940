# SPDX-License-Identifier: Apache-2.0
"""Shaders of web pages, where there is no browser to compile them: those that a page draws with are in it, and have nothing
that WebGL 2 lacks.

    page_shaders_test.py MERCURY
"""

import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BEYOND_WEBGL = r"\b(std430|readonly|writeonly|coherent|shared|local_size_\w+|image(Load|Store)|atomic\w+|textureGather|double|dvec\d|fma)\b"


class PageShaders(unittest.TestCase):
    def setUp(self):
        with tempfile.TemporaryDirectory() as folder:
            page = Path(folder) / "eel.html"
            subprocess.run([sys.argv[1], "export", "sample:eel", "--seconds", "0.1", "--device", "cpu", "--quiet", "-o", page], check=True)
            self.page = page.read_text()
        at = re.search(r'[{,]\s*"[\w.]+\.glsl":', self.page).start()
        start = self.page.rindex("{", 0, at + 1)
        self.shaders = json.JSONDecoder().raw_decode(self.page[start:].replace("<\\/", "</"))[0]

    def whole(self, name, included):
        """The shader with what it includes, each once."""
        self.assertIn(name, self.shaders)
        included.add(name)
        parts = re.split(r'^#include "(.*)"$', self.shaders[name], flags=re.M)
        return "".join(part if i % 2 == 0 else "" if part in included else self.whole(part, included) for i, part in enumerate(parts))

    def test_each_is_there_with_what_it_includes_and_is_of_webgl_2(self):
        programs = re.findall(r'program\("([\w.]+)",\s*"([\w.]+)"', self.page)
        self.assertGreater(len(programs), 5)
        for name in sorted({shader for program in programs for shader in program}):
            with self.subTest(name):
                text = re.sub(r"//.*|/\*.*?\*/", "", self.whole(name, set()))
                self.assertIn("void main()", text)
                self.assertEqual([match.group(0) for match in re.finditer(BEYOND_WEBGL, text)], [])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
