"""A terminal that closes in the middle of a solve, as it is: the kernel hangs up, and what is printed goes nowhere. The plan is kept.

Usage: hang_up_test.py PROWL PACKAGE_DIR
"""

import json
import os
import pathlib
import pty
import sys
import tempfile
import time
import unittest

PROWL, PACKAGE_DIR = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]


class HangUp(unittest.TestCase):
    def test_keeps_the_plan(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            folder = pathlib.Path(work)
            child, terminal = pty.fork()
            if child == 0:
                os.chdir(ROOT)
                os.execl(
                    PROWL,
                    "prowl",
                    "plan",
                    "tasks/hyq/stand.toml",
                    "--one-mesh",
                    "--intervals",
                    "1000",
                    "--out",
                    str(folder / "out"),
                    "--checkpoint",
                    str(folder / "so_far"),
                    "--checkpoint-every",
                    "0",
                    "--package-dir",
                    PACKAGE_DIR,
                )
            until = time.monotonic() + 300
            os.set_blocking(terminal, False)
            while not (folder / "so_far/plan.json").exists():  # the solve has begun
                self.assertLess(time.monotonic(), until)
                try:
                    os.read(terminal, 1 << 16)
                except BlockingIOError:
                    pass
                time.sleep(0.001)
            os.close(terminal)
            status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            self.assertEqual(status, 130)
            self.assertEqual(json.loads((folder / "out/plan.json").read_text())["status"], "interrupted")
            self.assertIn("status", json.loads((folder / "so_far/plan.json").read_text()), "the checkpoint is whole")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
