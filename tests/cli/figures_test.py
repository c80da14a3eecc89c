"""prowl figures on HyQ's crouch: its tables against numbers computed again from the plan and the simulation, its pictures
against being empty, its faults told in words.

    figures_test.py PROWL ROBOTS_DATA
"""

import csv
import importlib.machinery
import importlib.util
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np

ROOT = pathlib.Path(__file__).parents[2]
FIGURES = ("torques", "contact_acceleration", "base_error", "joint_error", "gains", "torque_over_position")
PALETTE = {
    "blue": (0, 114, 178),
    "vermillion": (213, 94, 0),
    "green": (0, 158, 115),
    "sky": (86, 180, 233),
    "black": (0, 0, 0),
}
COLOURS = {
    "torques": ("blue", "vermillion", "green"),
    "contact_acceleration": ("sky", "black"),
    "base_error": ("blue", "vermillion", "green"),
    "joint_error": ("blue",),
    "gains": ("blue", "vermillion", "green"),
    "torque_over_position": ("sky", "vermillion", "black"),
}
CURVES = {
    "torques": 12 * 4,
    "contact_acceleration": 4 * 3 * 2,
    "base_error": 4 * 3,
    "joint_error": 12 * 2,
    "gains": 36,
    "torque_over_position": 4 * (2 + 2),
}
LABELS = {
    "torques": ("torque [N m]", "feedback", "feedforward", "lh_kfe_joint"),
    "contact_acceleration": ("[m/s²]", r"$J\,a$", r"$-\dot{J}\,v$"),
    "base_error": ("position [mm]", "orientation [deg]"),
    "joint_error": ("angle [deg]",),
    "gains": ("on joint rates [N m s/rad]", "rh_kfe_joint"),
    "torque_over_position": ("position [rad]", "limit"),
}
command = robots = None


def prowl(*arguments) -> subprocess.CompletedProcess:
    return subprocess.run([command, *map(str, arguments), "--package-dir", robots], capture_output=True, text=True)


def read(path: pathlib.Path) -> dict[str, np.ndarray]:
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def columns(table: dict[str, np.ndarray], names) -> np.ndarray:
    return np.column_stack([table[name] for name in names])


