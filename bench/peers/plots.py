"""Two figures: error against time, one panel a task; time per node and iteration over the number of nodes."""

import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (after the choice of backend)
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator  # noqa: E402

# Okabe and Ito's colours, which most colour-blind readers tell apart; Prowl's are filled, the peers' hollow.
COLOURS = {
    "fatrop": "#0072B2",
    "riccati": "#000000",
    "ipopt": "#56B4E9",
    "fddp": "#E69F00",
    "boxfddp": "#D55E00",
    "intro": "#009E73",
    "sqp": "#CC79A7",
    "csqp": "#8C6D1F",
}
MARKERS = {
    "fatrop": "o",
    "riccati": "D",
    "ipopt": "v",
    "fddp": "s",
    "boxfddp": "^",
    "intro": "P",
    "sqp": "X",
    "csqp": "*",
}
GREY = "0.5"


def style(record: dict) -> dict:
    solver, ours = record["solver"], record["label"].startswith("Prowl")
    colour = COLOURS.get(solver, GREY)
    return {
        "color": colour,
        "marker": MARKERS.get(solver, "o"),
        "markerfacecolor": colour if ours else "white",
        "markersize": 6,
        "linewidth": 1.6 if ours else 1.0,
        "label": record["label"],
    }


def good(records: list[dict], kinds: tuple[str, ...], task: str) -> list[dict]:
    return [r for r in records if r["kind"] in kinds and r["task"] == task and "failed" not in r and r["converged"]]


def draw_lines(axes, records: list[dict], x: str, y: str) -> None:
    for label in dict.fromkeys(r["label"] for r in records):
        best = {}  # of several on one mesh the one that was timed most often
        for record in records:
            if record["label"] == label and record["repetitions"] >= best.get(record["nodes"], record)["repetitions"]:
                best[record["nodes"]] = record
        line = sorted(best.values(), key=lambda r: r["nodes"])
        axes.plot([r[x] for r in line], [r[y] for r in line], **style(line[0]))


def logarithmic(axis) -> None:
    """Ticks at powers of ten as plain numbers."""
    axis.axes.set_xscale("log") if axis.axis_name == "x" else axis.axes.set_yscale("log")
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def widen(axes) -> None:
    """Limits a little beyond the data, and with a power of ten inside or at each end."""
    for low_high, set_limits in ((axes.get_xlim(), axes.set_xlim), (axes.get_ylim(), axes.set_ylim)):
        low, high = low_high
        if math.floor(math.log10(high)) - math.ceil(math.log10(low)) < 1:
            low, high = (
                min(low, 10.0 ** math.floor(math.log10(low)) * 0.9),
                max(high, 10.0 ** math.ceil(math.log10(high)) * 1.1),
            )
        set_limits(low, high)


def finish(figure, panels, path: pathlib.Path) -> None:
    handles = {}
    for axes in panels:
        axes.grid(which="major", color="0.88", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
        for handle, label in zip(*axes.get_legend_handles_labels()):
            handles.setdefault(label, handle)
    width, height = figure.get_size_inches()
    columns = max(1, min(len(handles), int(width / 1.9)))
    lines = -(-len(handles) // columns)
    figure.legend(handles.values(), handles.keys(), loc="upper center", ncols=columns, frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0, 1, 1 - (0.22 * lines + 0.1) / height))
    for kind in ("svg", "png"):
        figure.savefig(path.with_suffix(f".{kind}"), dpi=150)
    plt.close(figure)


def plot_error_against_time(records: list[dict], path: pathlib.Path) -> None:
    tasks = list(dict.fromkeys(r["task"] for r in records if r["kind"] == "task"))
    if not tasks:
        return
    columns = min(3, len(tasks))
    rows = -(-len(tasks) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4.0 * columns + 0.6, 3.4 * rows + 0.7), squeeze=False)
    for axes, task in zip(grid.flat, tasks):
        draw_lines(axes, good(records, ("task", "match", "search"), task), "seconds", "error_per_second")
        logarithmic(axes.xaxis)
        logarithmic(axes.yaxis)
        duration = next(
            (r["seconds"] / r["ratio_to_motion"] for r in records if r.get("task") == task and "failed" not in r), None
        )
        if duration:
            axes.axvline(duration, color=GREY, lw=0.8, ls="--")
            axes.annotate(
                "as long as the motion ",
                (duration, 1.0),
                xycoords=("data", "axes fraction"),
                rotation=90,
                fontsize=7,
                color=GREY,
                ha="right",
                va="top",
            )
        widen(axes)
        axes.set_title(task, fontsize=10)
        axes.set_xlabel("CPU time [s]")
        axes.set_ylabel("integration error in a second")
    for axes in grid.flat[len(tasks) :]:
        axes.set_visible(False)
    finish(figure, [axes for axes in grid.flat if axes.get_visible()], path)


def plot_growth(records: list[dict], path: pathlib.Path) -> None:
    tasks = list(dict.fromkeys(r["task"] for r in records if r["kind"] == "growth"))
    if not tasks:
        return
    quantities = [("us_per_node_iteration", "time per node and iteration [us]"), ("iterations", "iterations")]
    figure, grid = plt.subplots(2, len(tasks), figsize=(4.2 * len(tasks) + 0.6, 6.4), squeeze=False)
    for column, task in enumerate(tasks):
        for row, (key, text) in enumerate(quantities):
            axes = grid[row][column]
            draw_lines(axes, good(records, ("growth",), task), "nodes", key)
            axes.set_title(task, fontsize=10)
            axes.set_xlabel("nodes")
            axes.set_ylabel(text)
            axes.set_ylim(bottom=0)
            logarithmic(axes.xaxis)
            axes.xaxis.set_minor_locator(NullLocator())
            axes.set_xticks(
                sorted(
                    {r["nodes"] for r in good(records, ("growth",), task) if not r["label"].startswith("Prowl")}
                    or {r["nodes"] for r in good(records, ("growth",), task)}
                )
            )
    finish(figure, list(grid.flat), path)


def plot_all(records: list[dict], folder: pathlib.Path) -> None:
    plot_error_against_time(records, folder / "error_against_time")
    plot_growth(records, folder / "growth")
