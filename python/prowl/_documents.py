"""Dicts as text of a robot or task file."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

from . import _prowl

Document = str | Mapping[str, Any]  #: text of a file, or a dict with its keys


def toml_text(document: Document) -> str:
    """Text of a file with this content. NumPy arrays and numbers become lists and numbers, paths strings."""
    if isinstance(document, str):
        return document
    import tomli_w  # not needed by figures() and export()

    try:
        return tomli_w.dumps(_plain(document))
    except (TypeError, AttributeError) as error:  # None, or keys that are not strings
        raise _prowl.InputError(f"document: {error}; need a dict with TOML types") from error


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):  # NumPy array or number
        return _plain(value.tolist())
    return value
