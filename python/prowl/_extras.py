"""Packages that only some functions need: the extras of the wheel."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from . import _prowl


@contextmanager
def needs(extra: str) -> Iterator[None]:
    """For imports of packages of an extra. Raises InputError with the remedy if one is missing."""
    try:
        yield
    except ModuleNotFoundError as error:
        raise _prowl.InputError(f'{error.name} is missing: pip install "prowl[{extra}]"') from error
