"""figures(): a plan, its gains and its simulation as pictures (docs/figures.md)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from .. import _prowl


@dataclass(frozen=True)
class Figures:
    """What figures() has drawn."""

    plan: _prowl.Plan
    folder: str
    names: list[str]  #: of the figures, such as "torques"
    files: list[str]  #: their names


def figures(
    directory: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    joint: str | None = None,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    on_progress: Callable[[int, int], object] | None = None,
) -> Figures:
    """Draws the plan in a folder, its gains and its simulation, as `prowl figures` does: SVG, PNG and CSV.

    out: folder for the figures, which holds nothing else; DIRECTORY/figures if None. joint: whose gains to draw; the first
    knee, or else the last joint of the first leg, if None. package_dirs: as of read_task(). on_progress: called with the
    number of figures that are drawn, and of all.

    Needs numpy, scipy and matplotlib. What cannot be drawn, without gains or simulation, is left out with a warning. Raises
    InputError for a wrong plan or joint, FileError if `out` cannot be replaced; then nothing is written.
    """
    from . import draw, tables  # with Matplotlib, which takes a second to load

    folder = os.fspath(directory)
    place = os.path.join(folder, "figures") if out is None else os.fspath(out)
    plan = _prowl.read_plan(folder, [os.fspath(path) for path in package_dirs])
    gains_joint = tables.gains_joint(plan.robot, joint)
    _prowl.check_replaceable(place, _prowl.figure_file_names())

    if plan.tracker is None:
        warnings.warn(f"no gains in {folder}: without figure gains; prowl plan writes them (tracker.bin)", stacklevel=2)
    if not (Path(folder) / "simulate.csv").exists():
        missing = f"no simulation in {folder}: planned motion only, without base_error and joint_error"
        remedy = f"\nfor all figures first\n  prowl simulate {folder}" if plan.tracker is not None else ""
        warnings.warn(missing + remedy, stacklevel=2)
    files = draw.draw(tables.Shown(plan, Path(folder), gains_joint), on_progress)
    _prowl.write_folder(place, files, _prowl.figure_file_names())
    names = sorted(files)
    pictures = [name.removesuffix(".png") for name in names if name.endswith(".png")]
    return Figures(plan, place, pictures, names)
