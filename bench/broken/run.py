#!/usr/bin/env python3
"""How often `prowl diagnose` names the true cause of a task that was broken on purpose (bench/broken/tasks.toml).

Prints a table in Markdown and the count. Takes about a minute a task.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
from broken_tasks import ROOT, is_named, make, read_list  # noqa: E402  (leaves no cache beside the scripts)


def words_of(diagnosis: dict) -> str:
    if "error" in diagnosis:
        return "refused: " + diagnosis["error"]["message"]
    return diagnosis["headline"]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="*", help="of tasks.toml; without, all")
    parser.add_argument("--prowl", type=Path, default=ROOT / "build/bin/prowl")
    parser.add_argument("--max-time", default="120", help="of each diagnosis [s]; default 120")
    parser.add_argument("--least", type=int, default=0, help="fewer true causes than this end with status 1")
    parser.add_argument("--only-make", action="store_true", help="write the tasks, diagnose none")
    parser.add_argument(
        "--keep", type=Path, help="folder for the broken tasks and the diagnoses; default: a temporary one"
    )
    arguments = parser.parse_args()
    chosen = [broken for broken in read_list() if not arguments.name or broken["name"] in arguments.name]
    if len(chosen) < len(arguments.name):
        parser.error("not all of these are in tasks.toml")
    if not arguments.only_make:
        print("| task | made from | time [s] | true cause named | what is said |\n|---|---|---|---|---|", flush=True)
    right = 0
    for broken in chosen:
        with tempfile.TemporaryDirectory() as temporary:
            folder = arguments.keep / broken["name"] if arguments.keep else Path(temporary)
            folder.mkdir(parents=True, exist_ok=True)
            task = make(broken, arguments.prowl, folder)
            if arguments.only_make:
                continue
            start = time.monotonic()
            run = subprocess.run(
                [arguments.prowl, "diagnose", task, "--json", "--quiet", "--max-time", arguments.max_time],
                capture_output=True,
                text=True,
            )
            seconds = time.monotonic() - start
            (folder / "diagnosis.json").write_text(run.stdout)
            diagnosis = json.loads(run.stdout)
        named = is_named(broken, diagnosis)
        right += named
        words = words_of(diagnosis).replace("|", "/").replace("\n", " ").replace(str(folder) + "/", "")
        print(
            f"| {broken['name']} | {broken['task']} | {seconds:.0f} | {'yes' if named else 'no'} | {words} |",
            flush=True,
        )
    if arguments.only_make:
        print(f"{len(chosen)} made")
        return 0
    print(f"\n{right} of {len(chosen)}")
    return 0 if right >= arguments.least else 1


if __name__ == "__main__":
    sys.exit(main())
