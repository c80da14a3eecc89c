"""Types, by mypy: of the notebooks, of the examples of the documentation, and of the package's answers."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import prowl
from documentation import GIVEN, ROOT, examples

pytest.importorskip("mypy", reason="PROWL_WITH_TYPES=1 scripts/setup installs it")

#: What a user may rely on; assert_type() is exact.
ANSWERS = """
from pathlib import Path
from typing import assert_type

import numpy as np
from matplotlib.figure import Figure

import prowl

plan = prowl.solve("hyq/crouch")
assert_type(plan, prowl.Plan)
assert_type(prowl.solve(Path("task.toml"), on_iterate=lambda at: at.motion.q.sum() + at.cost), prowl.Plan)
assert_type(prowl.solve({"robot": prowl.read_robot("hyq"), "goal": [{"base_displacement_m": np.zeros(3)}]}), prowl.Plan)
assert_type(plan.good, bool)
assert_type(plan.cost_terms, dict[str, float])
assert_type(plan.certificate, prowl.Certificate)
assert_type(plan.certificate.checks[0].worst, float)
assert_type(plan.tracker, prowl.Tracker | None)
assert_type(plan.path, Path | None)
assert_type(plan.robot.path, Path)
assert_type(plan.plot(), Figure)
plan.show(prowl.simulate(plan), height=600)
assert_type(prowl.report(plan, "report.html").size, int)
assert_type(prowl.figures(plan, out="figures").names, list[str])
assert_type(prowl.export(plan, "npz", out="exports").files, dict[str, int])
assert_type(prowl.sweep(plan, 8).success_rate, float)
assert_type(prowl.retarget("motion.csv", "go2", slowest=1.5).deviations, tuple[prowl.Deviation, ...])
height: float = plan.q[:, 2].max()
try:
    prowl.read_task("none")
except prowl.InputError as error:
    print(error)
"""

#: An example asks for what it reads, so that nothing is None; it does not spend a line on that.
ON_A_PAGE = '# mypy: disable-error-code="union-attr"\n'

MISTAKES = """
import prowl

prowl.solve(3)
prowl.solve("hyq/crouch", solvr="ipopt")
prowl.read_task("hyq/crouch").goal
prowl.solve("hyq/crouch").show(height="high")
prowl.sweep("out/crouch", n="many")
"""


def mypy(folder: Path, **files: str) -> subprocess.CompletedProcess:
    """Checks these files with the package as it is installed."""
    for name, text in files.items():
        (folder / f"{name}.py").write_text(text, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--config-file", ROOT / "python/mypy.ini", "--no-error-summary"]
    paths = [folder / f"{name}.py" for name in files]
    environment = {**os.environ, "MYPYPATH": str(Path(prowl.__file__).parents[1]), "PYTHONPATH": ""}
    return subprocess.run([*command, *paths], cwd=folder, env=environment, capture_output=True, text=True)


def test_notebooks_examples_and_answers_have_the_types_that_they_say(tmp_path):
    notebooks = {path.stem: path.read_text() for path in (ROOT / "python/notebooks").glob("*.py")}
    pages = {
        f"page_{page.stem.replace('-', '_')}": ON_A_PAGE + GIVEN + "\n".join(block.text for block in blocks)
        for page, blocks in examples().items()
    }
    assert len(notebooks) == 4 and len(pages) >= 2
    result = mypy(tmp_path, answers=ANSWERS, **notebooks, **pages)
    assert result.returncode == 0, result.stdout + result.stderr


def test_mistakes_are_found_before_they_run(tmp_path):
    result = mypy(tmp_path, mistakes=MISTAKES)
    assert result.returncode == 1, result.stdout + result.stderr
    lines = {int(line.split(":")[1]) for line in result.stdout.splitlines() if ": error: " in line}
    assert lines == {4, 5, 6, 7, 8}, result.stdout
