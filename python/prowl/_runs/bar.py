"""Progress bars by tqdm, in a terminal or a notebook."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from typing import Any

from .. import _prowl


def can_show() -> bool:
    """True in a terminal or a notebook with tqdm."""
    if not (sys.stderr.isatty() or "ipykernel" in sys.modules):
        return False
    return _tqdm() is not None


def _tqdm() -> Any:
    """The bar class for a terminal or a notebook; None without tqdm."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # no warning that a notebook without ipywidgets gets a text bar
            from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm


def _bar(**options: Any) -> Any:
    tqdm = _tqdm()
    if tqdm is None:
        raise _prowl.InputError("progress=True needs tqdm: pip install tqdm")
    return tqdm(leave=True, mininterval=0.1, **options)


@contextmanager
def solve_bar(name: str) -> Iterator[Callable[[_prowl.Progress], None]]:
    """Bar of iterations, whose total is unknown."""
    bar = _bar(desc=name, unit=" iterations")

    def show(progress: _prowl.Progress) -> None:
        bar.set_description(f"{name}, {progress.intervals} intervals", refresh=False)
        bar.set_postfix_str(f"cost {progress.cost:.4g}, violation {progress.constraint_violation:.1e}", refresh=False)
        bar.update()

    try:
        yield show
    finally:
        bar.close()


@contextmanager
def sweep_bar() -> Iterator[Callable[[int, int], None]]:
    """Bar of finished simulations, with the remaining time."""
    bar = _bar(desc="simulations", unit=" simulations")

    def show(done: int, total: int) -> None:
        if bar.total is not None and done < bar.n:  # the next round
            bar.reset()
        bar.total = total
        bar.update(done - bar.n)

    try:
        yield show
    finally:
        bar.close()


@contextmanager
def batch_bar() -> Iterator[Callable[[Any], None]]:
    """Bar of motions that are done, with rate, share kept, failures by cause and the remaining time."""
    bar = _bar(desc="motions", unit=" motions")

    def show(progress: Any) -> None:
        bar.total = progress.total
        if bar.n == 0:
            bar.initial = progress.done - progress.done_here
        share = 100.0 * progress.kept / progress.done if progress.done else 100.0
        causes = "".join(f", {count} {cause}" for cause, count in progress.causes.items())
        bar.set_postfix_str(f"{share:.3g} % kept{causes}", refresh=False)
        bar.update(progress.done - bar.n)

    try:
        yield show
    finally:
        bar.close()


def run_with_bar(
    progress: bool | None,
    bar: AbstractContextManager[Callable[..., None]],
    run: Callable[[Callable[..., object] | None], Any],
    tell: Callable[..., object] | None,
) -> Any:
    """Returns run(callback). The callback calls `tell`, and shows the bar if `progress` is true, or None and
    can_show()."""
    if not (can_show() if progress is None else progress):
        return run(tell)
    with bar as show:

        def both(*news: Any) -> None:
            show(*news)
            if tell is not None:
                tell(*news)

        return run(both)
