"""scripts/paper: every figure of the paper is drawn, the tables have the numbers of the plans, and the motions do what the paper's
do. Plans are read here by other means: Python's CSV and JSON, and leg kinematics from the URDF.

    paper_test.py PROWL ROBOTS_DATA
"""

import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest
import xml.etree.ElementTree as ElementTree

import numpy as np
from PIL import Image
from scipy.spatial.transform import Rotation

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "site/pictures"))
from skeleton import Skeleton, pose  # noqa: E402  (after the path)
from plans import Table  # noqa: E402

SCRIPT = ROOT / "scripts/paper"
TASKS = ("stand", "crouch", "balance", "step", "rear")
SINGLE_PHASE = ("stand", "crouch")
MESHES = {"task file": "", "--refine": "-refine"}  # as the table names them: ending of the plan's folder
FEET = ("lf_foot", "lh_foot", "rf_foot", "rh_foot")
FIGURES = {
    "fig_01_knee_torque_limit",
    "fig_02_phases",
    "fig_03_hyq",
    "fig_04_gains",
    "fig_05_standing_torques",
    "fig_06_contact_acceleration",
    "fig_07_standing",
    "fig_08_crouching",
    "fig_09_balancing",
    "fig_10_stepping",
    "fig_11_rearing",
    "fig_12_multiphase_motions",
    "still_standing",
    "still_crouching",
}
CURVES = {
    "fig_01_knee_torque_limit": 5 * 4 + 1,
    "fig_02_phases": 1 + 3 * 2 + 3,
    "fig_04_gains": 36,
    "fig_05_standing_torques": 12,
    "fig_06_contact_acceleration": 4 * 2 * 3 * 2,
    "fig_07_standing": 3 + 3 + 3 + 12 * 4,
    "fig_08_crouching": 3 + 3 + 3 + 12 * 4,
}
ROBOT_PICTURES = {
    "fig_03_hyq",
    "fig_09_balancing",
    "fig_10_stepping",
    "fig_11_rearing",
    "still_standing",
    "still_crouching",
}
SVG = "{http://www.w3.org/2000/svg}"
command = robots = None


def run(out: pathlib.Path) -> subprocess.CompletedProcess:
    arguments = [sys.executable, SCRIPT, "--prowl", command, "--package-dir", robots, "--out", out]
    return subprocess.run(arguments, capture_output=True, text=True)


def nominal_posture() -> tuple[np.ndarray, dict[str, float]]:
    """Base and joints, from the robot file and the kinematics of the URDF: the feet's balls touch z = 0."""
    robot = tomllib.loads((ROOT / "robots/hyq.toml").read_text(encoding="utf-8"))
    joints, radius = robot["nominal"]["joints"], robot["contact"][0]["radius_m"]
    urdf = (pathlib.Path(robots) / robot["urdf"].removeprefix("package://")).read_text(encoding="utf-8")
    kinematics = Skeleton(urdf)
    level = (np.zeros(3), Rotation.identity())
    feet = np.array([kinematics.points(foot, level, joints)[0][-1] for foot in FEET])
    return np.array([*-feet.mean(axis=0)[:2], radius - feet[:, 2].min()]), joints


class PlanFolder:
    def __init__(self, folder: pathlib.Path):
        self.json = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
        self.table = Table(folder / "trajectory.csv")
        self.kinematics = Skeleton(self.json["urdf"]["text"])
        self.base = self.table.columns("base_px_m", "base_py_m", "base_pz_m")

    def feet(self, node: int) -> dict[str, np.ndarray]:
        base, joints = pose(self.table, node)
        return {foot: self.kinematics.points(foot, base, joints)[0][-1] for foot in FEET}

    def nodes(self, phase: str) -> np.ndarray:
        names = [entry["name"] for entry in self.json["problem"]["phases"]]
        return np.flatnonzero(self.table["phase"] == names.index(phase))

    def middle(self, phase: str) -> int:
        """The node of half its time."""
        nodes, time = self.nodes(phase), self.table["time_s"]
        half = (time[nodes[0]] + time[nodes[-1]]) / 2
        return int(nodes[np.argmin(np.abs(time[nodes] - half))])

    def nose_up(self, node: int) -> float:
        """[rad]"""
        return float(np.arcsin(pose(self.table, node)[0][1].as_matrix()[2, 0]))


