"""diagnose(), for all kinds of tasks of solve()."""

from __future__ import annotations

from collections.abc import Callable

from .. import _prowl
from .solve import AnyTask, as_task


def diagnose(
    task: AnyTask, *, max_time: float = 120.0, on_step: Callable[[str], object] | None = None
) -> _prowl.Diagnosis:
    """Finds out why a task has no plan: which limit, phase, time, foot or joint, by how much, and the
    smallest changes of one number that make it solvable.

    task: see solve(). max_time: total time limit [s]. on_step: called with a line about each step; its
    exceptions, and Ctrl-C, end the diagnosis and are raised here.
    """
    return _prowl.diagnose(as_task(task), max_time=max_time, on_step=on_step)
