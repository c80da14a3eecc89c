"""Robots and tasks: from files, from texts, and those that come with Prowl."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from . import _prowl

_HERE = Path(__file__).resolve().parent
# In a wheel beside this file; installed, share/prowl/python/prowl, above it; in a build, build/python/prowl, those of
# the repository.
_PLACES = (_HERE / "share" / "prowl", _HERE.parents[1], _HERE.parents[2])
_SHARE = next(folder for folder in _PLACES if (folder / "tasks").is_dir())


def shipped_tasks() -> list[str]:
    """Names of the tasks that come with Prowl, such as "hyq/crouch", for read_task()."""
    folder = _SHARE / "tasks"
    return sorted(path.relative_to(folder).with_suffix("").as_posix() for path in folder.glob("*/*.toml"))


def shipped_robots() -> list[str]:
    """Names of the robots that come with Prowl, such as "hyq", for read_robot()."""
    return sorted(path.stem for path in (_SHARE / "robots").glob("*.toml"))


def _find(name: str | os.PathLike[str], shipped: list[str], folder: str) -> Path:
    path = Path(name)
    if path.exists() or os.fspath(name) not in shipped:
        if not path.suffix and not path.exists():
            raise _prowl.InputError(f"{path}: no such file, nor one that comes with Prowl: {', '.join(shipped)}")
        return path
    return _SHARE / folder / f"{name}.toml"


# Has the URDFs of the shipped robots; HyQ's is also in Prowl's own wheel.
_ROBOTS = "example-robot-data==6.0.0"


@contextmanager
def _remedy(path: Path) -> Iterator[None]:
    """For a shipped robot without its URDF, what to install in place of all the folders that were searched."""
    try:
        yield
    except _prowl.InputError as error:
        if _SHARE not in path.parents or "package://example-robot-data" not in str(error):
            raise
        raise _prowl.InputError(
            f"{path}: the URDF of its robot comes with another package: pip install {_ROBOTS}"
        ) from error


def _folders(package_dirs: Sequence[str | os.PathLike[str]]) -> list[str]:
    return [os.fspath(folder) for folder in package_dirs]


def _toml(document: str | Mapping[str, Any]) -> str:
    if isinstance(document, str):
        return document
    import tomli_w  # figures() and export() do without

    try:
        return tomli_w.dumps(document)
    except (TypeError, AttributeError) as error:  # of None, a NumPy array, keys that are no strings
        raise _prowl.InputError(f"document: {error}; need a dict of what a TOML file can hold") from error


def read_robot(robot: str | os.PathLike[str], *, package_dirs: Sequence[str | os.PathLike[str]] = ()) -> _prowl.Robot:
    """Reads a robot file (docs/robot-file.md), or a robot that comes with Prowl by its name: read_robot("hyq").

    package_dirs: where to look for package://, before ROS's own places. Raises InputError with file, line and column.
    """
    path = _find(robot, shipped_robots(), "robots")
    with _remedy(path):
        return _prowl.read_robot(path, _folders(package_dirs))


def parse_robot(
    document: str | Mapping[str, Any],
    *,
    folder: str | os.PathLike[str] = ".",
    package_dirs: Sequence[str | os.PathLike[str]] = (),
) -> _prowl.Robot:
    """A robot from the text of a robot file, or from a dict of the same keys. Paths in it are relative to `folder`.

    Messages call it FOLDER/robot.toml, with the lines of the text; of a dict, of the text that it makes: look at the key.
    """
    return _prowl.parse_robot(_toml(document), Path(folder) / "robot.toml", _folders(package_dirs))


def read_task(
    task: str | os.PathLike[str],
    *,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    intervals: int | None = None,
    max_iterations: int | None = None,
    max_time: float | None = None,
    tolerance: float | None = None,
) -> _prowl.Task:
    """Reads a task file (docs/task-file.md), or a task that comes with Prowl by its name: read_task("hyq/crouch").

    intervals, max_iterations, max_time [s] and tolerance take the place of the file's; intervals are those of all phases
    together. package_dirs: where to look for package://, before ROS's own places. Raises InputError with file, line and
    column.
    """
    path = _find(task, shipped_tasks(), "tasks")
    with _remedy(path):
        return _prowl.read_task(
            path,
            package_dirs=_folders(package_dirs),
            intervals=intervals,
            max_iterations=max_iterations,
            max_time=max_time,
            tolerance=tolerance,
        )


def parse_task(
    document: str | Mapping[str, Any],
    *,
    folder: str | os.PathLike[str] = ".",
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    intervals: int | None = None,
    max_iterations: int | None = None,
    max_time: float | None = None,
    tolerance: float | None = None,
) -> _prowl.Task:
    """A task from the text of a task file, or from a dict of the same keys, as tomllib.loads(task.text) gives it.

    The robot file that it names is relative to `folder`: task.path.parent for a task that was changed. The other
    arguments are those of read_task(). Messages call it FOLDER/task.toml, with the lines of the text; of a dict, of the
    text that it makes: look at the key.
    """
    return _prowl.parse_task(
        _toml(document),
        Path(folder) / "task.toml",
        package_dirs=_folders(package_dirs),
        intervals=intervals,
        max_iterations=max_iterations,
        max_time=max_time,
        tolerance=tolerance,
    )
