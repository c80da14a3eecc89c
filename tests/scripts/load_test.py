"""Random tasks of scripts/load depend on the seed alone, and its report counts what the judge found."""

import pathlib
import random
import sys
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
from load.quantiles import quantiles  # noqa: E402  (after the path)
from load.random_tasks import ROBOTS, draw, folder  # noqa: E402
from load.report import pairs, table  # noqa: E402
from load.tally import SETTLED, Tally  # noqa: E402


def drawn(seed: int, count: int) -> list[tuple[str, dict]]:
    source = random.Random(seed)
    return [draw(source) for _ in range(count)]


def motion(seconds: float, error: float, *broken: str, good: bool = True) -> dict:
    return {
        "converged": True,
        "good": good,
        "iterations": 5,
        "seconds": seconds,
        "error": error,
        "keeps_task": not broken,
        "worst": {"check": broken[0] if broken else "slip"},
    }


class RandomTasks(unittest.TestCase):
    def test_same_seed_same_tasks(self) -> None:
        self.assertEqual(drawn(1, 20), drawn(1, 20))
        self.assertNotEqual(drawn(1, 20), drawn(2, 20))
        # Those of docs/reliability.md: a change here makes its figures those of other tasks.
        self.assertEqual([robot for robot, _ in drawn(1, 6)], ["anymal_c", "hyq", "go2", "solo12", "go2", "hyq"])

    def test_they_are_what_the_documentation_says(self) -> None:
        reach = {robot: most for robot, _, most in ROBOTS}
        seen, moving = set(), 0
        for robot, task in drawn(5, 200):
            seen.add(robot)
            surface, phase, (there, back) = task["surface"][0], task["phase"][0], task["goal"]
            self.assertTrue((folder(robot) / task["robot"]).is_file())
            self.assertAlmostEqual(sum(n * n for n in surface["normal"]), 1.0)
            self.assertGreaterEqual(surface["normal"][2], 0.9659)  # 15 degrees
            self.assertTrue(0.2 <= surface["friction"] <= 1.0)
            self.assertTrue(0.8 <= phase["duration_s"] <= 3.0)
            self.assertNotIn("intervals", phase)
            moving += "base_linear_velocity_mps" in task["start"]
            self.assertEqual([there["time_s"], back["time_s"]], [0.5 * phase["duration_s"], phase["duration_s"]])
            self.assertLessEqual(max(map(abs, there["base_displacement_m"])), reach[robot])
            self.assertEqual(back["base_displacement_m"], [0, 0, 0])
        self.assertEqual(seen, set(reach))
        self.assertTrue(80 <= moving <= 120, "half of 200")


class Report(unittest.TestCase):
    def setUp(self) -> None:
        refused = {"converged": False, "good": False, "failed": "refused"}
        ours = [motion(0.1, 1e-4), motion(0.2, 2e-3, good=False), refused, motion(0.3, 1e-4)]
        theirs = [
            motion(0.2, 1e-2),
            motion(0.4, 1e-3, "slip"),
            motion(0.8, 1e-3),
            motion(0.1, 1e-3, "friction", "slip"),
        ]
        self.records = [{"solvers": {"prowl": a, "sqp:0.01": b}} for a, b in zip(ours, theirs)]

    def rows(self) -> dict[str, list[str]]:
        cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in table(self.records).splitlines()]
        return {row[0]: row[1:] for row in cells}

    def test_counts(self) -> None:
        rows = self.rows()
        self.assertEqual(rows[""], ["Prowl", "SQP, 10 ms"])
        self.assertEqual(rows["says that it converged"], ["3 (75 %)", "4 (100 %)"])
        self.assertEqual(rows["keeps its task"], ["3 (75 %)", "2 (50 %)"])
        self.assertEqual(rows["... of those that Prowl's certificate passes"], ["2 (100 %)", "1 (50 %)"])
        self.assertEqual(rows["keeps it, error of an interval ≤ 0.0005"], ["2 (50 %)", "0 (0 %)"])
        self.assertEqual(rows["keeps it, error of an interval ≤ 0.005"], ["3 (75 %)", "1 (25 %)"])
        self.assertEqual(rows["breaks most"], ["refused 1", "slip 1, friction 1"])

    def test_times(self) -> None:
        rows = self.rows()
        self.assertTrue(rows["CPU time where it keeps its task [s]"][0].startswith("0.20, "))
        self.assertTrue(rows["CPU time where not [s]"][1].endswith(", 0.40"))
        self.assertEqual(rows["CPU time where not [s]"][0], "-")

    def test_pairs(self) -> None:
        self.assertEqual(
            pairs(self.records),
            "Prowl and SQP, 10 ms: both keep 1, Prowl alone 2, SQP, 10 ms alone 1, none 0; "
            "Prowl's CPU time over its where both do: 0.50, 0.50, 0.50, 0.50",
        )

    def test_quantiles_stay_within_the_values(self) -> None:
        self.assertEqual(quantiles([]), [])
        self.assertEqual(quantiles([3.0]), [3.0, 3.0, 3.0, 3.0])
        self.assertEqual(quantiles([float(n) for n in range(101)]), [50.0, 90.0, 99.0, 100.0])
        self.assertLessEqual(max(quantiles([1.0, 2.0, 4.0])), 4.0)


def plan(
    status: str, *failed: str, good: bool = False, hints: tuple[str, ...] = (), message: str = ""
) -> types.SimpleNamespace:
    checks = [
        types.SimpleNamespace(name=name, passed=name not in failed) for name in ("friction cone", "contact drift")
    ]
    return types.SimpleNamespace(
        status=status,
        good=good,
        reasons=[],
        hints=list(hints),
        message=message,
        certificate=types.SimpleNamespace(checks=checks),
    )


class WhatBecameOfThem(unittest.TestCase):
    def test_a_failure_has_to_say_why(self) -> None:
        tally = Tally({"steep": "too little friction", "easy": ""}.__getitem__)
        self.assertEqual(tally.add(0, "easy", plan("converged", good=True), 0.1), "good")
        self.assertEqual(
            tally.add(1, "easy", plan("converged", "friction cone"), 0.1),
            "converged, certificate failed: certificate: friction cone",
        )
        self.assertEqual(
            tally.add(2, "easy", plan("solver_failed", "friction cone", hints=("too weak",)), 0.1),
            "solver_failed: too weak",
        )
        self.assertEqual(
            tally.add(3, "easy", plan("iteration_limit", message="it passes, though"), 0.1),
            "iteration_limit: it passes, though",
        )
        silent = plan("solver_failed", "friction cone", message="no step is an improvement")
        self.assertEqual(tally.add(4, "steep", silent, 0.1), "solver_failed: too little friction")
        self.assertEqual((tally.diagnosed, tally.failures()), ([4], []))
        tally.add(5, "easy", silent, 0.1)
        self.assertEqual(tally.failures(), ["task 5 failed and does not say why"])

    def test_memory_may_not_grow(self) -> None:
        for growth, expected in ((1.04, []), (1.06, ["memory grew from 100.0 to 106.0 MB"])):
            tally = Tally(str)
            tally.memory = [2e8] * (SETTLED - 1) + [1e8] * 50 + [growth * 1e8] * 10
            self.assertEqual(tally.failures(), expected)

    def test_exceptions_are_failures(self) -> None:
        tally = Tally(str)
        tally.thrown.append("task 7: NumericalError: singular")
        self.assertEqual(tally.failures(), ["task 7: NumericalError: singular"])


if __name__ == "__main__":
    unittest.main()
