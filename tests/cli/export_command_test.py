"""prowl export as a command: what it says, what it refuses, what it leaves alone.

export_command_test.py PROWL ROBOTS_DATA
"""

import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np
from exports_support import ROOT, prowl, read_csv, run_or_fail


class ExportCommand(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.plan = pathlib.Path(cls.folder.name) / "a plan; with 'odd' name"
        run_or_fail("plan", ROOT / "tasks/hyq/crouch.toml", "--out", cls.plan)

    def test_says_what_it_wrote(self):
        done = run_or_fail("export", self.plan, "--format", "csv,json,npz,mcap,joint-trajectory,mujoco")
        for name in (
            "motion.csv",
            "gains.csv",
            "motion.json",
            "motion.npz",
            "motion.mcap",
            "joint_trajectory.json",
            "mujoco.xml",
            "mujoco_keyframes.xml",
            "mujoco_model.xml",
        ):
            self.assertIn(name, done.stdout)
        out = self.plan.with_name("told")
        told = json.loads(run_or_fail("export", self.plan, "--format", "csv", "--out", out, "--json").stdout)
        self.assertEqual(told["directory"], str(self.plan))
        self.assertEqual({pathlib.Path(path).parent for path in told["written"]}, {out})
        self.assertEqual(
            {f["name"]: f["bytes"] for f in told["files"]}, {p.name: p.stat().st_size for p in out.iterdir()}
        )
        self.assertEqual(told["samples"], len(read_csv(self.plan / "trajectory.csv")["time_s"]))

    def test_a_plan_without_gains_that_is_not_finished(self):
        plan = self.plan.with_name("unfinished")
        self.assertEqual(
            prowl(
                "plan",
                ROOT / "tasks/hyq/step.toml",
                "--max-iterations",
                2,
                "--one-mesh",
                "--intervals",
                250,
                "--out",
                plan,
            ).returncode,
            6,
        )
        done = run_or_fail("export", plan, "--format", "csv,npz,mcap")
        self.assertIn("this plan is not good: iteration_limit", done.stderr)
        self.assertEqual({p.name for p in (plan / "exports").iterdir()}, {"motion.csv", "motion.npz", "motion.mcap"})
        with np.load(plan / "exports/motion.npz", allow_pickle=False) as file:
            self.assertFalse(file["good"])
            self.assertNotIn("K", file.files)

    def test_tells_what_is_wrong(self):
        early = prowl("export", self.plan, "--format", "npz", "--simulation")
        self.assertEqual(early.returncode, 2)
        self.assertIn(f"prowl simulate {self.plan}", early.stderr)
        nowhere = self.plan.with_name("nowhere")
        for arguments, said in (
            (("--format", "cvs"), "cvs"),
            ((), "--format"),
            (("--format", "csv", "--simulation"), "simulate.csv contains the simulation already"),
            (("--format", "csv", "--rate", 0), "--rate: 0"),
            (("--format", "csv", "--rate", "nan"), "--rate: nan"),
            (("--format", "csv", "--rate", 1e12), "at most"),
            (("--format", "npz", "--python", "/nowhere/python"), "/nowhere/python"),
        ):
            with self.subTest(arguments):
                done = prowl("export", self.plan, *arguments, "--out", nowhere)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(said, done.stderr)
        bare = self.plan.with_name("bare python")
        bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -S "$@"\n')
        bare.chmod(0o755)
        missing = prowl("export", self.plan, "--format", "csv,mcap", "--python", bare, "--out", nowhere)
        self.assertEqual(missing.returncode, 2, missing.stderr)
        self.assertIn("mcap-ros2-support", missing.stderr)
        self.assertFalse(nowhere.exists(), "nothing is written")
        self.assertEqual(prowl("export", self.plan.with_name("no plan"), "--format", "csv").returncode, 2)
        self.assertEqual(prowl("export", self.plan, "--format", "csv", "--out", "/dev/null").returncode, 4)

    def test_a_new_plan_removes_the_exports_but_no_strange_file(self):
        plan = self.plan.with_name("replaced")
        again = ("plan", ROOT / "tasks/hyq/stand.toml", "--no-gains", "--out", plan)
        run_or_fail(*again)
        run_or_fail("export", plan, "--format", "csv,joint-trajectory")
        strange = plan / "exports/notes.txt"
        strange.write_text("mine")
        run_or_fail("export", plan, "--format", "json")  # beside it
        refused = prowl(*again)
        self.assertEqual(refused.returncode, 4, refused.stderr)
        self.assertIn("notes.txt", refused.stderr)
        strange.unlink()
        run_or_fail(*again)
        self.assertFalse((plan / "exports").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
