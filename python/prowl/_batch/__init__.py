"""batch() and libraries of motions, on Dask and Parquet (docs/batch.md)."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from .._extras import needs
from .run import BatchProgress, batch

if TYPE_CHECKING:
    from .library import Library

__all__ = ["BatchProgress", "batch", "read_library"]


def read_library(folder: str | os.PathLike[str]) -> Library:
    """Opens a library of motions that batch() made, also one that is not complete. Raises InputError for another
    folder."""
    with needs("batch"):
        from .library import Library
    return Library(folder)
