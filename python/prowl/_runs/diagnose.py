"""diagnose(), of whatever solve() takes."""

from __future__ import annotations

from collections.abc import Callable

from .. import _prowl
from .solve import AnyTask, as_task


def diagnose(
    task: AnyTask, *, max_time: float = 120.0, on_step: Callable[[str], object] | None = None
) -> _prowl.Diagnosis:
    """Finds out why a task has no plan: which limit, in which phase, at what time, on which foot or joint, by how much, and
    the smallest changes of one number that make it solvable.

    task: as for solve(). max_time: of all of it [s]. on_step: called with a line on what is being tried; what it raises, or
    Ctrl-C, ends the diagnosis and is raised here.
    """
    return _prowl.diagnose(as_task(task), max_time=max_time, on_step=on_step)
