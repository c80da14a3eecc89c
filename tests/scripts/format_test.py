"""scripts/format --check refuses a file of each language that is not formatted, and accepts what scripts/format writes."""

import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
UNFORMATTED = {
    "a.cpp": "int  main( ) {return 0;}\n",
    "b.hpp": "#pragma once\nstruct A{int b;};\n",
    "c.py": "def f( x ):\n  return x\n",
    "script": "#!/usr/bin/env python3\nprint( 'hello' )\n",
    "d.ts": "export const  a = {b:1}\n",
    "e.css": "a{color:red}\n",
}


def run(*arguments):
    return subprocess.run([ROOT / "scripts/format", *arguments], capture_output=True, text=True).returncode


class Format(unittest.TestCase):
    def test_refuses_what_it_would_change_and_accepts_what_it_wrote(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in UNFORMATTED.items():
                with self.subTest(name):
                    path = Path(folder) / name
                    path.write_text(text)
                    self.assertEqual(1, run("--check", path))
                    self.assertEqual(text, path.read_text(), "--check must not write")
                    self.assertEqual(0, run(path))
                    self.assertNotEqual(text, path.read_text())
                    self.assertEqual(0, run("--check", path))


if __name__ == "__main__":
    unittest.main()
