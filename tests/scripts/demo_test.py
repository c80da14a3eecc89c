"""What scripts/demo builds is enough for the examples of the README: the command, its page, and the Python module.

demo_test.py BUILD
"""

import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
build = None


class Demo(unittest.TestCase):
    def test_it_builds_the_command_its_page_and_the_python_module(self):
        (line,) = re.findall(r"^scripts/setup --target (.+)$", (ROOT / "scripts/demo").read_text(), re.MULTILINE)
        targets = line.split()
        commands = subprocess.run(
            [ROOT / ".venv/bin/ninja", "-C", build, "-t", "commands", *targets],
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        for made in ("-o bin/prowl ", "report/build.mjs", "-o python/prowl/_prowl", "python/prowl/_prowl.pyi"):
            self.assertIn(made, commands, f"{targets} do not make it")
        self.assertNotIn("_test.cpp", commands, "the first build would be much longer with the tests")


if __name__ == "__main__":
    build = sys.argv.pop()
    unittest.main()
