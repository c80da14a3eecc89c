"""The list of scripts/mutate still fits the code: each text to change is there once, each test that is to notice it exists."""

import pathlib
import re
import tomllib
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MUTATIONS = tomllib.loads((ROOT / "tests/mutations/mutations.toml").read_text(encoding="utf-8"))["mutation"]


class Mutations(unittest.TestCase):
    def test_each_changes_one_place(self) -> None:
        for mutation in MUTATIONS:
            with self.subTest(mutation["name"]):
                text = (ROOT / mutation["file"]).read_text(encoding="utf-8")
                self.assertEqual(text.count(mutation["from"]), 1)
                self.assertNotEqual(mutation["from"], mutation["to"])

    def test_their_tests_exist(self) -> None:
        listed = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "tests").glob("*/tests.cmake"))
        names = set(re.findall(r"prowl_test\((\S+)", listed))
        for mutation in MUTATIONS:
            with self.subTest(mutation["name"]):
                self.assertTrue(mutation["tests"])
                self.assertLessEqual(set(mutation["tests"]), names)

    def test_there_are_thirty(self) -> None:
        self.assertGreaterEqual(len(MUTATIONS), 30)


if __name__ == "__main__":
    unittest.main()
