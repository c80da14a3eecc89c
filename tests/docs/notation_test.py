"""docs/notation.md: each section contains a table with rows, and each identifier that it names is in the code."""

import pathlib
import re
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "site"))
from page_blocks import ROOT, prose  # noqa: E402

PAGE = ROOT / "docs" / "notation.md"
SECTIONS = [
    "Robot and state",
    "Contacts",
    "Dynamics",
    "Problem",
    "Mesh and transcription",
    "Solver",
    "Certificate",
    "Tracking",
    "Simulation",
    "Words of the files",
]
CODE_FOLDERS = ("prowl", "cli", "python", "screen", "alternatives")
CODE_FILES = {".hpp", ".cpp", ".py", ".pyi"}
IDENTIFIER = re.compile(r"`([A-Za-z_]\w*(?:::[A-Za-z_]\w*)*)`")


def rows(section: str) -> list[list[str]]:
    """The cells of each row of a section's table, without its head."""
    lines = [line.strip() for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def sections() -> dict[str, str]:
    parts = re.split(r"^## +(.*)$", prose(PAGE), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def code_words() -> list[set[str]]:
    """The words of each file of the code."""
    return [
        set(re.findall(r"[A-Za-z_]\w*", path.read_text(encoding="utf-8")))
        for folder in CODE_FOLDERS
        for path in sorted((ROOT / folder).rglob("*"))
        if path.suffix in CODE_FILES
    ]


class Notation(unittest.TestCase):
    def test_sections_are_those_of_the_page_and_have_rows(self):
        self.assertEqual(list(sections()), SECTIONS)
        for title, section in sections().items():
            with self.subTest(section=title):
                self.assertGreater(len(rows(section)), 0)

    def test_rows_fit_the_head_of_their_table(self):
        for title, section in sections().items():
            width = len(next(line for line in section.splitlines() if line.startswith("|")).strip("|").split("|"))
            for row in rows(section):
                with self.subTest(section=title, row=row[0]):
                    self.assertEqual(len(row), width)

    def test_identifiers_are_in_the_code(self):
        files, found = code_words(), 0
        for title, section in sections().items():
            for row in rows(section):
                for name in IDENTIFIER.findall(row[-1]):
                    with self.subTest(section=title, identifier=name):
                        parts = set(name.split("::"))
                        self.assertTrue(any(parts <= words for words in files), f"{name} is in no file of the code")
                        found += 1
        self.assertGreater(found, 80)

    def test_no_symbol_or_word_is_explained_twice_in_a_section(self):
        for title, section in sections().items():
            words = [word.strip() for row in rows(section) for word in row[0].split(",")]
            with self.subTest(section=title):
                self.assertEqual(sorted(words), sorted(set(words)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
