"""Plans, as objects or folders."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from . import _prowl

PlanOrFolder = _prowl.Plan | str | os.PathLike[str]
Folders = Sequence[str | os.PathLike[str]]

_PLAN_FILES = ("plan.json", "trajectory.csv", "tracker.bin")


def as_plan(plan: PlanOrFolder, package_dirs: Folders = (), allow_libraries: bool = False) -> _prowl.Plan:
    """The plan, read if given as a folder."""
    if isinstance(plan, _prowl.Plan):
        return plan
    folders = [os.fspath(folder) for folder in package_dirs]
    return _prowl.read_plan(os.fspath(plan), folders, allow_libraries=allow_libraries)


@contextmanager
def folder_with(plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> Iterator[Path]:
    """A folder with plan and simulation: the plan folder if sufficient, or else a temporary one."""
    if plan.path is not None and simulation is None:
        yield plan.path
        return
    with tempfile.TemporaryDirectory(prefix="prowl_") as name:
        folder = Path(name)
        if plan.path is None:
            plan.write(folder)
        else:
            for file in _PLAN_FILES:
                if (plan.path / file).exists():
                    shutil.copy(plan.path / file, folder)
        if simulation is not None:
            simulation.write(folder)
        yield folder


def output_folder(plan: _prowl.Plan, out: str | os.PathLike[str] | None, name: str) -> str:
    """`out`, or else the folder `name` in the plan folder."""
    if out is not None:
        return os.fspath(out)
    if plan.path is None:
        raise _prowl.InputError("out: need a folder for the files: this plan was not read from one")
    return os.fspath(plan.path / name)
