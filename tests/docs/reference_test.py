"""docs/reference.md is what scripts/reference writes, with every key and every option.

reference_test.py PROWL FILE_KEYS
"""

import json
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "site" / "reference"))
import write  # noqa: E402

PROWL, FILE_KEYS = sys.argv[1:]
PAGE = (ROOT / "docs" / "reference.md").read_text(encoding="utf-8")


def section(text: str, heading: str) -> str:
    """What is below a heading, up to the next of its level."""
    level = heading.split(" ")[0]
    return text.partition(f"\n{heading}\n")[2].partition(f"\n{level} ")[0]


class Reference(unittest.TestCase):
    def test_is_what_the_script_writes(self):
        self.assertEqual(PAGE, write.page(PROWL, FILE_KEYS), "run scripts/reference")

    def test_has_every_key_with_its_parts(self):
        keys = json.loads(subprocess.run([FILE_KEYS], capture_output=True, text=True, check=True).stdout)
        for kind, count in (("task", 80), ("robot", 15), ("job", 10)):
            tables = section(PAGE, f"## {kind.capitalize()} file")
            self.assertGreater(len(keys[kind]), count)
            for key in keys[kind]:
                with self.subTest(table=key["table"], key=key["name"]):
                    rows = section(tables + "\n### ", f"### `{key['table']}`" if key["table"] else "### Top level")
                    row = re.search(rf"^\| `{key['name']}` \|.*$", rows, re.MULTILINE)
                    self.assertTrue(row, "no row")
                    for part in (
                        ("type", "unit", "default", "meaning", "formula")
                        if key["formula"]
                        else ("type", "unit", "default", "meaning")
                    ):
                        self.assertIn(f"| {write.cell(key[part])} |", row[0])

    def test_has_every_option_of_every_verb(self):
        commands = section(PAGE, "## Command line")
        described = re.findall(r"^### `prowl ([\w ]+)`$", commands, re.MULTILINE)
        self.assertGreater(len(described), 12)
        options = 0
        for verb in described:
            rows = section(commands + "\n### ", f"### `prowl {verb}`")
            for option in re.findall(
                r"^ {1,9}(?:-\w,)?(--[a-z-]+)\b", write.help_of(PROWL, *verb.split()), re.MULTILINE
            ):
                with self.subTest(verb=verb, option=option):
                    self.assertTrue(
                        option == "--help" or re.search(rf"^\| `{option}\b[^|]*` \| [^|]{{5}}", rows, re.MULTILINE)
                    )
                    options += 1
        self.assertGreater(options, 80)

    def test_names_no_path_of_this_machine(self):
        self.assertNotRegex(PAGE, r"[ (`]/\w+/")

    def test_reads_help_of_either_form(self):
        text = """Do it
Usage: prowl do [OPTIONS]

Options:
  -h,--help                   Print this help message and exit
  --name NAME:{red,blue} Excludes: --other
                              Which one; docs/theory.md,
                              in two lines

Mesh:
  --n N                       How many

Examples:
  prowl do --name red
"""
        listed = write.entries(text)
        self.assertEqual([heading for heading, *_ in listed], ["Options", "Options", "Mesh"])
        self.assertEqual(
            [write.described(*entry[1:]) for entry in listed[1:]],
            [
                ["`--name NAME`", "Which one; [theory.md](theory.md), in two lines; choices: red, blue"],
                ["`--n N`", "How many"],
            ],
        )


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
