"""scripts/plot_knee on a plan of two knees: the curve is the library's, the image is there, and faults are told in words."""

import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).parents[2] / "scripts" / "plot_knee"
TABLE = [[0.0, 50.0], [0.5, 80.0], [1.0, 90.0], [1.5, 70.0], [2.0, 40.0]]


def load_script():
    loader = importlib.machinery.SourceFileLoader("plot_knee", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_knee", loader))
    loader.exec_module(module)
    return module


class PlotKnee(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.plan = pathlib.Path(folder.name) / "plan"
        self.plan.mkdir()

    def write_plan(self, robot_file: str) -> None:
        (self.plan / "plan.json").write_text(json.dumps({"robot_file": {"text": robot_file}}))
        (self.plan / "trajectory.csv").write_text(
            "time_s,q_left_rad,q_right_rad,tau_left_Nm,tau_right_Nm\n0,0.4,0.5,20,-30\n0.1,0.6,0.7,25,-35\n"
        )

    def run_script(self) -> subprocess.CompletedProcess:
        return subprocess.run([sys.executable, SCRIPT, self.plan], capture_output=True, text=True)

    def test_makes_an_image(self):
        tables = "".join(f"[limits.{joint}]\ntorque_over_position = {TABLE}\n" for joint in ("left", "right"))
        self.write_plan(tables + "[limits.hip]\ntorque_Nm = 3\n")
        result = self.run_script()
        self.assertEqual(result.returncode, 0, result.stderr)
        image = self.plan.with_name("plan_knee.png")
        self.assertTrue(image.read_bytes().startswith(b"\x89PNG"))
        self.assertGreater(image.stat().st_size, 10000)

    def test_tells_that_there_is_no_curve(self):
        self.write_plan("[limits.left]\ntorque_Nm = 3\n")
        result = self.run_script()
        self.assertEqual(result.returncode, 1)
        self.assertIn("no torque_over_position", result.stderr)

    def test_tells_that_there_is_no_plan(self):
        self.assertIn("no plan.json", self.run_script().stderr)

    def test_curve_is_the_one_of_the_library(self):
        # LimitCurve(TABLE).value(x) of prowl/model/limit_curve.hpp; tests/model/limit_curve_test.cpp has the same numbers.
        curve = load_script().limit_curve(TABLE)
        for x, limit in TABLE:
            self.assertAlmostEqual(curve(x), limit)
        for x, limit in [(0.2, 63.28), (0.7, 87.38), (1.3, 80.74), (1.9, 45.48)]:
            self.assertAlmostEqual(float(curve(x)), limit, places=9)


if __name__ == "__main__":
    unittest.main()
