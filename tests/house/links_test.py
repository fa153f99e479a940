#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The links of the pages lead somewhere: files and folders exist, #anchors are headings. Links to the web are not followed.

    links_test.py [PAGE.md...]        without one, README, CONTRIBUTING, CHANGELOG and all of docs/ and examples/
"""

import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LINK = re.compile(r"\]\(([^()\s]+)\)")  # the text before may begin on another line


def prose(text):
    """(line number, line) of what is not a block of code or code within a line."""
    fence = False
    for number, line in enumerate(text.splitlines(), start=1):
        if re.match(r"\s*```", line):
            fence = not fence
        elif not fence and not line.startswith("    "):
            yield number, line


def anchors(text):
    """The anchors of a page's headings, as GitHub makes them: letters, digits, - and _ in lower case, spaces as -."""
    found = set()
    for _, line in prose(text):
        heading = re.match(r"#{1,6}\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1])
        slug = base = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        repeated = 0
        while slug in found:
            repeated += 1
            slug = f"{base}-{repeated}"
        found.add(slug)
    return found


def problems_of(page):
    """A line per link of the page that leads nowhere."""
    text = page.read_text(encoding="utf-8")
    for number, line in prose(text):
        for link in LINK.findall(re.sub(r"(`+).*?\1", lambda code: "x" * len(code[0]), line)):
            if re.match(r"[a-z]+:", link):
                continue
            path, _, anchor = link.partition("#")
            target = (page.parent / path) if path else page
            if not target.exists():
                yield f"{page.name}:{number}: {link}: there is no such file"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text(encoding="utf-8")):
                yield f"{page.name}:{number}: {link}: {target.name} has no such heading"


def check_itself():
    with tempfile.TemporaryDirectory() as scratch:
        page = Path(scratch) / "page.md"
        page.write_text("# A page\n## `--csv`, units: [m](page.md)\n## Twice\n## Twice\n\n"
                        "[a](#a-page) [b](#--csv-units-m) [c](#twice-1) [d](page.md#twice) `[e](none)` [web](https://a.b)\n"
                        "[f](none.md) [g](#twice-2) [![h](none.png)](page.md)\n```\n[i](none)\n```\n")
        found = [problem.split(": ")[1] for problem in problems_of(page)]
        assert found == ["none.md", "#twice-2", "none.png"], found


def main():
    check_itself()
    pages = [Path(page).resolve() for page in sys.argv[1:]] or [
        *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md")),
        *sorted(ROOT.glob("docs/**/*.md")), *sorted(ROOT.glob("examples/**/*.md"))]
    problems = [problem for page in pages for problem in problems_of(page)]
    print("\n".join(problems) or f"{len(pages)} pages, all links lead somewhere")
    return 1 if problems else 0


sys.exit(main())
