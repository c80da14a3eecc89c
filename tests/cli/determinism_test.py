"""The same input gives the same files, byte for byte but for times, on one and on two threads.

Usage: determinism_test.py PROWL PACKAGE_DIR
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROWL, PACKAGE_DIR = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]
TASKS = ("hyq/step", "solo12/crouch")
CLOCKS = {"seconds", "cpu_seconds", "evaluation"}  # keys of what a clock has measured


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(part) for key, part in value.items() if key not in CLOCKS}
    return [without_times(part) for part in value] if isinstance(value, list) else value


def plan(task: str, out: pathlib.Path, *options: str) -> dict[str, bytes]:
    """Files of the plan; those that a clock goes into without its words."""
    command = [
        PROWL,
        "plan",
        f"tasks/{task}.toml",
        "--out",
        str(out),
        "--package-dir",
        PACKAGE_DIR,
        *options,
    ]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=500)
    assert done.returncode in (0, 7), done.stderr
    files = {path.name: path.read_bytes() for path in sorted(out.iterdir())}
    # Numbers and order of keys come through JSON and back as they were.
    files["plan.json"] = json.dumps(without_times(json.loads(files["plan.json"]))).encode()
    return files


class Determinism(unittest.TestCase):
    def test_same_bytes(self) -> None:
        for task in TASKS:
            with self.subTest(task), tempfile.TemporaryDirectory() as work:
                folder = pathlib.Path(work)
                first = plan(task, folder / "first")
                for name, options in (("again", ()), ("two threads", ("--threads", "2"))):
                    other = plan(task, folder / name, *options)
                    self.assertEqual(first.keys(), other.keys())
                    for file in first:
                        self.assertEqual(first[file], other[file], f"{file}, {name}")
                # The comparison has something to compare: all figures are still there.
                self.assertIn(b'"certificate"', first["plan.json"])
                self.assertGreater(
                    len(json.loads((folder / "first/plan.json").read_text())["certificate"]["checks"]), 10
                )

    def test_another_task_has_other_bytes(self) -> None:
        with tempfile.TemporaryDirectory() as work:
            folder = pathlib.Path(work)
            first, other = (plan(TASKS[1], folder / name, "--intervals", name) for name in ("20", "22"))
            for file in ("plan.json", "trajectory.csv"):
                self.assertNotEqual(first[file], other[file])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
