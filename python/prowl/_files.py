"""Robots and tasks: from files, from texts, and shipped ones."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path

from . import _prowl
from ._documents import Document, toml_text
from ._terms import without_terms

_HERE = Path(__file__).resolve().parent
# Wheel: beside this file. Installed (share/prowl/python/prowl): above it. Build
# (build/python/prowl): the repository.
_PLACES = (_HERE / "share" / "prowl", _HERE.parents[1], _HERE.parents[2])
SHARE = next(folder for folder in _PLACES if (folder / "tasks").is_dir())


def shipped_tasks() -> list[str]:
    """Names of the shipped tasks, such as "hyq/crouch", for read_task()."""
    folder = SHARE / "tasks"
    return sorted(path.relative_to(folder).with_suffix("").as_posix() for path in folder.glob("*/*.toml"))


def shipped_robots() -> list[str]:
    """Names of the shipped robots, such as "hyq", for read_robot()."""
    return sorted(path.stem for path in (SHARE / "robots").glob("*.toml"))


def _find(name: str | os.PathLike[str], shipped: list[str], folder: str) -> Path:
    path = Path(name)
    if path.is_file() or os.fspath(name) not in shipped:
        if not path.suffix and not path.exists():
            nearest = _prowl.did_you_mean(os.fspath(name), shipped)
            raise _prowl.InputError(f"{path}: no such file, nor a shipped one{nearest} Known: {', '.join(shipped)}")
        return path
    return SHARE / folder / f"{name}.toml"


def _robot_of(task: Document, folder: Path) -> tuple[Document, tuple[Path, str] | None]:
    """The task with the path of its robot file, and that file if the dict contains a Robot."""
    if isinstance(task, str) or "robot" not in task:
        return task, None
    robot = task["robot"]
    if isinstance(robot, _prowl.Robot):
        return {**task, "robot": os.fspath(robot.path)}, (robot.path, robot.text)
    if not isinstance(robot, str | os.PathLike) or (folder / robot).is_file() or Path(robot).suffix:
        return task, None
    try:
        return {**task, "robot": os.fspath(_find(robot, shipped_robots(), "robots"))}, None
    except _prowl.InputError as error:
        raise _prowl.InputError(f"robot: {error}") from None


def _folders(package_dirs: Sequence[str | os.PathLike[str]]) -> list[str]:
    return [os.fspath(folder) for folder in package_dirs]


def read_robot(robot: str | os.PathLike[str], *, package_dirs: Sequence[str | os.PathLike[str]] = ()) -> _prowl.Robot:
    """Reads a robot file (docs/robot-file.md), or a shipped robot by name: read_robot("hyq").

    package_dirs: folders to search for package://, before those of ROS. Raises InputError with file, line and column.
    """
    return _prowl.read_robot(_find(robot, shipped_robots(), "robots"), _folders(package_dirs))


def parse_robot(
    document: Document,
    *,
    folder: str | os.PathLike[str] = ".",
    package_dirs: Sequence[str | os.PathLike[str]] = (),
) -> _prowl.Robot:
    """A robot from the text of a robot file, or from a dict with the same keys and NumPy arrays or lists.
    Paths in it are relative to `folder`.

    Messages name FOLDER/robot.toml and lines of the text; for a dict look at the key.
    """
    return _prowl.parse_robot(toml_text(document), Path(folder) / "robot.toml", _folders(package_dirs))


def read_task(
    task: str | os.PathLike[str],
    *,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    intervals: int | None = None,
    max_iterations: int | None = None,
    max_time: float | None = None,
    tolerance: float | None = None,
    robust: bool = False,
    own_terms: Mapping[str, _prowl.Term] | None = None,
    allow_libraries: bool = False,
) -> _prowl.Task:
    """Reads a task file (docs/task-file.md), or a shipped task by name: read_task("hyq/crouch").

    intervals, max_iterations, max_time [s] and tolerance replace those of the file; intervals: of all phases
    together. robust: as with a table [robust], if the file has none. package_dirs: folders to search for package://,
    before those of ROS. own_terms: by the names that the file uses, from own_term(). allow_libraries: run libraries of
    terms that the file names. Raises InputError with file, line and column.
    """
    return _prowl.read_task(
        _find(task, shipped_tasks(), "tasks"),
        package_dirs=_folders(package_dirs),
        intervals=intervals,
        max_iterations=max_iterations,
        max_time=max_time,
        tolerance=tolerance,
        robust=robust,
        own_terms=dict(own_terms or {}),
        allow_libraries=allow_libraries,
    )


def parse_task(
    document: Document,
    *,
    folder: str | os.PathLike[str] = ".",
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    intervals: int | None = None,
    max_iterations: int | None = None,
    max_time: float | None = None,
    tolerance: float | None = None,
    robust: bool = False,
    own_terms: Mapping[str, _prowl.Term] | None = None,
    allow_libraries: bool = False,
) -> _prowl.Task:
    """A task from the text of a task file, or from a dict with the same keys, like tomllib.loads(task.text).

    A dict may contain a Robot, or the name of a shipped one, as its robot, terms from own_term() as `own`, and NumPy
    arrays instead of lists.
    The path of a robot file is relative to `folder`: use task.path.parent for a changed task. The other
    arguments are those of read_task(). Messages name FOLDER/task.toml and lines of the text; for a dict look
    at the key.
    """
    document, robot_file = _robot_of(document, Path(folder))
    document, own = without_terms(document)
    return _prowl.parse_task(
        toml_text(document),
        Path(folder) / "task.toml",
        robot_file=robot_file,
        package_dirs=_folders(package_dirs),
        intervals=intervals,
        max_iterations=max_iterations,
        max_time=max_time,
        tolerance=tolerance,
        robust=robust,
        own_terms={**(own_terms or {}), **own},
        allow_libraries=allow_libraries,
    )
