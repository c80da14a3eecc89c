"""A plan by the kernels of each instruction set, by a mask of the processor's features.

instruction_sets_test.py PROWL
"""

import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROWL = pathlib.Path(sys.argv.pop(1))
TASKS = pathlib.Path(__file__).resolve().parents[2] / "tasks"
MASK = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX2"}


def plan(task, folder, environment):
    command = [PROWL, "plan", TASKS / f"{task}.toml", "--one-mesh", "--intervals", "250", "--quiet", "--out", folder]
    subprocess.run(command, check=True, env=os.environ | {"OPENBLAS_NUM_THREADS": "1"} | environment)
    record = json.loads((folder / "plan.json").read_text())
    with open(folder / "trajectory.csv", newline="") as file:
        rows = [[float(value) for value in row] for row in list(csv.reader(file))[1:]]
    return record, rows


class InstructionSets(unittest.TestCase):
    def test_plans_agree(self):
        for task in ("hyq/crouch", "hyq/step", "talos/squat"):
            with tempfile.TemporaryDirectory() as name:
                fast, fast_rows = plan(task, pathlib.Path(name) / "fast", {})
                slow, slow_rows = plan(task, pathlib.Path(name) / "slow", MASK)
            self.assertEqual(slow["versions"]["vector instructions"], "x86-64")
            if fast["versions"]["vector instructions"] == "x86-64":
                self.skipTest("this processor has no AVX2")
            self.assertLessEqual(abs(fast["solver"]["iterations"] - slow["solver"]["iterations"]), 1)
            self.assertEqual(len(fast_rows), len(slow_rows))
            for ours, theirs in zip(fast_rows, slow_rows):
                for a, b in zip(ours, theirs):
                    self.assertLess(abs(a - b), 1e-6 * max(1.0, abs(a)))


if __name__ == "__main__":
    unittest.main()
