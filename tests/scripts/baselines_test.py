"""The other controllers of the benchmark of online control keep HyQ on its feet while nothing pushes it.

baselines_test.py: with the peers' environment (PROWL_WITH_PEERS=1 scripts/setup) theirs, too.
"""

import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / folder) for folder in ("build/python", "bench", "bench/online")]
import baselines  # noqa: E402
import prowl  # noqa: E402

SEED, DURATION = 7, 3.0  # [s]


class Baselines(unittest.TestCase):
    def setUp(self):
        self.robot = prowl.read_robot(baselines.ROBOT)

    def check(self, baseline):
        run = baselines.run(self.robot, baseline, 0.0, SEED, DURATION)
        self.assertTrue(run["success"], run["failures"])
        self.assertLess(run["velocity_error_mps"], 0.1)
        return run

    def test_a_fixed_plan_with_its_gains(self):
        self.check(baselines.BASELINES[0])

    @unittest.skipUnless(baselines.ENVIRONMENT.exists(), "without the peers")
    def test_peers(self):
        for baseline in baselines.BASELINES[1::2]:
            with self.subTest(baseline.name):
                self.assertGreater(self.check(baseline)["plan_ms"][0], 0.1)

    def test_the_table_counts_runs(self):
        name = baselines.BASELINES[0].name
        runs = [
            {"controller": name, "kick_mps": kick, "seed": seed, "success": seed > 1, "plan_ms": [2.0, 4.0]}
            for kick in baselines.KICKS
            for seed in (1, 2, 3)
        ]
        row = baselines.table(runs, [1, 2]).splitlines()[2]
        self.assertEqual(row.count("1 of 2"), len(baselines.KICKS))
        self.assertTrue(row.endswith("| 2.0 | 4.0 |"), row)


if __name__ == "__main__":
    unittest.main()