class Paper(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.out = pathlib.Path(folder.name) / "paper"
        result = run(cls.out)
        assert result.returncode == 0, result.stdout + result.stderr
        cls.plans = {
            (task, mesh): PlanFolder(cls.out / f"work/paper-{task}{ending}")
            for task in TASKS
            for mesh, ending in MESHES.items()
        }
        cls.tasks = {task: tomllib.loads((ROOT / f"tasks/paper/{task}.toml").read_text("utf-8")) for task in TASKS}

    def rows(self, name: str) -> list[dict[str, str]]:
        with open(self.out / f"{name}.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def on_both_meshes(self, task: str, check) -> None:
        for mesh in MESHES:
            with self.subTest(task=task, mesh=mesh):
                check(self.plans[task, mesh])

    # Figures

    def test_every_figure_is_there(self):
        self.assertEqual({path.stem for path in self.out.glob("*.svg")}, FIGURES)
        self.assertEqual({path.stem for path in self.out.glob("*.png")}, FIGURES)
        numbers = {int(name[4:6]) for name in FIGURES if name.startswith("fig_")}
        self.assertEqual(numbers, set(range(1, 13)), "the paper has twelve")

    def test_figures_have_their_curves(self):
        for name, count in CURVES.items():
            with self.subTest(name):
                root = ElementTree.parse(self.out / f"{name}.svg").getroot()
                panels = [group for group in root.iter(f"{SVG}g") if group.get("id", "").startswith("axes_")]
                lines = [
                    group
                    for panel in panels
                    for group in panel.findall(f"{SVG}g")
                    if group.get("id", "").startswith("line2d_")
                    and any(part.tag in (f"{SVG}path", f"{SVG}use") for part in group.iter())
                ]
                self.assertGreaterEqual(len(lines), count)

    def test_robots_fill_their_pictures(self):
        for name in ROBOT_PICTURES:
            with self.subTest(name):
                self.assertGreater(self.dark_share(name), 0.02)
        third = [self.dark_share("fig_12_multiphase_motions", i / 3, (i + 1) / 3) for i in range(3)]
        self.assertGreater(min(third), 0.02, "one of the three motions is missing")
        self.assertNotEqual(*(self.pixels(name).tobytes() for name in ("fig_09_balancing", "fig_10_stepping")))

    def pixels(self, name: str) -> np.ndarray:
        with Image.open(self.out / f"{name}.png") as image:
            return np.asarray(image.convert("RGB")).astype(int)

    def dark_share(self, name: str, start: float = 0.0, end: float = 1.0) -> float:
        """Part of a picture in the colour of HyQ's legs, which nothing else has: dark, and bluer than red."""
        pixels = self.pixels(name)
        pixels = pixels[:, int(start * pixels.shape[1]) : int(end * pixels.shape[1])]
        return float(np.mean((pixels.max(axis=-1) < 100) & (pixels[..., 2] > pixels[..., 0] + 4)))

    # Tables

    def test_table_one_is_that_of_the_paper_beside_our_own_counts(self):
        rows = {
            row["method"]: [int(row[c]) if row[c] else None for c in list(row)[1:5]] for row in self.rows("table_1")
        }
        q = v = 18
        torques, feet, knees = 12, 4, 4
        self.assertEqual(rows["centroidal dynamics"], [76, 63, 75, 67])
        self.assertEqual(rows["projection"], [49, 48, q + v + torques, q + v + feet + feet + 2 * knees])
        inverse = next(numbers for method, numbers in rows.items() if "inverse" in method)
        self.assertEqual(inverse, [None, None, *self.size_of_a_node_of_stand()])

    def size_of_a_node_of_stand(self) -> tuple[int, int]:
        """What a plan on seven nodes has more than the one on six."""
        with tempfile.TemporaryDirectory() as folder:
            task, out = ROOT / "tasks/paper/stand.toml", pathlib.Path(folder) / "out"
            options = ["--intervals", "6", "--no-gains", "--package-dir", robots, "--out", out]
            subprocess.run([command, "plan", task, *options], capture_output=True)  # fails its certificate
            seven = json.loads((out / "plan.json").read_text(encoding="utf-8"))["problem"]
        six = self.plans["stand", "task file"].json["problem"]
        return seven["variables"] - six["variables"], seven["constraints"] - six["constraints"]

    def test_table_of_plans_has_their_numbers(self):
        rows = self.rows("plans")
        self.assertEqual([(row["motion"], row["mesh"]) for row in rows], list(self.plans))
        for row in rows:
            plan = self.plans[row["motion"], row["mesh"]]
            with self.subTest(motion=row["motion"], mesh=row["mesh"]):
                self.assertEqual(int(row["nodes"]), len(plan.base))
                for size in ("variables", "constraints"):
                    self.assertEqual(int(row[size]), plan.json["problem"][size])
                self.assertEqual(row["status"], plan.json["status"])
                self.assertEqual(row["certificate"], plan.json["certificate"]["grade"])
                self.assertEqual(sum(map(int, row["iterations"].split(" + "))), plan.json["solver"]["iterations"])

    def test_all_converge_and_their_own_meshes_fail_the_certificate(self):
        for (task, mesh), plan in self.plans.items():
            with self.subTest(task=task, mesh=mesh):
                self.assertEqual(plan.json["status"], "converged")
                self.assertEqual(plan.json["certificate"]["passed"], mesh == "--refine")

    def test_all_survive_both_simulations(self):
        rows = self.rows("simulations")
        self.assertEqual(len(rows), 2 * len(TASKS))
        for row in rows:
            with self.subTest(motion=row["motion"], engine=row["engine"]):
                self.assertEqual(row["result"], "success")
        simulated = json.loads((self.out / "work/paper-rear-refine/simulate.json").read_text(encoding="utf-8"))
        self.assertEqual((simulated["engine"], simulated["options"]["perfect_state"]), ("mujoco", False))

    def test_papers_formulation_solves_them(self):
        rows = [row for row in self.rows("formulations") if row["feet"] != "on the ground"]
        self.assertEqual([row["motion"] for row in rows], list(TASKS))
        for row in rows:
            with self.subTest(row["motion"]):
                self.assertEqual(row["status"], "converged")
                plan = self.plans[row["motion"], "task file"]
                ours = plan.json["solver"]["cost"]
                self.assertLess(abs(float(row["cost"]) - ours), 0.02 * ours, "one problem, two formulations")

    # Motions

    def test_tasks_ask_as_the_paper_does(self):
        for task, document in self.tasks.items():
            with self.subTest(task):
                self.assertFalse([key for key in document["cost"] if "acceleration" in key or key == "force"])
                self.assertEqual("goal" in document, task not in SINGLE_PHASE)
                free = [isinstance(phase["duration_s"], list) for phase in document["phase"]]
                self.assertEqual(set(free), {task not in SINGLE_PHASE})
        (phase,) = self.tasks["stand"]["phase"]
        self.assertEqual((phase["duration_s"], phase["intervals"]), (2.0, 5))

    def test_robot_with_trunk_is_hyq_with_one_contact_more(self):
        hyq, with_trunk = (
            tomllib.loads((ROOT / f"robots/{name}.toml").read_text("utf-8")) for name in ("hyq", "hyq_trunk")
        )
        self.assertEqual(with_trunk.pop("name"), hyq.pop("name") + " with trunk")
        self.assertEqual(with_trunk["contact"].pop(), {"name": "trunk", "frame": "trunk"})
        self.assertEqual(with_trunk, hyq)

    def test_stand_returns_to_the_nominal_posture(self):
        place, joints = nominal_posture()

        def check(plan: PlanFolder) -> None:
            away = np.linalg.norm(plan.base - place, axis=1)
            self.assertGreater(away[0], 0.05)
            self.assertLess(away[-1], 0.1 * away[0])
            off = [max(abs(pose(plan.table, node)[1][j] - joints[j]) for j in joints) for node in (0, -1)]
            self.assertLess(off[1], 0.1 * off[0])

        self.on_both_meshes("stand", check)
        self.assertEqual(len(self.plans["stand", "task file"].base), 6)

    def test_crouch_goes_down_by_cost_alone(self):
        place, _ = nominal_posture()

        def check(plan: PlanFolder) -> None:
            np.testing.assert_allclose(plan.base[0], place, atol=1e-6)
            self.assertLess(plan.base[-1, 2] - place[2], -0.12)
            self.assertGreater(plan.base[-1, 2] - place[2], -0.17, "the cost weighs other things, too")
            self.assertLess(np.max(np.abs(plan.base[:, :2])), 0.01)

        self.on_both_meshes("crouch", check)

    def test_feet_of_single_phase_motions_stay(self):
        def check(plan: PlanFolder) -> None:
            first, last = plan.feet(0), plan.feet(-1)
            for foot in FEET:
                self.assertLess(np.linalg.norm(last[foot] - first[foot]), 0.01)

        for task in SINGLE_PHASE:
            self.on_both_meshes(task, check)

    def test_balance_lifts_two_diagonal_feet(self):
        def check(plan: PlanFolder) -> None:
            start, up = plan.feet(0), plan.feet(plan.middle("balance"))
            height = {foot: up[foot][2] - start[foot][2] for foot in FEET}
            self.assertGreater(min(height["lf_foot"], height["rh_foot"]), 0.065)
            self.assertLess(max(abs(height["lh_foot"]), abs(height["rf_foot"])), 0.001)

        self.on_both_meshes("balance", check)

    def test_step_moves_a_foot(self):
        def check(plan: PlanFolder) -> None:
            start, up, end = (plan.feet(node)["lf_foot"] for node in (0, plan.middle("swing"), -1))
            self.assertGreater(up[2] - start[2], 0.065)
            np.testing.assert_allclose(end - start, [0.2, 0, 0], atol=2e-3)

        self.on_both_meshes("step", check)

    def test_rear_pitches_up(self):
        def check(plan: PlanFolder) -> None:
            node = plan.middle("rear")
            start, up = plan.feet(0), plan.feet(node)
            self.assertAlmostEqual(plan.nose_up(node), 0.27, places=3)
            self.assertGreater(min(up[foot][2] - start[foot][2] for foot in ("lf_foot", "rf_foot")), 0.025)
            self.assertLess(abs(plan.nose_up(-1)), 0.05)

        self.on_both_meshes("rear", check)

    def test_durations_are_within_their_ranges(self):
        for task in set(TASKS) - set(SINGLE_PHASE):
            for phase in self.tasks[task]["phase"]:
                low, high = phase["duration_s"]
                for mesh in MESHES:
                    plan = self.plans[task, mesh]
                    time = plan.table["time_s"][plan.nodes(phase["name"])]
                    self.assertTrue(low - 1e-6 <= time[-1] - time[0] <= high + 1e-6)

    # Page

    def test_page_shows_all_and_lists_the_differences(self):
        page = (self.out / "index.md").read_text(encoding="utf-8")
        source = (ROOT / "docs/paper.md").read_text(encoding="utf-8")
        section = source[source.index("## Differences") : source.index("## The paper redone")]
        subjects = re.findall(r"^\| ([^|]+) \|", section, re.MULTILINE)
        for subject in ("phase transition", "before a contact opens", "friction cone", "crouch", "start"):
            self.assertIn(subject, subjects)
        tables = [row for name in ("table_1", "plans", "simulations", "formulations") for row in self.rows(name)]
        expected = [f"({name}.png)" for name in FIGURES]
        expected += [f"| {' | '.join(row.values())} |" for row in tables]
        expected += [f"| {subject} |" for subject in subjects]
        self.assertEqual([text for text in expected if text not in page], [])
        links = [link for link in re.findall(r"\]\(([^)\s#]+)", page) if not link.startswith("https://")]
        self.assertEqual([link for link in links if not (self.out / link).exists()], [])

    def test_leaves_the_folders_of_others_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            mine = pathlib.Path(folder) / "index.md"
            mine.write_text("# Mine\n")
            result = run(pathlib.Path(folder))
            self.assertEqual(result.returncode, 1)
            self.assertIn("not a folder that scripts/paper wrote", result.stderr)
            self.assertEqual(mine.read_text(), "# Mine\n")


if __name__ == "__main__":
    command, robots = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
