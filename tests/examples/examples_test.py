"""Every example is planned, passes its certificate, succeeds in the simulator, and reaches its purpose for the second
checker, which shares no code with Prowl.

examples_test.py PROWL PACKAGES LIBRARY PYTHON_PACKAGE
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).parents[2]
PROWL, PACKAGES, LIBRARY, PYTHON_PACKAGE = (pathlib.Path(sys.argv.pop(1)) for _ in range(4))
sys.path.insert(0, str(ROOT / "tests/second_checker"))
sys.dont_write_bytecode = True
import second_checker  # noqa: E402  (leaves no cache beside the tests)

TASKS = sorted(path.stem for path in (ROOT / "examples/tasks").glob("*.toml"))
BALL, POINT = np.array([0.75, -0.1, 1.05]), np.array([0.8, -0.25, 0.85])
OWN = {  # once more, by hand
    "distance from the ball": lambda plan: [np.linalg.norm(second_checker.link(plan, "gripperStator")[0] - BALL)],
    "distance from the point": lambda plan: second_checker.link(plan, "gripperStator")[0] - POINT,
}


def run(*command: object, **options: object) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


class Examples(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)

    def task(self, name: str, text: str | None = None) -> pathlib.Path:
        """A copy whose robot and library are found from anywhere."""
        text = text or (ROOT / f"examples/tasks/{name}.toml").read_text()
        text = text.replace("../../robots", str(ROOT / "robots"))
        text = re.sub(r'library = ".*"', f'library = "{LIBRARY}"', text)
        path = self.folder / f"{name}.toml"
        path.write_text(text)
        return path

    def plan(self, task: pathlib.Path, *options: str) -> pathlib.Path:
        out = task.with_suffix("")
        run(PROWL, "plan", task, "--package-dir", PACKAGES, "--allow-libraries", "--out", out, "--quiet", *options)
        return out

    def peak(self, folder: pathlib.Path) -> float:
        checks = json.loads((folder / "plan.json").read_text())["certificate"]["checks"]
        return next(check["worst"] for check in checks if check["name"] == "joint torque")

    def test_each_is_planned_succeeds_and_reaches_its_purpose(self):
        self.assertGreaterEqual(len(TASKS), 12)
        for name in TASKS:
            with self.subTest(example=name):
                task = self.task(name)
                out = self.plan(task)
                simulated = run(PROWL, "simulate", out, "--package-dir", PACKAGES, "--allow-libraries", "--json")
                self.assertIs(json.loads(simulated)["success"], True)
                self.assertEqual(second_checker.check(second_checker.Plan(out, task, PACKAGES), OWN), set())

    def test_a_term_that_is_missed_is_noticed(self):
        task = self.task("level_camera")
        out = self.plan(task, "--no-gains")
        task.write_text(task.read_text().replace("points_along = [0, 0, 1]", "points_along = [0, 0.1, 1]"))
        self.assertEqual(second_checker.check(second_checker.Plan(out, task, PACKAGES)), {"term camera level"})

    def test_the_least_peak_is_below_that_of_small_torques(self):
        text = (ROOT / "examples/tasks/least_peak_torque.toml").read_text()
        usual, count = re.subn(r"peak_torque = .*", "torque = 1e-5", text)
        self.assertEqual(count, 1)
        least = self.plan(self.task("least", text), "--no-gains")
        self.assertLess(self.peak(least), 0.7 * self.peak(self.plan(self.task("usual", usual), "--no-gains")))

    def test_python_finds_the_motion_of_the_library(self):
        out, library = self.folder / "python", self.plan(self.task("own_terms"), "--no-gains")
        environment = os.environ | {"PYTHONPATH": str(PYTHON_PACKAGE), "EXAMPLE_ROBOT_DATA": str(PACKAGES)}
        run(sys.executable, ROOT / "examples/own_terms.py", out, cwd=ROOT, env=environment)
        plans = [second_checker.Plan(folder, self.task("own_terms"), PACKAGES) for folder in (out, library)]
        for plan in plans:
            self.assertEqual(second_checker.check(plan, OWN), set())


if __name__ == "__main__":
    unittest.main()
