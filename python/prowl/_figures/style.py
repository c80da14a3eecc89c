"""Style of the figures: a palette safe for colour blindness, light grids, phases behind the lines."""

from __future__ import annotations

import io

import matplotlib
import numpy as np
from matplotlib.figure import Figure

# Okabe and Ito, "Color universal design", 2008.
BLUE, VERMILLION, GREEN, SKY, ORANGE, PURPLE = "#0072B2", "#D55E00", "#009E73", "#56B4E9", "#E69F00", "#CC79A7"
AXIS_COLOURS = (VERMILLION, GREEN, BLUE)
LEG_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, "0.2", "0.6")
DASHES = (
    "-",
    (0, (5, 1.5)),
    (0, (1.2, 1.2)),
    (0, (5, 1.5, 1.2, 1.5)),
    (0, (8, 2)),
    (0, (3, 1, 1, 1, 1, 1)),
    (0, (1, 3)),
)


def use() -> None:
    matplotlib.rcParams.update(
        {
            "font.size": 8.5,
            "axes.titlesize": 8.5,
            "axes.labelsize": 8.5,
            "legend.fontsize": 8.5,
            "axes.grid": True,
            "grid.color": "0.88",
            "grid.linewidth": 0.5,
            "axes.axisbelow": True,
            "axes.edgecolor": "0.4",
            "axes.spines.top": False,
            "axes.spines.right": False,
            "lines.linewidth": 1.1,
            "legend.frameon": False,
            "axes.formatter.useoffset": False,
            "figure.dpi": 100,
            "savefig.dpi": 160,
            "svg.hashsalt": "prowl",  # same input, same file
        }
    )


def grid(rows: int, columns: int, width: float, height: float, **sharing):
    figure = Figure(figsize=(width, height))
    return figure, figure.subplots(rows, columns, squeeze=False, **{"sharex": True, **sharing})


def at_least(axes, half: float) -> None:
    """Shows at least ± half, so that rounding does not look like a motion. Call it last: it ends
    autoscaling."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -half), max(high, half))


def mark_phases(grid, phases, end: float) -> None:
    """Shades every other phase, marks the end of the plan with a line, and writes names that fit above the
    first row."""
    start, stop = phases[0][1], phases[-1][2]
    rests = end > stop * (1 + 1e-9)
    for axes in grid.flat:
        axes.set_xlim(start, end)
        for _, first, last in phases[1::2]:
            axes.axvspan(first, last, color="0.95", lw=0, zorder=0)
        if rests:
            axes.axvline(stop, color="0.55", lw=0.8, ls=(0, (2, 2)), zorder=1)
    named = phases + [("stands on", stop, end)] if rests else phases
    if len(named) < 2:
        return
    for axes in grid[0]:
        axes.set_title(axes.get_title("left"), loc="left", pad=14)
        letters = axes.get_position().width * axes.figure.get_figwidth() * 72 / 3.7
        for name, first, last in named:
            if len(name) <= letters * (last - first) / (end - start):
                axes.text(
                    (first + last) / 2,
                    1.02,
                    name,
                    transform=axes.get_xaxis_transform(),
                    ha="center",
                    va="bottom",
                    fontsize=6.5,
                    color="0.35",
                )


def finish(
    figure, title: str, subtitle: str, handles, name: str, table: str | None = None, bottom: float = 0.0
) -> dict[str, bytes]:
    """Adds title and legend; returns the files by name: pictures, and the table if given. Sizes in inches, so
    tall and flat figures look alike; `bottom` [in] stays free."""
    height = figure.get_figheight()
    figure.text(0.012, 1 - 0.08 / height, title, ha="left", va="top", fontweight="bold", fontsize=12)
    figure.text(0.012, 1 - 0.33 / height, subtitle, ha="left", va="top", color="0.35")
    lines = 0.15 * subtitle.count("\n")
    top = 0.58 + lines
    if handles:
        labels = [handle.get_label() for handle in handles]
        figure.legend(
            handles,
            labels,
            loc="upper left",
            bbox_to_anchor=(0.006, 1 - (0.5 + lines) / height),
            ncols=len(labels),
            borderaxespad=0.2,
            columnspacing=1.6,
            handlelength=2.6,
        )
        top = 0.84 + lines
    figure.tight_layout(rect=(0, bottom / height, 1, 1 - top / height))
    files = {} if table is None else {f"{name}.csv": table.encode()}
    for kind, metadata in (("svg", {"Date": None}), ("png", {})):
        picture = io.BytesIO()
        figure.savefig(picture, format=kind, metadata={**metadata, "Title": title.replace("$", "")})
        files[f"{name}.{kind}"] = picture.getvalue()
    return files


def largest(values: np.ndarray) -> float:
    """Largest absolute finite value; 0 if there is none."""
    return float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))
