"""The coarsest mesh of a solver whose motion is as exact as it has to be."""

from collections.abc import Callable, Sequence


def coarsest_step(steps: Sequence[float], order: int, ratio: Callable[[float], float]) -> float | None:
    """Longest of these steps with ratio(step) <= 1: the error of the motion on that mesh over the error allowed. None: none of them.

    `steps` fall. An error of this order in the step tells how much shorter steps have to be; those in between are left out.
    If one that was left out may do, it is tried last. ratio() may be infinite, for a solve that failed.
    """
    tried: dict[int, float] = {}

    def is_exact(i: int) -> bool:
        tried.setdefault(i, ratio(steps[i]))
        return tried[i] <= 1.0

    i = 0
    while i < len(steps) and not is_exact(i):
        expected = steps[i] / tried[i] ** (1.0 / order) if tried[i] < float("inf") else steps[i]
        i += 1
        while i + 1 < len(steps) and steps[i + 1] >= expected:
            i += 1
    if i == len(steps):
        return None
    while i > 0 and i - 1 not in tried and is_exact(i - 1):
        i -= 1
    return steps[i]
