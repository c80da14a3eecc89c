"""The coarsest mesh of Prowl whose error is no larger than a given one."""

from collections.abc import Callable

FINEST = 1280  # intervals


def coarsest_mesh(good: Callable[[int], bool], first: int) -> int | None:
    """Least N found with good(N): doubled from `first` until good, then halved in between; None if not even FINEST is.

    Errors fall with the mesh but for small bumps, which a bisection may step over: the mesh found is good, and one that is
    5 % coarser was not.
    """
    low, high = 0, first
    while not good(high):
        low, high = high, 2 * high
        if high > FINEST:
            return None
    while high - low > max(1, high // 20):
        middle = (low + high) // 2
        if middle < 1:
            break
        if good(middle):
            high = middle
        else:
            low = middle
    return high
