# SPDX-License-Identifier: Apache-2.0
"""All C++ and CUDA sources are formatted by clang-format 14 with the repository's .clang-format."""

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PATTERNS = ["*.h", "*.cpp", "*.cu", "*.cuh"]


def main():
    formatter = shutil.which("clang-format-14")
    if not formatter:
        print("skipped: there is no clang-format-14 (other versions format differently)")
        return 0
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard", "--",
                             *PATTERNS], capture_output=True, text=True)
    if listed.returncode:
        print("skipped: this is not a git checkout")
        return 0
    files = [name for name in listed.stdout.splitlines() if (ROOT / name).is_file()]
    result = subprocess.run([formatter, "--dry-run", "--Werror", *files], cwd=ROOT, capture_output=True, text=True)
    print(result.stderr, end="")
    if result.returncode:
        print("run: clang-format-14 -i FILE")
    return result.returncode


if __name__ == "__main__":
    sys.exit(main())
