#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Finds words that docs/glossary.md replaces. Prints one line per finding; exit status 1 if there is one.

    word_rules.py [PATH...]        files and folders; without one, the whole repository
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
READ = {".h", ".cpp", ".cu", ".cuh", ".in", ".py", ".md", ".txt", ".cmake", ".glsl", ".vert", ".frag", ".comp", ".sh", ""}
EXEMPT = {"tests/house/word_rules.py", "tests/house/word_rules_test.py", "docs/glossary.md", "LICENSE"}

# (pattern, what to write instead, and if given a pattern of the paths that it is for). A pattern matches whole words of prose and whole parts of an identifier:
# "seat" matches seat, seat_ and first_seat, not "seated by" in another word.
WORDS = [
    # Plain English
    ("told|tells?|telling", "reports, returns, says, prints"),
    ("anew", "again, from scratch, recomputed"),
    ("so many", "that many, or the number"),
    ("stand[-_]?ins?|empty[ _]places?", "padding, placeholder, substitute"),
    ("of before", "previous"),
    ("built alike", "same topology"),
    ("(springs|steps|pictures|frames|robots) a second", "per second"),
    ("pictures?(/s| per second)", "frames: a picture is a file that a user keeps"),
    ("the picture", "the view, or the frame: a picture is a file that a user keeps", r"^(app/(window|live)/|docs/window\.md)"),
    (r"(one|two|three|four|a line|a task|a thread) an? (robot|mass|spring|face|step|core|thread|lane|warp|block|frame|file|line)",
     "per robot, per spring"),
    ("be it", "whether"),
    ("one after the other", "one after another"),
    (r"(the|its|their) present (device|step|state|values?|time|camera|place|positions?|rest|frame|moment|scene|keys?|ones?)", "current"),
    ("at present", "now, currently"),
    ("(also|again) behind", "after"),
    ("save (that|where|when|for)", "except"),
    ("nought|naught", "0"),
    # British spelling
    (r"colour\w*", "color"),
    (r"grey\w*", "gray"),
    (r"centre\w*|centring", "center"),
    (r"(behavi|fav|hon|neighb|lab)our\w*", "behavior, favor, honor, neighbor, labor"),
    (r"(centi|milli|kilo)?metres?", "meter"),
    (r"licences?", "license"),
    (r"(initial|normal|optim|minim|maxim|visual|serial|synchron|vector|random|organ|recogn|real|summar)is(e|ed|es|ing|ation|ations)", "-ize"),
    (r"cancell(ed|ing)|travell(ed|ing|er)|modell(ed|ing)|labell(ed|ing)", "one l: canceled, traveled, modeled, labeled"),
    ("(to|up|down|in|out|back|for|after)wards", "without the s: toward, afterward"),
    # Hardware
    (r"graphics cards?|NVIDIA cards?", "GPU"),
    ("cards?", "GPU; the window has cards", r"^(README\.md|(sim|bench|evolution)/|docs/(?!window\.md))"),
    # Simulator
    ("part(y|ies)", "lockstep group"),
    ("sitters?", "member"),
    ("seats?|seating|seated", "index_map, thread_context"),
    ("assembl(y|ies)", "merged_topology"),
    ("hardness|hardnesses", "compliance, stiffness"),
    ("laws?", "SpringParameters, muscle_curve; a law of physics keeps its name by 'Hooke's law', 'muscle law'"),
    ("excess", "constraint_ratio"),
    ("arrivals?", "incoming_count"),
    ("calm", "still_water"),
    ("hooks", "EnvironmentModel"),
    ("culprits?", "culprit_spring"),
    ("first[ _]bad[ _]spring", "culprit_spring"),
    ("to[ _]blame", "culprit"),
    ("bundles?", "face_tile", r"^(sim|tests/sim|bench)/"),
    # Program and window
    ("cameram[ae]n", "CameraController"),
    ("camera[ _]hand", "OrbitController"),
    ("desks?", "PanelContext"),
    ("studios?", "VideoPipeline"),
    ("shel(f|ves)", "Pool"),
    ("histories", "ReplayLog"),
    ("orders_", "PendingCommands"),
    ("remembered", "SessionSettings"),
    ("nursery", "Breeding"),
]
# Where an old word is the right one: (pattern of the path, pattern of the line).
ALLOWED = [
    (r"^docs/formats\.md", r"first_bad_spring"),
    ("", r"Hooke's law|muscle[ _]law|Coulomb's law|law of|assembly language|the assembler|__asm__|inline assembly"),
    ("", r"third[- ]part(y|ies)"),
    (r"\.(py|md|cpp|ipynb)$", r"\btell(\(|\.__doc__)|::tell|\"tell\""),  # of Python's files, optimizers, mercurysim.evolution
    (r"\.(py|md|ipynb)$", r"\b(A|a)sk[ _-]and[ _-]tell\b"),  # the name of such an interface
    ("", r"culprit_?(spring|mass)|CulpritSpring|culprit spring"),
    ("", r"first_bad_spring.*(HDF5|JSON|key|attribute|column)|\"first_bad_spring\"|'first_bad_spring'|`first_bad_spring`"),
]


def rules():
    for words, instead, *paths in WORDS:
        yield re.compile(rf"(?<![A-Za-z])({words})(?![A-Za-z])", re.IGNORECASE), instead, re.compile("".join(paths))


RULES = list(rules())
ANY = re.compile("(?<![A-Za-z])(" + "|".join(words for words, *_ in WORDS) + ")(?![A-Za-z])", re.IGNORECASE)
EXCEPTIONS = [(re.compile(path), re.compile(line, re.IGNORECASE)) for path, line in ALLOWED]


def findings_of_text(path, text):
    """(line, what is wrong) of one file."""
    lines = text.split("\n")
    for number in sorted({text.count("\n", 0, found.start()) + 1 for found in ANY.finditer(text)}):  # few of all lines
        line = lines[number - 1]
        if any(p.search(path) and exception.search(line) for p, exception in EXCEPTIONS):
            continue
        for pattern, instead, paths in RULES:
            found = paths.search(path) and pattern.search(line)
            if found:
                yield number, f"'{found.group()}': write {instead}"


def tracked(paths):
    command = ["git", "-C", str(ROOT), "ls-files", "--", *[str(Path(p).resolve()) for p in paths]]
    for name in subprocess.run(command, capture_output=True, text=True, check=True).stdout.splitlines():
        if Path(name).suffix in READ and name not in EXEMPT and not name.startswith("robots/library/"):
            yield name


def main():
    count = 0
    for name in tracked(sys.argv[1:] or [ROOT]):
        text = (ROOT / name).read_text(encoding="utf-8", errors="ignore")
        for number, what in findings_of_text(name, text):
            print(f"{name}:{number}: {what}")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
