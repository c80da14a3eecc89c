"""The page of `prowl library`: outcomes, drawn values and margins."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .._show.page import page_template

if TYPE_CHECKING:
    from .library import Library

_BINS = 20
_FAR = 1e-3  #: of a limit: rounding, and nothing to look at
_FIRST = 8  #: indices that are listed of each outcome


def _histogram(name: str, unit: str, series: Mapping[str, np.ndarray]) -> dict[str, Any]:
    """Over common edges; a value that is the same in all motions has one bin."""
    values = np.concatenate(list(series.values()))
    largest = float(np.abs(values).max())
    if np.ptp(values) > 1e-9 * largest:
        edges = np.histogram_bin_edges(values, bins=_BINS)
    else:
        edges = values.mean() + max(0.01 * largest, 1e-12) * np.array([-1.0, 1.0])
    counts = {key: np.histogram(values, bins=edges)[0].tolist() for key, values in series.items()}
    return {"name": name, "unit": unit, "edges": edges.tolist(), "counts": counts}


def _margins(library: Library) -> tuple[list[dict[str, Any]], list[str]]:
    """Worst values of the checks of all motions that are kept, over their limits, or in their unit if they are
    distances from a limit, negative while it is kept; and the names of checks that are far from theirs."""
    worst: dict[tuple[str, str], list[tuple[float, float]]] = {}
    for checks in library.kept_rows["checks"].to_pylist():
        for check in checks:
            if np.isfinite(check["worst"]) and check["limit"] > 0:
                worst.setdefault((check["name"], check["unit"]), []).append((check["worst"], check["limit"]))
    shown, far = [], []
    for (name, unit), pairs in worst.items():
        values, limits = np.array(pairs).T
        if (values < 0).any():
            shown.append(_histogram(name, unit, {"kept": values}))
        elif (values / limits).max() < _FAR:
            far.append(name)
        else:
            shown.append(_histogram(name, "of the limit", {"kept": values / limits}))
    return shown, list(dict.fromkeys(far))  # a name may have two units


def _draws(library: Library) -> list[dict[str, Any]]:
    index = library.index
    kept = np.array(index["kept"].to_pylist(), dtype=bool)
    drawn = []
    for name in library.job.draw_names:
        values = index[name].to_pylist()
        if all(isinstance(value, float) for value in values):
            array = np.array(values)
            drawn.append(_histogram(name, "", {"kept": array[kept], "failed": array[~kept]}))
    return drawn


def _outcomes(library: Library) -> list[dict[str, Any]]:
    index = library.index
    found: dict[tuple[bool, str], list[tuple[int, str]]] = {}
    columns = (index[name].to_pylist() for name in ("kept", "grade", "cause", "index", "diagnosis"))
    for kept, grade, cause, number, diagnosis in zip(*columns):
        found.setdefault((kept, grade if kept else cause), []).append((number, diagnosis or ""))
    order = sorted(found.items(), key=lambda item: (not item[0][0], -len(item[1])))
    return [
        {
            "name": name,
            "kept": kept,
            "count": len(motions),
            "motions": [number for number, _ in motions[:_FIRST]],
            "diagnosis": motions[0][1].partition("\n")[0],
        }
        for (kept, name), motions in order
    ]


def library_page(library: Library) -> str:
    """One file that needs no other."""
    task = library.base_task()
    margins, far = _margins(library)
    data = {
        "name": task.name,
        "robot": task.robot.name,
        "asked": library.count,
        "done": library.done,
        "kept": library.kept,
        "outcomes": _outcomes(library),
        "margins": margins,
        "far": far,
        "draws": _draws(library),
    }
    text = json.dumps(data, allow_nan=False).replace("<", "\\u003c")
    return page_template("library.html").replace("PROWL_REPORT_DATA", text)
