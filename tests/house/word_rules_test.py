# SPDX-License-Identifier: Apache-2.0
"""The repository uses the words of docs/glossary.md, and a breach of each rule is seen."""

import subprocess
import sys
import unittest
from pathlib import Path

import word_rules

# One breach per rule, in the order of word_rules.WORDS.
BREACHES = [
    "// The clock tells the time.",
    "// Groups are made anew.",
    "// A block of so many threads.",
    "// A stand-in for a mass.",
    "// The steps of before.",
    "// Robots built alike share it.",
    "// Springs a second.",
    "// The window shows 60 pictures per second.",
    ("app/window/a.cpp", "// The mouse in the picture."),
    "// One a robot.",
    "// Any robot, be it large or small.",
    "// Robots, one after the other.",
    "// The robot at the present time.",
    "// Why a folder cannot be read at present.",
    "// A barrier, also behind the call.",
    "// All robots, save when one explodes.",
    "// Nought is left.",
    "// The colours of robots.",
    "// A grey robot.",
    "// The centre of mass.",
    "// Its neighbour.",
    "// A metre.",
    "// A licence.",
    "void initialise();",
    "bool cancelled = false;",
    "// It moves towards the target.",
    "// A graphics card draws.",
    ("docs/performance.md", "On one card."),
    "std::vector<Party> parties;",
    "int sitter = 0;",
    "const Seat seat_;",
    "Assembly assembly = assemble();",
    "float hardness = 0;",
    "SpringLaw spring_law;",
    "float excess = 0;",
    "int arrivals = 0;",
    "bool calm = true;",
    "auto hooks = 0;",
    "// The culprit is a spring.",
    "std::uint32_t first_bad_spring = 0;",
    "std::uint32_t mass_to_blame = 0;",
    "// A bundle of faces.",
    "Cameraman cameraman;",
    "// The camera hand.",
    "Desk& desk;",
    "Studio studio;",
    "Shelf shelf_;",
    "Histories histories;",
    "Orders orders_;",
    "Remembered remembered;",
    "Nursery nursery;",
]


class WordRules(unittest.TestCase):
    @unittest.skipUnless((word_rules.ROOT / ".git").exists(), "this is not a git checkout")
    def test_this_repository_keeps_them(self):
        script = Path(__file__).with_name("word_rules.py")
        result = subprocess.run([sys.executable, "-B", str(script)], capture_output=True, text=True)
        self.assertEqual(result.stdout + result.stderr, "")

    def test_every_rule_sees_a_breach(self):
        for (words, instead, *_), text in zip(word_rules.WORDS, BREACHES, strict=True):
            with self.subTest(words):
                path, text = text if isinstance(text, tuple) else ("sim/a.cpp", text)
                found = [what for _, what in word_rules.findings_of_text(path, "\n" + text)]
                self.assertIn(f"write {instead}", " ".join(found))

    def test_plain_words_are_not_reported(self):
        text = "\n".join([
            "// Hooke's law gives the force; springs per second, one per robot.",
            "// A third-party library that is built from source.",
            "std::uint32_t culprit_spring = no_spring;",
            'json["first_bad_spring"] = culprit_spring;',
            "float stella = intelligent + installed;",
        ])
        self.assertEqual(list(word_rules.findings_of_text("sim/a.cpp", text)), [])


if __name__ == "__main__":
    unittest.main()
