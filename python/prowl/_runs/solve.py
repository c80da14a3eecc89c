"""solve(), with a progress bar."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import Any

from .. import _prowl
from .._files import parse_task, read_task
from .bar import run_with_bar, solve_bar

AnyTask = _prowl.Task | str | os.PathLike[str] | Mapping[str, Any]


def as_task(task: AnyTask) -> _prowl.Task:
    """The task; read if it is a name or a path, parsed if it is a dict."""
    if isinstance(task, _prowl.Task):
        return task
    if isinstance(task, str | os.PathLike):
        return read_task(task)
    if isinstance(task, Mapping):
        return parse_task(task)
    kind = type(task).__name__
    raise _prowl.InputError(f"task: {kind} is not allowed; need a Task, the name of a shipped one, a path or a dict")


def solve(
    task: AnyTask,
    *,
    solver: str = "riccati",
    threads: int = 1,
    coarse_first: bool = True,
    refine: str | None = None,
    start_from: _prowl.Plan | None = None,
    gains: bool = True,
    progress: bool | None = None,
    on_iteration: Callable[[_prowl.Progress], object] | None = None,
    on_iterate: Callable[[_prowl.Iterate], object] | None = None,
) -> _prowl.Plan:
    """Plans the motion of a task and checks it.

    task: a Task, the name of a shipped one ("hyq/crouch"), the path of a task file, or a dict for
    parse_task(). solver: one of solver_names(). threads: for evaluations; the result does not depend on it.
    coarse_first: solve on coarser meshes first. refine: grade
    that the mesh is refined to, "draft" or "certified"; None: "draft" if the task has no intervals. start_from: an earlier plan with the same robot and phases.
    gains: also design feedback gains if the plan is good. progress: show iterations with tqdm; None: in a
    terminal or notebook with tqdm. on_iteration: called with a Progress after each iteration; its exceptions
    end the solve and are raised here. on_iterate: the same with an Iterate, which also contains the motion;
    this costs time at each iteration.

    A hard problem raises no exception: check plan.good, plan.status and plan.hints. Ctrl-C raises
    Interrupted, a KeyboardInterrupt, within an iteration; its `plan` is the best motion so far. Other threads
    run meanwhile.
    """
    asked = as_task(task)

    def run(tell: Callable[[_prowl.Progress], object] | None) -> _prowl.Plan:
        return _prowl.solve(
            asked,
            solver=solver,
            threads=threads,
            coarse_first=coarse_first,
            refine=refine,
            start_from=start_from,
            gains=gains,
            on_iteration=tell,
            on_iterate=on_iterate,
        )

    return run_with_bar(progress, solve_bar(asked.name), run, on_iteration)
