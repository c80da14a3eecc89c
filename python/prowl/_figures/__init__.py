"""figures(): draws a plan, its gains and its simulation (docs/figures.md)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from .. import _prowl
from .._extras import needs
from .._plans import Folders, PlanOrFolder, as_plan, folder_with, output_folder


@dataclass(frozen=True)
class Figures:
    """Result of figures()."""

    plan: _prowl.Plan
    folder: str
    names: list[str]  #: of figures, such as "torques"
    files: list[str]  #: file names


def figures(
    plan: PlanOrFolder,
    *,
    simulation: _prowl.Simulation | None = None,
    out: str | os.PathLike[str] | None = None,
    joint: str | None = None,
    package_dirs: Folders = (),
    allow_libraries: bool = False,
    on_progress: Callable[[int, int], object] | None = None,
) -> Figures:
    """Draws a plan, its gains and its simulation, like `prowl figures`: SVG, PNG and CSV.

    plan: a Plan, or a plan folder. simulation: of the plan; None: that in the plan folder. out: folder for
    the figures, which contains nothing else; None: figures in the plan folder. joint: for the plot of gains;
    None: the first knee, or else the last joint of the first leg. package_dirs, allow_libraries: see
    read_task(). on_progress: called with the number of finished and of all figures.

    Needs numpy, scipy and matplotlib. Omits figures without data (no gains or simulation), with a warning.
    Raises InputError for an invalid plan or joint, FileError if `out` cannot be replaced; then it writes
    nothing.
    """
    with needs("figures"):
        from . import draw, tables  # imports Matplotlib, which takes a second

    drawn = as_plan(plan, package_dirs, allow_libraries)
    folder = output_folder(drawn, out, "figures")
    gains_joint = tables.gains_joint(drawn.robot, joint)
    _prowl.check_replaceable(folder, _prowl.figure_file_names())
    with folder_with(drawn, simulation) as source:
        for warning in _warnings(drawn, source):
            warnings.warn(warning, stacklevel=2)
        files = draw.draw(tables.Shown(drawn, source, gains_joint), on_progress)
    _prowl.write_folder(folder, files, _prowl.figure_file_names())
    names = sorted(files)
    pictures = [name.removesuffix(".png") for name in names if name.endswith(".png")]
    return Figures(drawn, folder, pictures, names)


def _warnings(plan: _prowl.Plan, source: Path) -> Iterator[str]:
    """Warnings about omitted figures, with the reason."""
    where = f" in {plan.path}" if plan.path is not None else ""
    if plan.tracker is None:
        yield f"no gains{where}: without figure gains; prowl plan writes them (tracker.bin)"
    if (source / "simulate.csv").exists():
        return
    remedy = f"prowl simulate {plan.path}" if plan.path is not None else "simulation=prowl.simulate(plan)"
    yield f"no simulation{where}: planned motion only, without base_error and joint_error" + (
        f"\nfor all figures first\n  {remedy}" if plan.tracker is not None else ""
    )
