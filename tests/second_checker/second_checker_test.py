"""Plans of Prowl hold for a checker that shares no code with it, and planted faults do not.

second_checker_test.py PROWL PACKAGES
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
import second_checker  # noqa: E402  (leaves no cache beside the tests)

ROOT = pathlib.Path(__file__).parents[2]
PROWL, PACKAGES = sys.argv.pop(1), pathlib.Path(sys.argv.pop(1))
TASKS = ("hyq/stand", "hyq/crouch", "hyq/step", "hyq/balance", "hyq/rear", "go2/step", "anymal_c/crouch", "solo12/step")


class SecondChecker(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def planned(self, name: str, **changes) -> tuple[pathlib.Path, pathlib.Path]:
        """The folder of the plan, and the task file, whose robot file is beside it. Changes: pattern and text of the task."""
        task = self.folder / f"{name.replace('/', '_')}{len(list(self.folder.iterdir()))}.toml"
        text = (ROOT / f"tasks/{name}.toml").read_text()
        robot = re.search(r'robot = "../../robots/(.*)"', text).group(1)
        (self.folder / robot).write_text((ROOT / "robots" / robot).read_text())
        text = text.replace(f"../../robots/{robot}", robot)
        for pattern, new in changes.values():
            text, count = re.subn(pattern, new, text)
            self.assertGreater(count, 0, pattern)
        task.write_text(text)
        out = task.with_suffix("")
        command = [PROWL, "plan", task, "--package-dir", PACKAGES, "--out", out, "--no-gains", "--quiet"]
        done = subprocess.run(command, capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr + done.stdout)
        return out, task

    def checked(self, out: pathlib.Path, task: pathlib.Path) -> set[str]:
        return second_checker.check(second_checker.Plan(out, task, PACKAGES))

    def test_plans_hold(self):
        for name in TASKS:
            with self.subTest(task=name):
                self.assertEqual(self.checked(*self.planned(name)), set())

    def test_a_contact_radius_of_another_robot_is_noticed(self):
        out, task = self.planned("hyq/stand")
        robot = self.folder / "hyq.toml"
        robot.write_text(robot.read_text().replace("radius_m = 0.02175", "radius_m = 0.025"))
        self.assertEqual(self.checked(out, task), {"contact on its surface"})

    def test_the_sign_of_a_goal_is_noticed(self):
        out, task = self.planned("hyq/stand")
        text, count = re.subn(r"\[0.05, 0.03, -0.05\]", "[0.05, -0.03, -0.05]", task.read_text())
        self.assertEqual(count, 1)
        task.write_text(text)
        self.assertEqual(self.checked(out, task), {"goal"})

    def test_a_torque_curve_that_is_off_by_a_tenth_is_noticed(self):
        quick = {"duration": (r"duration_s = 2.0", "duration_s = 0.3"), "time": (r"time_s = 2.0", "time_s = 0.3")}
        out, task = self.planned("hyq/stand", **quick)  # its knees are at their limit
        self.assertEqual(self.checked(out, task), set())
        robot = self.folder / "hyq.toml"
        lower = re.sub(r"\[(-?[\d.]+), ([\d.]+)\]", lambda m: f"[{m[1]}, {0.9 * float(m[2]):.4f}]", robot.read_text())
        self.assertNotEqual(lower, robot.read_text())
        robot.write_text(lower)
        self.assertEqual(self.checked(out, task), {"torque"})

    def test_numbers_of_another_motion_are_noticed(self):
        out, task = self.planned("hyq/step")
        table = out / "trajectory.csv"
        lines = table.read_text().splitlines()
        head = next(i for i, line in enumerate(lines) if line.startswith("time_s"))
        names, middle = lines[head].split(","), head + (len(lines) - head) // 2
        for column, factor, fault in (
            ("tau_lh_hfe_joint_Nm", 1.05, "equation of motion"),
            ("base_dwy_radps2", 1.5, "equation of motion"),
            ("f_rh_foot_x_N", 1e3, "friction cone"),
            ("v_lf_kfe_joint_radps", 1e3, "range of a joint"),
            ("contact_rh_foot", 0.0, "schedule"),
            ("tau_lh_hfe_joint_Nm", float("nan"), "torque"),
        ):
            cells = lines[middle].split(",")
            i = names.index(column)
            cells[i] = repr(factor * float(cells[i]))
            table.write_text("\n".join([*lines[:middle], ",".join(cells), *lines[middle + 1 :]]) + "\n")
            with self.subTest(column=column):
                self.assertIn(fault, self.checked(out, task))


if __name__ == "__main__":
    unittest.main()
