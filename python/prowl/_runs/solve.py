"""solve(), with a display of progress."""

from __future__ import annotations

import sys
from collections.abc import Callable

from . import _prowl


class _Bar:
    """Iterations as they come, by tqdm: in a terminal or in a notebook. How many there will be nobody knows."""

    def __init__(self, name: str) -> None:
        from tqdm.auto import tqdm

        self._name = name
        self._bar = tqdm(desc=name, unit=" iterations", leave=True, mininterval=0.1)

    def __call__(self, progress: _prowl.Progress) -> None:
        self._bar.set_description(f"{self._name}, {progress.intervals} intervals", refresh=False)
        self._bar.set_postfix_str(
            f"cost {progress.cost:.4g}, violation {progress.constraint_violation:.1e}", refresh=False
        )
        self._bar.update()

    def close(self) -> None:
        self._bar.close()


def _can_show() -> bool:
    """Somebody is looking, and tqdm is there."""
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        return False
    try:
        import tqdm.auto  # noqa: F401
    except ImportError:
        return False
    return True


def solve(
    task: _prowl.Task,
    *,
    solver: str = "riccati",
    threads: int = 1,
    coarse_first: bool = True,
    start_from: _prowl.Plan | None = None,
    gains: bool = True,
    progress: bool | None = None,
    on_iteration: Callable[[_prowl.Progress], object] | None = None,
) -> _prowl.Plan:
    """Plans the motion of a task and checks it.

    solver: one of solver_names(). threads: that evaluate the problem; the result is the same. coarse_first: coarser
    meshes first. start_from: an earlier plan of the same robot and phases. gains: also design feedback gains, for a plan
    that is good. progress: show iterations with tqdm; None does so in a terminal and in a notebook if tqdm is installed.
    on_iteration: called with a Progress after each iteration; what it raises ends the solve and is raised here.

    A problem that is too hard is no exception: look at plan.good, plan.status and plan.hints. Ctrl-C raises Interrupted, a
    KeyboardInterrupt, within an iteration; its `plan` is the best motion so far. Other threads run meanwhile.
    """
    show = _can_show() if progress is None else progress
    if not show:
        return _prowl.solve(
            task,
            solver=solver,
            threads=threads,
            coarse_first=coarse_first,
            start_from=start_from,
            gains=gains,
            on_iteration=on_iteration,
        )
    try:
        bar = _Bar(task.name)
    except ImportError as error:
        raise _prowl.InputError("progress=True needs tqdm: pip install tqdm") from error

    def both(iteration: _prowl.Progress) -> None:
        bar(iteration)
        if on_iteration is not None:
            on_iteration(iteration)

    try:
        return _prowl.solve(
            task,
            solver=solver,
            threads=threads,
            coarse_first=coarse_first,
            start_from=start_from,
            gains=gains,
            on_iteration=both,
        )
    finally:
        bar.close()