def rotation_vector(before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """log(R(before)' R(after)) of quaternions x y z w, by the product of quaternions; rows."""
    u, a = -before[:, :3], before[:, 3:]
    w, b = after[:, :3], after[:, 3:]
    vector, scalar = a * w + b * u + np.cross(u, w), a * b - np.sum(u * w, axis=1, keepdims=True)
    vector = np.where(scalar < 0, -vector, vector)
    sine = np.linalg.norm(vector, axis=1, keepdims=True)
    return vector * np.where(sine > 1e-12, 2 * np.arctan2(sine, np.abs(scalar)) / np.maximum(sine, 1e-300), 2)


def state_difference(sim, joints) -> np.ndarray:
    """x* ⊖ x of docs/tracking.md, rows; x* with the feet on the ground that they found."""
    quaternions = [columns(sim, [f"{kind}_base_q{c}" for c in "xyzw"]) for kind in ("true", "ref")]
    velocities = [
        f"base_{c}_{unit}" for c, unit in zip(("vx", "vy", "vz", "wx", "wy", "wz"), ["mps"] * 3 + ["radps"] * 3)
    ]
    less = lambda names: columns(sim, [f"ref_{n}" for n in names]) - columns(sim, [f"true_{n}" for n in names])  # noqa: E731
    return np.hstack(
        [
            less([f"base_p{c}_m" for c in "xyz"]),
            rotation_vector(*quaternions),
            columns(sim, [f"tracked_q_{j}_rad" for j in joints]) - columns(sim, [f"true_q_{j}_rad" for j in joints]),
            less(velocities),
            less([f"v_{j}_radps" for j in joints]),
        ]
    )


class Figures(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.plan = pathlib.Path(cls.folder.name) / "a plan; with 'odd' name"
        cls.run_or_fail("plan", ROOT / "tasks/hyq/crouch.toml", "--out", cls.plan)
        cls.early = prowl("figures", cls.plan, "--out", cls.plan.with_name("early"))
        cls.run_or_fail("simulate", cls.plan, "--record-rate", 1000)
        cls.run_or_fail("figures", cls.plan)
        cls.joints = json.loads((cls.plan / "plan.json").read_text())["problem"]["joints"]
        cls.nodes, cls.sim = read(cls.plan / "trajectory.csv"), read(cls.plan / "simulate.csv")
        cls.result = json.loads((cls.plan / "simulate.json").read_text())

    @classmethod
    def run_or_fail(cls, *arguments):
        done = prowl(*arguments)
        if done.returncode != 0:
            raise AssertionError(f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}")
        return done

    def table(self, name: str):
        return read(self.plan / "figures" / f"{name}.csv")

    def test_pictures_show_something(self):
        from matplotlib.image import imread

        for name in FIGURES:
            with self.subTest(name):
                image = np.round(255 * imread(self.plan / "figures" / f"{name}.png")[:, :, :3]).astype(int)
                self.assertGreater(min(image.shape[:2]), 500)
                white = np.mean(np.all(image == 255, axis=2))
                self.assertTrue(0.3 < white < 0.98, f"{white:.3f} of it is white")
                for colour in COLOURS[name]:
                    drawn = np.sum(np.all(np.abs(image - PALETTE[colour]) < 12, axis=2))
                    self.assertGreater(drawn, 500, f"{colour}: lines are missing")
                text = (self.plan / "figures" / f"{name}.svg").read_text(encoding="utf-8")
                paths = ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}path")
                curves = [
                    p
                    for p in paths
                    if p.get("clip-path") and "fill: none" in p.get("style", "") and p.get("d", "").count("L") > 4
                ]
                self.assertGreaterEqual(len(curves), CURVES[name])
                for label in LABELS[name]:
                    self.assertIn(label, text)

    def test_torques_are_feedforward_and_feedback_after_the_delay(self):
        table = self.table("torques")
        end = self.nodes["time_s"][-1]
        sums = 0.0
        for joint in self.joints:
            applied, plan = table[f"tau_{joint}_Nm"], table[f"plan_{joint}_Nm"]
            np.testing.assert_array_equal(applied, self.sim[f"tau_{joint}_Nm"])
            commanded = self.sim[f"feedforward_{joint}_Nm"] + self.sim[f"feedback_{joint}_Nm"]
            np.testing.assert_allclose(applied[2:], commanded[:-2], atol=1e-5, err_msg="2 ms are two rows")
            np.testing.assert_allclose(
                (table[f"feedforward_{joint}_Nm"] + table[f"feedback_{joint}_Nm"])[3:], applied[3:], atol=1e-4
            )
            sums += np.abs(table[f"feedback_{joint}_Nm"]).max()

            during = table["time_s"] <= end
            expected = np.interp(table["time_s"], self.nodes["time_s"], self.nodes[f"tau_{joint}_Nm"])
            np.testing.assert_allclose(plan[during], expected[during], atol=1e-5)
            self.assertTrue(np.all(np.isnan(plan[~during])))
            # The tracker is linear between samples 2 ms apart, the plan between its nodes, 25 ms apart.
            np.testing.assert_allclose(table[f"feedforward_{joint}_Nm"][during][3:-3], plan[during][3:-3], atol=0.5)
            self.assertTrue(np.all(applied[during] <= table[f"upper_{joint}_Nm"][during] * 1.001))
            self.assertTrue(np.all(applied[during] >= table[f"lower_{joint}_Nm"][during] * 1.001))
        self.assertGreater(sums, 1.0, "no feedback at all")

    def test_contacts_do_not_accelerate(self):
        table = self.table("contact_acceleration")
        pairs = [(n, "minus_Jdotv" + n[2:]) for n in table if n.startswith("Ja_")]
        self.assertEqual(len(pairs), 12)
        largest = max(np.abs(table[a]).max() for a, _ in pairs)
        self.assertGreater(largest, 0.05, "nothing moves")
        for a, b in pairs:
            self.assertLess(np.abs(table[a] - table[b]).max(), 0.03 * largest, a)

    def test_base_error_is_that_of_the_simulation(self):
        table = self.table("base_error")
        for name, before, after, kinds in (
            ("error", "ref", "true", ("base_position_m", "base_angle_rad")),
            ("estimate_error", "true", "seen", ("estimated_position_m", "estimated_angle_rad")),
        ):
            p = [columns(self.sim, [f"{kind}_base_p{c}_m" for c in "xyz"]) for kind in (before, after)]
            r = rotation_vector(*(columns(self.sim, [f"{kind}_base_q{c}" for c in "xyzw"]) for kind in (before, after)))
            position = columns(table, [f"{name}_p{c}_m" for c in "xyz"])
            angle = columns(table, [f"{name}_r{c}_rad" for c in "xyz"])
            np.testing.assert_allclose(position, p[1] - p[0], atol=1e-8)
            np.testing.assert_allclose(angle, r, atol=1e-7)
            for values, kind in zip((position, angle), kinds):
                size = np.linalg.norm(values, axis=1)
                self.assertGreater(size.max(), 1e-5, "no error: noise and delay are missing")
                self.assertAlmostEqual(size.max(), self.result[kind]["largest"], delta=1e-6)
                self.assertAlmostEqual(np.sqrt(np.mean(size**2)), self.result[kind]["rms"], delta=1e-6)

    def test_joint_error_is_that_of_the_simulation(self):
        table = self.table("joint_error")
        for joint in self.joints:
            for name, before, after in (("error", "ref", "true"), ("estimate_error", "true", "seen")):
                np.testing.assert_allclose(
                    table[f"{name}_{joint}_rad"],
                    self.sim[f"{after}_q_{joint}_rad"] - self.sim[f"{before}_q_{joint}_rad"],
                    atol=1e-8,
                )
        worst = max(np.abs(table[f"error_{joint}_rad"]).max() for joint in self.joints)
        self.assertAlmostEqual(worst, self.result["joints_rad"]["largest"], delta=1e-6)

    def test_gains_give_the_feedback(self):
        """Of a joint that is asked for: K(t) (x* ⊖ x) with the table's K is the feedback torque that was simulated."""
        joint, out = "lh_kfe_joint", self.plan.with_name("told")
        told = self.plan.with_name("told plan")
        told.mkdir()
        for name in ("plan.json", "trajectory.csv", "tracker.bin"):
            (told / name).write_bytes((self.plan / name).read_bytes())
        self.run_or_fail(
            "simulate", told, "--perfect-state", "--delay", 0, "--push", 0.5, 5, 15, 0, "--record-rate", 500
        )
        self.run_or_fail("figures", told, "--joint", joint, "--out", out)
        self.assertFalse((told / "figures").exists())
        gains, sim = read(out / "gains.csv"), read(told / "simulate.csv")
        names = [n for n in gains if n not in ("time_s", "segment")]
        self.assertEqual(len(names), 36)
        difference = state_difference(sim, self.joints)
        during = sim["time_s"] < self.nodes["time_s"][-1] - 1e-9
        K = np.column_stack([np.interp(sim["time_s"], gains["time_s"], gains[n]) for n in names])
        feedback = np.sum(K * difference, axis=1)
        self.assertGreater(np.abs(feedback[during]).max(), 5.0, "the push did nothing")
        np.testing.assert_allclose(feedback[during], sim[f"feedback_{joint}_Nm"][during], atol=1e-3)

    def test_draws_a_rollout(self):
        """Of the other engine: the same tables, no delay, and the feedback is K(t) (x* ⊖ x) of its own series."""
        plan, out = self.plan.with_name("rolled out"), self.plan.with_name("rollout figures")
        plan.mkdir()
        for name in ("plan.json", "trajectory.csv", "tracker.bin"):
            (plan / name).write_bytes((self.plan / name).read_bytes())
        self.run_or_fail(
            "simulate", plan, "--engine", "rollout", "--base-offset-m", 0, 0.02, 0.03, "--record-rate", 500
        )
        self.run_or_fail("figures", plan, "--joint", "lh_kfe_joint", "--out", out)
        self.assertIn(
            "rollout of the projected dynamics, closed loop, continuous control, base off at the start, success",
            (out / "torques.svg").read_text(encoding="utf-8"),
        )
        sim, gains, torques = read(plan / "simulate.csv"), read(out / "gains.csv"), read(out / "torques.csv")
        self.assertEqual(list(sim), list(self.sim), "columns of both engines")
        for joint in self.joints:
            np.testing.assert_allclose(
                torques[f"feedforward_{joint}_Nm"] + torques[f"feedback_{joint}_Nm"], sim[f"tau_{joint}_Nm"], atol=1e-4
            )
        during = sim["time_s"] < self.nodes["time_s"][-1] - 1e-9
        names = [n for n in gains if n not in ("time_s", "segment")]
        K = np.column_stack([np.interp(sim["time_s"], gains["time_s"], gains[n]) for n in names])
        feedback = np.sum(K * state_difference(sim, self.joints), axis=1)
        self.assertGreater(np.abs(feedback[during]).max(), 5.0, "the offset did nothing")
        np.testing.assert_allclose(feedback[during], sim["feedback_lh_kfe_joint_Nm"][during], atol=1e-3)

    def test_knees_keep_to_their_curve(self):
        loader = importlib.machinery.SourceFileLoader("plot_knee", str(ROOT / "scripts/plot_knee"))
        plot_knee = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_knee", loader))
        loader.exec_module(plot_knee)
        robot = tomllib.loads(json.loads((self.plan / "plan.json").read_text())["robot_file"]["text"])
        knees = {
            j: (v["torque_over_position"], v.get("negative_torque_over_position", v["torque_over_position"]))
            for j, v in robot["limits"].items()
            if "torque_over_position" in v
        }
        self.assertEqual(len(knees), 4)
        with open(self.plan / "figures/limit_curves.csv", newline="") as file:
            curves = list(csv.DictReader(file))
        with open(self.plan / "figures/torque_over_position.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        for joint, (positive, negative) in knees.items():
            x, upper, lower = np.array(
                [
                    [float(r[key]) for key in ("position_rad", "limit_Nm", "lower_limit_Nm")]
                    for r in curves
                    if r["joint"] == joint
                ]
            ).T
            np.testing.assert_allclose(upper, plot_knee.limit_curve(positive)(x), rtol=1e-9)
            np.testing.assert_allclose(lower, -plot_knee.limit_curve(negative)(x), rtol=1e-9)
            for series, source, prefix in (("plan", self.nodes, ""), ("simulation", self.sim, "true_")):
                drawn = np.array(
                    [
                        (float(r["position_rad"]), float(r["torque_Nm"]))
                        for r in rows
                        if (r["joint"], r["series"]) == (joint, series)
                    ]
                )
                np.testing.assert_allclose(
                    drawn, columns(source, [f"{prefix}q_{joint}_rad", f"tau_{joint}_Nm"]), rtol=1e-8, atol=1e-8
                )
                at, torque = drawn.T
                limit = np.where(torque < 0, plot_knee.limit_curve(negative)(at), plot_knee.limit_curve(positive)(at))
                self.assertLessEqual(np.max(np.abs(torque) / limit), 1.001, series)

    def test_tells_that_there_is_no_simulation(self):
        self.assertEqual(self.early.returncode, 0, self.early.stderr)
        self.assertIn(f"prowl simulate {self.plan}", self.early.stderr)
        files = {path.name for path in self.plan.with_name("early").iterdir()}
        self.assertIn("gains.svg", files)
        self.assertNotIn("base_error.svg", files)

    def test_same_input_same_files(self):
        again = self.plan.with_name("again")
        self.run_or_fail("figures", self.plan, "--out", again)
        for path in (self.plan / "figures").iterdir():
            self.assertEqual((again / path.name).read_bytes(), path.read_bytes(), path.name)

    def test_tells_what_is_wrong(self):
        joint = prowl("figures", self.plan, "--joint", "lh_kfe_joit")
        self.assertEqual(joint.returncode, 2)
        self.assertIn("did you mean 'lh_kfe_joint'?", joint.stderr)
        self.assertEqual(prowl("figures", self.plan.with_name("nothing")).returncode, 2)
        self.assertEqual(prowl("figures", self.plan, "--python", "/nowhere/python").returncode, 2)
        bare = self.plan.with_name("bare python")
        bare.write_text(f'#!/bin/sh\nexec "{sys.executable}" -S "$@"\n')
        bare.chmod(0o755)
        missing = prowl("figures", self.plan, "--python", bare)
        self.assertEqual(missing.returncode, 2, missing.stderr)
        self.assertIn("matplotlib", missing.stderr)
        self.assertTrue((self.plan / "figures/torques.png").exists(), "what was there stays")

    def test_a_new_plan_removes_the_figures_but_no_strange_file(self):
        plan = self.plan.with_name("replaced")
        again = ("plan", ROOT / "tasks/hyq/stand.toml", "--no-gains", "--out", plan)
        self.run_or_fail(*again)
        done = self.run_or_fail("figures", plan)
        self.assertIn("no gains", done.stderr)
        strange = plan / "figures/notes.txt"
        strange.write_text("mine")
        for attempt in (("figures", plan), again):
            refused = prowl(*attempt)
            self.assertEqual(refused.returncode, 4, refused.stderr)
            self.assertIn("notes.txt", refused.stderr)
        strange.unlink()
        self.run_or_fail(*again)
        self.assertFalse((plan / "figures").exists())


if __name__ == "__main__":
    command, robots = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
