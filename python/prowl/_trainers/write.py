"""Writes the motions of a library that are kept, for a trainer."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .. import _prowl
from .._postures import places_between, postures_between
from .bodies import order_of

if TYPE_CHECKING:
    from .._batch.library import Library

FORMATS = ("mjlab", "lerobot")


def even_samples(motion: dict[str, np.ndarray], rate: float) -> dict[str, np.ndarray]:
    """Samples at multiples of the period alone: a library also has the end of each motion. Linear between samples."""
    period = 1.0 / rate
    times = np.arange(int(np.floor(motion["t"][-1] / period + 1e-9)) + 1) * period
    if len(times) <= len(motion["t"]) and np.allclose(motion["t"][: len(times)], times, rtol=0, atol=1e-9):
        return {name: values[: len(times)] for name, values in motion.items()}
    before, share = places_between(motion["t"], times)
    result = {"t": times, "q": postures_between(motion["q"], before, share)}
    for name in ("v", "tau", "f"):
        result[name] = (1 - share) * motion[name][before] + share * motion[name][before + 1]
    result["in_contact"] = motion["in_contact"][np.where(share[:, 0] < 1.0, before, before + 1)]
    return result


def _robot_of_all(library: Library, indices: list[int]) -> _prowl.Robot:
    """Raises InputError unless all motions are of robots with the same joints and contacts."""
    robots = {(tuple(robot.joint_names), tuple(robot.contact_names)): robot for robot in map(library.robot, indices)}
    if len(robots) > 1:
        raise _prowl.InputError(f"{library.folder}: motions of robots with other joints; need one robot")
    return next(iter(robots.values()))


def _files(
    library: Library, format: str, rate: float, model: str | None, tell: Callable[[int, int], object]
) -> Iterator[tuple[str, bytes]]:
    kept = library.kept_rows["index"].to_pylist()
    if not kept:
        raise _prowl.InputError(f"{library.folder}: no motion was kept, so none can be written")
    robot = _robot_of_all(library, kept)
    task = library.base_task()

    def motions() -> Iterator[tuple[int, dict[str, np.ndarray]]]:
        for count, index in enumerate(kept):
            yield index, even_samples(library.arrays(index), rate)
            tell(count + 1, len(kept))

    if format == "mjlab":
        from .mjlab import motion_arrays, npz

        order = order_of(robot, library.task(kept[0]).mujoco_xml() if model is None else model)
        for index, motion in motions():
            yield f"motion_{index:05d}.npz", npz(motion_arrays(robot, motion["q"], motion["v"], rate, order))
        return
    from .lerobot import Dataset

    dataset = Dataset(robot, rate, task.name)
    for _, motion in motions():
        yield from dataset.add(motion)
    yield from dataset.close()


def write_for_trainer(
    library: Library,
    format: str,
    out: str | os.PathLike[str],
    rate: float | None,
    model: str | os.PathLike[str] | None,
    on_progress: Callable[[int, int], object] | None,
) -> list[str]:
    """Names of the files. Raises InputError if the folder is not empty."""
    if format not in FORMATS:
        raise _prowl.InputError(f"format: {format} is not allowed; need one of {', '.join(FORMATS)}")
    folder = Path(out)
    if folder.exists() and any(folder.iterdir()):
        raise _prowl.InputError(f"{folder}: not empty; need another folder")
    text = None if model is None else Path(model).read_text(encoding="utf-8")
    names: list[str] = []
    tell = on_progress or (lambda done, total: None)
    for name, content in _files(library, format, library.job.rate if rate is None else rate, text, tell):
        path = folder / name
        _prowl.write_files(path.parent, {path.name: content})
        names.append(name)
    return names
