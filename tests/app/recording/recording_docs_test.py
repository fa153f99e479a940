# SPDX-License-Identifier: Apache-2.0
"""The snippets of docs/formats.md work: its ```sh and ```python blocks, run in their order in one empty folder.

    recording_docs_test.py MERCURY docs/formats.md
"""

import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PAGE = Path(sys.argv.pop()).resolve()
MERCURY = Path(sys.argv.pop()).resolve()


def snippets(page):
    """(language, code, line) of each block that names a language."""
    for block in re.finditer(r"^```(\w+)\n(.*?)^```$", page, re.DOTALL | re.MULTILINE):
        yield block[1], block[2], page.count("\n", 0, block.start()) + 2


class Page(unittest.TestCase):
    def test_snippets_run(self):
        page = list(snippets(PAGE.read_text(encoding="utf-8")))
        self.assertEqual({language for language, _, _ in page}, {"sh", "python"})
        self.assertGreater(len(page), 8)
        environment = dict(os.environ, PATH=f"{MERCURY.parent}:{os.environ['PATH']}")
        with tempfile.TemporaryDirectory() as folder:
            for language, code, line in page:
                with self.subTest(f"{PAGE.name}:{line}"):
                    command = ["sh", "-euc"] if language == "sh" else [sys.executable, "-c"]
                    done = subprocess.run([*command, code], cwd=folder, env=environment, capture_output=True, text=True)
                    self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
