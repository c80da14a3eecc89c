"""report(): the page of `prowl report`; Plan.show(): the same page in a notebook or a browser."""

from __future__ import annotations

import os
import sys
import tempfile
import warnings
import webbrowser
from dataclasses import dataclass
from html import escape
from pathlib import Path

from .. import _prowl
from .._files import SHARE
from .._plans import Folders, PlanOrFolder, as_plan

# Of an installation beside robots and tasks; of a build in build/share.
_PAGES = (SHARE / "report.html", Path(_prowl.__file__).resolve().parents[2] / "share/prowl/report.html")


@dataclass(frozen=True)
class Report:
    """The page that report() has written."""

    plan: _prowl.Plan
    file: str
    size: int  #: [bytes]
    has_simulation: bool
    warnings: list[str]  #: what the page shows in another way than the robot's files say


def report(
    plan: PlanOrFolder,
    out: str | os.PathLike[str] | None = None,
    *,
    simulation: _prowl.Simulation | None = None,
    package_dirs: Folders = (),
) -> Report:
    """Writes the page that replays a plan in a browser, as `prowl report` does: one file, needs no network.

    plan: a Plan, or the folder of one. out: the file to write; report.html in the folder of the plan if None. simulation:
    shown beside the plan; that in the folder of the plan if None. package_dirs: as of read_task().

    Warns of a mesh that cannot be read. Raises InputError, FileError.
    """
    found = as_plan(plan, package_dirs)
    if out is None and found.path is None:
        raise _prowl.InputError("out: need a file to write: this plan was not read from a folder")
    file = Path(found.path or ".") / "report.html" if out is None else Path(out)
    text, told, has_simulation = _page(found, simulation, package_dirs)
    for warning in told:
        warnings.warn(warning, stacklevel=2)
    content = text.encode()
    _prowl.write_files(file.parent, {file.name: content})
    return Report(found, os.fspath(file), len(content), has_simulation, told)


def show(plan: _prowl.Plan, simulation: _prowl.Simulation | None, height: int) -> None:
    """Plan.show()."""
    if not 100 <= height <= 10000:
        raise _prowl.InputError(f"height: {height} is not allowed; need 100 to 10000 [pixels]")
    text, _, _ = _page(plan, simulation, ())
    if "ipykernel" in sys.modules:
        from IPython.display import display

        display(_Frame(text, height))
        return
    with tempfile.NamedTemporaryFile("w", prefix="prowl_", suffix=".html", encoding="utf-8", delete=False) as file:
        file.write(text)  # kept: the browser reads it after this process may have ended
    if not webbrowser.open(Path(file.name).as_uri()):
        warnings.warn(f"no browser here; open {file.name} in one", stacklevel=2)


class _Frame:
    """A whole page below the cell of a notebook. It is in the notebook's file, so that it is there when that is opened
    again, and in what nbconvert makes of it."""

    def __init__(self, page: str, height: int) -> None:
        self._page, self._height = page, height

    def __repr__(self) -> str:
        return "<page of prowl report>"

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{escape(self._page)}" title="Prowl report" '
            f'style="width:100%;height:{self._height}px;border:1px solid #8884;border-radius:6px"></iframe>'
        )


def _page(
    plan: _prowl.Plan, simulation: _prowl.Simulation | None, package_dirs: Folders
) -> tuple[str, list[str], bool]:
    """The page, its warnings, and whether a simulation is in it."""
    csv, json = (simulation.to_csv(), simulation.to_json()) if simulation is not None else _simulation_files(plan)
    folder = "" if plan.path is None else os.fspath(plan.path)
    text, told = _prowl.report_page(
        plan,
        directory=folder,
        template_html=_template(),
        simulation_csv=csv,
        simulation_json=json,
        package_dirs=[os.fspath(path) for path in package_dirs],
    )
    return text, told, csv is not None


def _template() -> str:
    for file in _PAGES:
        if file.is_file():
            return file.read_text(encoding="utf-8")
    raise _prowl.FileError(f"{_PAGES[-1]}: missing; scripts/setup builds it from report/, with the Node.js in .venv")


def _simulation_files(plan: _prowl.Plan) -> tuple[str | None, str | None]:
    """simulate.csv and simulate.json in the folder of the plan."""

    def read(name: str) -> str | None:
        if plan.path is None or not (plan.path / name).is_file():
            return None
        return (plan.path / name).read_text(encoding="utf-8")

    return read("simulate.csv"), read("simulate.json")
