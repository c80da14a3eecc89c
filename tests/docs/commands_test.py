"""Every command of README and docs/ is run, page by page, each page in a fresh copy of the repository; TOML files that pages show
are read by prowl. What is not run is printed with its reason.

    commands_test.py PROWL ROBOTS_DATA [PAGE ...]
"""

import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "site"))
from page_blocks import ROOT, Block, blocks, pages  # noqa: E402

STATUS = re.compile(r"^(?P<command>.*?)\s+# exit status (?P<status>\d+)\s*$")
NOT_COPIED = shutil.ignore_patterns(".git", "build*", ".venv*", "node_modules", "out", "artefacts", "__pycache__")
command = robots = None
wanted: list[str] = []


class Copy:
    """A copy of the repository as it is after scripts/setup, with this build."""

    def __init__(self, folder: pathlib.Path):
        self.root = folder / "prowl"
        shutil.copytree(ROOT, self.root, ignore=NOT_COPIED)
        for shared in (".venv", "report/node_modules", "site/node_modules"):
            if (ROOT / shared).exists():
                (self.root / shared).symlink_to((ROOT / shared).resolve())
        build = pathlib.Path(command).parents[1]
        (self.root / "build").symlink_to(build)
        # What the tests asked scripts/setup for is there already, and none of a reader's business.
        inherited = {name: value for name, value in os.environ.items() if not name.startswith("PROWL_WITH_")}
        self.environment = {**inherited, "PATH": f"{build / 'bin'}:{os.environ['PATH']}", "NO_COLOR": "1"}

    def run(self, script: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            ["bash", "-c", script],
            cwd=self.root,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=600,
        )

    def write(self, name: str, text: str) -> None:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def script(block: Block) -> str:
    lines = ["set -euo pipefail"]
    for line in block.text.splitlines():
        status = STATUS.match(line)
        if status:
            line = (
                f"code=0\n{{ {status['command']}\n}} || code=$?\n"
                f'[ $code -eq {status["status"]} ] || {{ echo "ended with $code"; exit 1; }}'
            )
        lines.append(line)
    return "\n".join(lines)


def read_toml(copy: Copy, block: Block) -> str | None:
    """Has prowl read a robot or task file; what is wrong with it, or None."""
    content = tomllib.loads(block.text)
    kind = "robot" if "urdf" in content else "plan" if "robot" in content else None
    if kind is None:
        return "neither a robot nor a task file; mark it <!-- fragment --> if it is a part of one"
    name = block.title or ("robots" if kind == "robot" else "tasks/hyq") + f"/shown_at_line_{block.line}.toml"
    copy.write(name, block.text)
    result = copy.run(f"prowl {kind} {name} {'--print-phases' if kind == 'plan' else ''}")
    return None if result.returncode == 0 else result.stdout


def check(page: pathlib.Path) -> tuple[list[str], list[str], int, float]:
    """Faults, what is not run, how much was run, and seconds of one page."""
    faults, left_out, ran, start = [], [], 0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        copy = Copy(pathlib.Path(folder))
        for block in blocks(page):
            reason = block.remarked("not run")
            if block.language == "sh" and reason is not None:
                left_out.append(
                    f"{block.place}: {' ; '.join(block.text.strip().splitlines())}\n      {reason or 'NO REASON GIVEN'}"
                )
                if not reason:
                    faults.append(f"{block.place}: not run, but no reason is given")
            elif block.language == "sh":
                result = copy.run(script(block))
                ran += 1
                if result.returncode != 0:
                    faults.append(
                        f"{block.place}: exit status {result.returncode} from\n{block.text}{result.stdout[-4000:]}"
                    )
            elif block.language == "toml" and block.remarked("fragment") is None:
                fault = read_toml(copy, block)
                ran += 1
                if fault:
                    faults.append(f"{block.place}: {fault}")
            elif block.title:
                copy.write(block.title, block.text)
    return faults, left_out, ran, time.monotonic() - start


class Commands(unittest.TestCase):
    def test_every_command_works(self):
        chosen = [page for page in pages() if not wanted or page.stem in wanted]
        with concurrent.futures.ThreadPoolExecutor(2) as workers:
            results = dict(zip(chosen, workers.map(check, chosen)))
        for page, (faults, _, ran, seconds) in results.items():
            if ran:
                print(f"{page.relative_to(ROOT)}: {ran} blocks, {seconds:.1f} s" + (", FAULTS" if faults else ""))
        print("\nnot run, and why:")
        for _, left_out, _, _ in results.values():
            for entry in left_out:
                print("  " + entry)
        faults = [fault for found, *_ in results.values() for fault in found]
        self.assertFalse(faults, "\n\n".join(["", *faults]))
        self.assertGreater(sum(ran for _, _, ran, _ in results.values()), 0 if wanted else 20)


if __name__ == "__main__":
    command, robots, *wanted = sys.argv[1:]
    unittest.main(argv=sys.argv[:1])
