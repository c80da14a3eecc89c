#!/usr/bin/env python3
"""Writes the files and names of one commit, for compatibility_test.py to hold later ones against.

write_reference.py PROWL PYTHON DOCS FOLDER

PROWL: the command of that commit. PYTHON: has its package in PYTHONPATH. DOCS: its docs. FOLDER: has robot.toml, packages/ and
tasks/ already. All runs in NEUTRAL, whose name is in the files.
"""

import json
import pathlib
import shutil
import subprocess
import sys

import names
from cases import CASES, names_by_kind, run
from tracker_torques import tracker_torques

NEUTRAL = pathlib.Path("/tmp/prowl")
KEPT = [
    "plan tasks/crouch.toml --dt 0.05 --out out/crouch",
    "simulate out/crouch --record-rate 20",
    "sweep out/crouch --n 2 --breakdown 1",
    "plan tasks/crouch.toml --no-gains --intervals 12 --out out/coarse",
    "plan tasks/crouch.toml --intervals 40 --out out/rollout",
    "simulate out/rollout --engine rollout --record-rate 20",
    "plan tasks/crouch.toml --max-iterations 3 --checkpoint checkpoint --checkpoint-every 0 --out out/unfinished",
    "export out/crouch --format csv,json,npz,mcap,joint-trajectory,mujoco --rate 5 --out exports",
    "compare tasks/crouch.toml --solver riccati,ipopt --intervals 4 --out compare",
    "new robot package://quad/urdf/quad.urdf --package-dir packages --out new/quad.toml",
    "new task robot.toml --kind crouch --out new/crouch.toml",
]


def main() -> None:
    prowl, python, docs, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    shutil.rmtree(NEUTRAL, ignore_errors=True)
    NEUTRAL.mkdir()
    inputs = ("robot.toml", "packages", "tasks")
    for name in inputs:
        source = folder / name
        shutil.copytree(source, NEUTRAL / name) if source.is_dir() else shutil.copy(source, NEUTRAL / name)
    for command in KEPT:
        print(
            command, subprocess.run([prowl, *command.split(), "--quiet"], cwd=NEUTRAL, capture_output=True).returncode
        )
    for path in sorted(NEUTRAL.iterdir()):
        if path.name not in inputs:
            shutil.rmtree(folder / path.name, ignore_errors=True)
            shutil.copytree(path, folder / path.name)

    def help_of(*words: str) -> str:
        return subprocess.run([prowl, *words, "--help"], capture_output=True, text=True, check=True).stdout

    verbs = [verb for verb in names.verbs_of_help(help_of()) if verb != "new"]
    verbs += [f"new {verb}" for verb in names.verbs_of_help(help_of("new"))]
    outcomes = {case.name: run(case, prowl, python, NEUTRAL) for case in CASES}
    reference = {
        "options": {verb: sorted(names.of_help(help_of(*verb.split()))) for verb in ["", *verbs]},
        "keys": {
            kind: sorted(names.of_key_table((docs / f"{kind}-file.md").read_text())) for kind in ("task", "robot")
        },
        "names": names_by_kind(list(outcomes.values())),
        "facts": {name: outcome.facts for name, outcome in outcomes.items()},
        "tracker": tracker_torques(NEUTRAL / "out/crouch/tracker.bin"),
    }
    (folder / "reference.json").write_text(json.dumps(reference, indent=0) + "\n")


if __name__ == "__main__":
    main()
