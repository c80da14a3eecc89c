"""What an object compiled for one instruction set defines for the linker is used by code for all: it may be its table alone.

symbols_test.py OBJECT...
"""

import pathlib
import subprocess
import sys
import unittest

OBJECTS = {pathlib.Path(name).name.split(".")[0]: name for name in sys.argv[1:]}


class Symbols(unittest.TestCase):
    def test_of_each_instruction_set_is_its_table(self):
        for name in ("x86_64", "x86_64_v3"):
            shown = subprocess.run(
                ["nm", "--extern-only", "--defined-only", "--format=just-symbols", OBJECTS[name]],
                check=True,
                capture_output=True,
                text=True,
            )
            self.assertEqual(shown.stdout.split(), [f"_ZN5prowl{len('kernels_' + name)}kernels_{name}E"])

    def test_the_fast_one_has_long_vectors_and_the_other_none(self):
        def code(name):
            return subprocess.run(["objdump", "-d", OBJECTS[name]], check=True, capture_output=True, text=True).stdout

        self.assertIn("vfmadd", code("x86_64_v3"))
        self.assertIn("%ymm", code("x86_64_v3"))
        self.assertNotIn("%ymm", code("x86_64"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
