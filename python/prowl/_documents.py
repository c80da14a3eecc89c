"""Dicts as the text of a robot or task file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from . import _prowl

Document = str | Mapping[str, Any]  #: the text of a file, or a dict of the same keys


def toml_text(document: Document) -> str:
    """The text of a file with this content. NumPy's arrays and numbers become lists and numbers, paths their text."""
    if isinstance(document, str):
        return document
    import tomli_w  # figures() and export() do without

    try:
        return tomli_w.dumps(_plain(document))
    except (TypeError, AttributeError) as error:  # of None, keys that are no strings
        raise _prowl.InputError(f"document: {error}; need a dict of what a TOML file can hold") from error


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # an array or a number of NumPy
        return _plain(value.tolist())
    return value
