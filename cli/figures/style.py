"""How the figures look: one palette that the colour-blind can tell apart, light grids, phases behind the lines."""
import pathlib

import matplotlib
import matplotlib.pyplot as plt
import numpy as np

# Okabe and Ito, "Color universal design", 2008.
BLUE, VERMILLION, GREEN, SKY, ORANGE, PURPLE = "#0072B2", "#D55E00", "#009E73", "#56B4E9", "#E69F00", "#CC79A7"
AXIS_COLOURS = (VERMILLION, GREEN, BLUE)
LEG_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, "0.2", "0.6")
DASHES = ("-", (0, (5, 1.5)), (0, (1.2, 1.2)), (0, (5, 1.5, 1.2, 1.5)), (0, (8, 2)), (0, (3, 1, 1, 1, 1, 1)), (0, (1, 3)))
LABELLED_PHASES = 6  # names of more do not fit


def use() -> None:
    matplotlib.use("Agg")
    plt.rcParams.update({
        "font.size": 8.5, "axes.titlesize": 8.5, "axes.labelsize": 8.5, "legend.fontsize": 8.5, "figure.titlesize": 12,
        "axes.grid": True, "grid.color": "0.88", "grid.linewidth": 0.5, "axes.axisbelow": True, "axes.edgecolor": "0.4",
        "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.1, "legend.frameon": False,
        "axes.formatter.useoffset": False, "figure.dpi": 100, "savefig.dpi": 160, "svg.hashsalt": "prowl",  # same input, same file
    })


def grid(rows: int, columns: int, width: float, height: float, **sharing):
    figure, axes = plt.subplots(rows, columns, figsize=(width, height), squeeze=False, sharex=True, **sharing)
    return figure, axes


def at_least(axes, half: float) -> None:
    """No axis shows less than ± half: rounding is not to look like a motion."""
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, -half), max(high, half))


def mark_phases(figure_axes, phases, end: float) -> None:
    """A line at each switch of contacts and at the end of the plan; names above the first row if they fit."""
    for axes in figure_axes.flat:
        axes.set_xlim(phases[0][1], end)
        for k, (_, start, stop) in enumerate(phases):
            if k % 2:
                axes.axvspan(start, stop, color="0.955", lw=0, zorder=0)
        if end > phases[-1][2] * (1 + 1e-9):
            axes.axvline(phases[-1][2], color="0.55", lw=0.8, ls=(0, (2, 2)), zorder=1)
    if len(phases) > LABELLED_PHASES:
        return
    first = figure_axes.flat[0]
    blended = first.get_xaxis_transform()
    for name, start, stop in phases if len(phases) > 1 else []:
        first.text((start + stop) / 2, 0.99, name, transform=blended, ha="center", va="top", fontsize=6.5, color="0.45")
    if end > phases[-1][2] * (1 + 1e-9):
        first.text(phases[-1][2], 0.02, " plan ends", transform=blended, ha="left", va="bottom", fontsize=6.5, color="0.45")


def finish(figure, title: str, subtitle: str, handles, folder: pathlib.Path, name: str, bottom: float = 0.0) -> None:
    """Title, legend of the whole figure, and both files. Sizes in inches, so that tall figures look as flat ones do;
    `bottom` is left free."""
    height = figure.get_figheight()
    figure.suptitle(title, x=0.012, y=1 - 0.08 / height, ha="left", va="top", fontweight="bold")
    figure.text(0.012, 1 - 0.33 / height, subtitle, ha="left", va="top", color="0.35")
    lines = 0.15 * subtitle.count("\n")
    top = 0.58 + lines
    if handles:
        labels = [handle.get_label() for handle in handles]
        figure.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.006, 1 - (0.5 + lines) / height), ncols=len(labels),
                      borderaxespad=0.2, columnspacing=1.6, handlelength=2.6)
        top = 0.84 + lines
    figure.tight_layout(rect=(0, bottom / height, 1, 1 - top / height))
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None, "Title": title})
    figure.savefig(folder / f"{name}.png", metadata={"Title": title})
    plt.close(figure)


def largest(values: np.ndarray) -> float:
    """Of the finite ones, in size; 0 if there are none."""
    return float(np.max(np.abs(values[np.isfinite(values)]), initial=0.0))
