"""Python examples of README and docs/, page by page, and what they may take as given."""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "site"))
from page_blocks import Block, blocks, pages  # noqa: E402

#: Names that the text around an example introduces.
GIVEN = """
import tomllib

import numpy as np

import prowl
import prowl.snopt

task = prowl.read_task("hyq/crouch")
robot = task.robot
plan = prowl.solve(task)
simulation = prowl.simulate(plan)
q, v, a, tau = plan.q, plan.v, plan.a, plan.tau
z = prowl.Program(prowl.read_task("hyq/crouch", intervals=6)).start
"""


def examples() -> dict[Path, list[Block]]:
    """The examples of each page that has some."""
    found = {page: [block for block in blocks(page) if block.language == "python"] for page in pages()}
    return {page: examples for page, examples in found.items() if examples}
