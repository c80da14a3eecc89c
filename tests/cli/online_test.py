"""prowl mpc as a user's program calls it: JSON, interrupts, and what it refuses.

Usage: online_test.py PROWL
"""

import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROWL = sys.argv[1]


def mpc(*options: object) -> subprocess.CompletedProcess:
    return subprocess.run([PROWL, "mpc", "hyq", *map(str, options)], capture_output=True, text=True, check=False)


class Online(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_a_run(self):
        run = json.loads(mpc("--duration", 1.5, "--budget", 0, "--json").stdout)
        self.assertEqual((run["success"], run["end"], run["gaits"]), (True, "finished", ["trot"]))
        self.assertEqual((run["plans"], run["late_plans"], run["dropped_plans"]), (150, 150, 0))
        self.assertLess(run["last_velocity_error_mps"], 0.1)

    def test_gaits_are_those_of_its_script(self):
        script = self.folder / "s.toml"
        script.write_text('[[command]]\ntime_s = 0.2\ngait = "walk"\n[[command]]\ntime_s = 9.0\ngait = "pace"\n')
        run = json.loads(mpc("--duration", 0.4, "--script", script, "--json").stdout)
        self.assertEqual(run["gaits"], ["trot", "walk"])
        self.assertEqual(run["notes"], ["command at 9 s is after the end of the run"])

    def test_a_robot_that_stands_follows_no_velocity(self):
        run = json.loads(mpc("--gait", "stand", "--command", 0.3, 0, 0, "--duration", 3, "--json").stdout)
        self.assertTrue(run["success"], run["failures"])
        self.assertIn("out of range; followed: 0 m/s ahead", run["notes"][0])

    def test_runs_of_the_benchmark(self):
        file = self.folder / "runs.json"
        answer = json.loads(mpc("--benchmark", file, "--rows", "one_kick_0.5", "--runs", 1, "--json").stdout)
        self.assertEqual((answer["verb"], answer["exit_status"]), ("mpc", 0))
        self.assertEqual(answer["runs"], json.loads(file.read_text()))
        self.assertEqual([run["row"] for run in answer["runs"]], ["one_kick_0.5"])

    def interrupt(self, *options: object) -> tuple[str, str, int]:
        """Ctrl-C four seconds after the start, when it runs for certain."""
        command = [PROWL, "mpc", "hyq", *map(str, options)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
            time.sleep(4.0)
            run.send_signal(signal.SIGINT)
            out, error = run.communicate()
        return out, error, run.returncode

    def test_an_interrupted_run_tells_what_it_saw(self):
        page = self.folder / "run.html"
        out, _, status = self.interrupt("--duration", 1000, "--page", page, "--json")
        run = json.loads(out)
        self.assertEqual((status, run["exit_status"], run["end"]), (130, 130, "stopped"))
        self.assertLess(run["end_time_s"], 1000)
        self.assertIsNone(run["last_velocity_error_mps"])
        self.assertGreater(page.stat().st_size, 0)

    def test_an_interrupted_benchmark_tells_how_far_it_came(self):
        file = self.folder / "runs.json"
        _, error, status = self.interrupt("--benchmark", file, "--rows", "hour")
        self.assertEqual(status, 130)
        self.assertIn("interrupted: 0 of 1 runs of hour done", error)
        self.assertFalse(file.exists())

    def test_what_it_refuses(self):
        times = self.folder / "times.csv"
        times.write_text("plan_s\n0.001\n-0.001\n")
        for options, message in (
            (
                ("--late", "drop", "--replay-times", times),
                f"{times}:3: plan_s: -0.001 is not allowed; need a time >= 0 s",
            ),
            (("--view", "--port", 70000), "--port: 70000 is not allowed; need a whole number from 0 to 65535"),
            (
                ("--benchmark", "runs.json", "--runs", 0),
                "--runs: 0 is not allowed; need a whole number from 1 to 1000000",
            ),
        ):
            with self.subTest(options=options):
                answer = mpc(*options)
                self.assertEqual(answer.returncode, 2)
                self.assertIn(message, answer.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
