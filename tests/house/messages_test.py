#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The messages of docs/troubleshooting.md are those of the program: what is printed bold and as code there is looked up in the
strings of the sources. Words in capitals and "..." stand for what varies.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/troubleshooting.md"
FOLDERS = ["sim", "robots", "evolution", "render", "app", "python/src", "python/mercurysim"]
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
VARIES = re.compile(r"\.\.\.|\b[A-Z]+(?:x[A-Z]+)?\b|\d+|[:;()/]")  # and what separates one text from the next


def strings_of(text):
    """The string literals of a source; adjacent ones, as C++ and Python join them, as one."""
    joined, end = [], None
    for literal in LITERAL.finditer(text):
        content = literal[1].replace('\\"', '"')
        if end is not None and not text[end:literal.start()].strip():
            joined[-1] += content
        else:
            joined.append(content)
        end = literal.end()
    return joined


def messages_of(page):
    return [re.sub(r"\s+", " ", message) for message in re.findall(r"\*\*`([^`]+)`\*\*", page)]


def fixed_parts(message):
    """What of a message does not vary, in pieces that are long enough to say something."""
    return [piece for piece in (part.strip() for part in VARIES.split(message)) if len(piece) >= 8]


def check_itself():
    assert strings_of('f("a " // no\n "b", c + " d");\n"e\\"f"\n "g"') == ["a ", "b", " d", 'e"fg']
    assert fixed_parts("FILE: a picture of WIDTHxHEIGHT pixels (WHY); ...") == ["a picture of"]


def main():
    check_itself()
    strings = "\n".join(string for folder in FOLDERS for path in sorted((ROOT / folder).rglob("*"))
                        if path.suffix in {".cpp", ".h", ".cu", ".cuh", ".py"}
                        for string in strings_of(path.read_text(encoding="utf-8")))
    messages = messages_of(PAGE.read_text(encoding="utf-8"))
    unknown = [(message, part) for message in messages for part in fixed_parts(message) if part not in strings]
    empty = [message for message in messages if not fixed_parts(message)]
    for message, part in unknown:
        print(f"{PAGE.name}: \"{message}\": no source has \"{part}\"")
    for message in empty:
        print(f"{PAGE.name}: \"{message}\": nothing in it is fixed")
    if len(messages) < 20:
        print(f"{PAGE.name}: only {len(messages)} messages were found")
    return 1 if unknown or empty or len(messages) < 20 else 0


sys.exit(main())
