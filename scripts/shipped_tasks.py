"""What the benchmarks of the shipped tasks share: the list of tasks, and a run of `prowl plan`."""

import argparse
import csv
import json
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROWL = ROOT / "build/bin/prowl"
DATA = "package://example-robot-data/robots"
STATE = ("time_s", "base_p", "base_q", "base_v", "base_w", "q_", "v_")  # columns of trajectory.csv


def prowl(*arguments, folder: Path | None = None) -> dict:
    """What a command prints with --json; with "error" if it failed. Relative paths start at `folder`."""
    command = [PROWL, *map(str, arguments), "--json"]
    return json.loads(subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder).stdout)


def must(*arguments) -> dict:
    """The same; a command that fails ends the script."""
    printed = prowl(*arguments)
    if "error" in printed:
        raise SystemExit(f"prowl {' '.join(map(str, arguments))}: {printed['error']}")
    return printed


def plan(task: str, solver: str, *options: str) -> tuple[dict, list[list[float]]]:
    """plan.json, and the state at each node: time [s], configuration [m, rad, quaternion], velocity [m/s, rad/s]."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        run = subprocess.run(
            [
                PROWL,
                "plan",
                ROOT / "tasks" / f"{task}.toml",
                "--solver",
                solver,
                "--no-gains",
                "--out",
                out,
                *options,
            ],
            capture_output=True,
            text=True,
        )
        if not (out / "plan.json").exists():
            raise SystemExit(f"{task}: {run.stderr.strip()}")
        with (out / "trajectory.csv").open() as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
        state = [i for i, name in enumerate(rows[0]) if name.startswith(STATE)]
        return json.loads((out / "plan.json").read_text()), [[float(row[i]) for i in state] for row in rows[1:]]


def read_arguments(parser: argparse.ArgumentParser, more: Iterable[str] = ()) -> argparse.Namespace:
    """With `task`: those named; or `more` and all but those of the paper, whose meshes are too coarse to certify."""
    parser.add_argument("task", nargs="*", help="e.g. hyq/step talos/squat; without, all of tasks/ but tasks/paper")
    arguments = parser.parse_args()
    if not arguments.task:
        arguments.task = sorted(
            str(path.relative_to(ROOT / "tasks").with_suffix(""))
            for path in ROOT.glob("tasks/*/*.toml")
            if path.parent.name != "paper"
        )
        arguments.task += more
    return arguments
