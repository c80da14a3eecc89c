"""report(): writes the page of `prowl report`; Plan.show(): shows it in a notebook or a browser."""

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

# Installed: beside robots and tasks; build: in build/share.
_PAGES = (SHARE, Path(_prowl.__file__).resolve().parents[2] / "share/prowl")


@dataclass(frozen=True)
class Report:
    """Result of report()."""

    plan: _prowl.Plan
    file: str
    size: int  #: [bytes]
    has_simulation: bool
    warnings: list[str]  #: replaced content, e.g. unreadable meshes


def report(
    plan: PlanOrFolder,
    out: str | os.PathLike[str] | None = None,
    *,
    simulation: _prowl.Simulation | None = None,
    package_dirs: Folders = (),
) -> Report:
    """Writes a page that replays a plan in a browser, like `prowl report`: one file, needs no network.

    plan: a Plan, or a plan folder. out: file to write; None: report.html in the plan folder. simulation:
    shown with the plan; None: that in the plan folder. package_dirs: see read_task().

    Warns of unreadable meshes. Raises InputError, FileError.
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
        file.write(text)  # not deleted: the browser may read it after this process ends
    if not webbrowser.open(Path(file.name).as_uri()):
        warnings.warn(f"no browser here; open {file.name} in one", stacklevel=2)


class _Frame:
    """A page below the cell of a notebook. The notebook file contains it, so it survives reopening and
    nbconvert."""

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
    """The page, its warnings, and True if it contains a simulation."""
    csv, json = (simulation.to_csv(), simulation.to_json()) if simulation is not None else _simulation_files(plan)
    folder = "" if plan.path is None else os.fspath(plan.path)
    text, told = _prowl.report_page(
        plan,
        directory=folder,
        template_html=page_template("report.html"),
        simulation_csv=csv,
        simulation_json=json,
        package_dirs=[os.fspath(path) for path in package_dirs],
    )
    return text, told, csv is not None


def page_template(name: str) -> str:
    """A page without data."""
    for folder in _PAGES:
        if (folder / name).is_file():
            return (folder / name).read_text(encoding="utf-8")
    raise _prowl.FileError(
        f"{_PAGES[-1] / name}: missing; scripts/setup builds it from report/, with the Node.js in .venv"
    )


def _simulation_files(plan: _prowl.Plan) -> tuple[str | None, str | None]:
    """simulate.csv and simulate.json in the plan folder."""

    def read(name: str) -> str | None:
        if plan.path is None or not (plan.path / name).is_file():
            return None
        return (plan.path / name).read_text(encoding="utf-8")

    return read("simulate.csv"), read("simulate.json")
