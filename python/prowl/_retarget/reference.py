"""References: postures over time, from CSV and npz files of several makers."""

from __future__ import annotations

import os
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import _prowl
from .._postures import places_between, postures_between, rotated


@dataclass(frozen=True)
class Reference:
    t: np.ndarray  #: (N) ascending from 0 [s]
    q: np.ndarray  #: (N, nq)

    def slower(self, factor: float) -> Reference:
        return Reference(self.t * factor, self.q)

    def lower(self, height: float) -> Reference:
        q = self.q.copy()
        q[:, 2] -= height
        return Reference(self.t, q)

    def at(self, times: np.ndarray) -> np.ndarray:
        """Postures at these times: linear in between, the base along the shortest turn."""
        return postures_between(self.q, *places_between(self.t, times))

    def velocities(self) -> np.ndarray:
        """v (N, nv) by differences over both neighbours: twist of the base in its frame, joint rates."""
        last = len(self.t) - 1
        before, after = np.maximum(np.arange(last + 1) - 1, 0), np.minimum(np.arange(last + 1) + 1, last)
        steps = (self.t[after] - self.t[before])[:, None]
        rates = (_prowl.difference(self.q, self.q[after]) - _prowl.difference(self.q, self.q[before])) / steps
        rates[:, :3] = rotated(self.q[:, 3:7] * [-1.0, -1.0, -1.0, 1.0], rates[:, :3])  # into the axes of the base
        return rates

    def csv(self, robot: _prowl.Robot) -> str:
        """The file that [reference] of a task reads."""
        names = ["time_s", "base_px_m", "base_py_m", "base_pz_m", "base_qx", "base_qy", "base_qz", "base_qw"]
        lines = [",".join(names + [f"q_{joint}_rad" for joint in robot.joint_names])]
        lines += [",".join(repr(float(x)) for x in (t, *q)) for t, q in zip(self.t, self.q)]
        return "\n".join(lines) + "\n"


def _refuse(path: Path, row: int, column: str, value: object, need: str) -> None:
    raise _prowl.InputError(f"{path}: row {row}, {column}: {value} is not allowed; need {need}")


def _checked(path: Path, t: np.ndarray, q: np.ndarray, names: list[str]) -> Reference:
    """Raises InputError with row and column, both from 1 or by name."""
    if len(t) < 2:
        raise _prowl.InputError(f"{path}: {len(t)} samples; need two or more")
    for row, column in np.argwhere(~np.isfinite(np.column_stack([t, q])))[:1]:
        value = np.column_stack([t, q])[row, column]
        _refuse(path, row + 1, ["time", *names][column], value, "a finite number")
    for row in np.flatnonzero(~(np.diff(t) > 0))[:1]:
        _refuse(path, row + 2, "time", t[row + 1], f"more than {t[row]:g}, that of the row before")
    length = np.linalg.norm(q[:, 3:7], axis=1)
    for row in np.flatnonzero(np.abs(length - 1.0) > 1e-3)[:1]:
        _refuse(path, row + 1, "quaternion of the base", f"a length of {length[row]:g}", "1")
    q = q.copy()
    q[:, 3:7] /= length[:, None]
    return Reference(t - t[0], q)


def _columns(robot: _prowl.Robot) -> list[str]:
    return [*(f"base {axis}" for axis in ("x", "y", "z", "qx", "qy", "qz", "qw")), *robot.joint_names]


def _rows(path: Path, fps: float | None, robot: _prowl.Robot) -> Reference:
    """A CSV file without names: base position, quaternion x y z w, joints in the robot's order."""
    if fps is None:
        raise _prowl.InputError(f"{path}: no names of columns, so no times; need --fps")
    if not 0 < fps < np.inf:
        raise _prowl.InputError(f"fps: {fps:g} is not allowed; need more than 0")
    try:
        rows = np.loadtxt(path, delimiter=",", ndmin=2)
    except ValueError as error:
        raise _prowl.InputError(f"{path}: {error}") from None
    if rows.shape[1] != robot.nq:
        raise _prowl.InputError(
            f"{path}: {rows.shape[1]} columns; {robot.name} needs {robot.nq}: 7 of the base, {robot.nu} joints"
        )
    return _checked(path, np.arange(len(rows)) / fps, rows, _columns(robot))


def _read_npz(path: Path) -> dict[str, np.ndarray]:
    try:
        with np.load(path, allow_pickle=False) as file:
            return {name: np.asarray(file[name]) for name in file.files}
    except (ValueError, OSError, EOFError, TypeError, AttributeError, zipfile.BadZipFile, zlib.error) as error:
        raise _prowl.InputError(f"{path}: no npz file of numbers: {error}") from None


def _with_shape(path: Path, arrays: dict[str, np.ndarray], name: str, shape: tuple[int | None, ...]) -> np.ndarray:
    """An array of numbers; None in the shape stands for any length."""
    array = arrays[name]
    fits = array.ndim == len(shape) and all(want in (None, size) for size, want in zip(array.shape, shape))
    if not fits or array.dtype.kind not in "fiu":
        wanted = " x ".join("any" if want is None else str(want) for want in shape)
        raise _prowl.InputError(f"{path}: {name} of shape {array.shape} is not allowed; need numbers, {wanted}")
    return array.astype(float)


def _arrays(path: Path, robot: _prowl.Robot) -> Reference:
    """An npz file with t and q, as prowl export writes it, or that of mjlab and whole_body_tracking."""
    arrays = _read_npz(path)
    if "t" in arrays and "q" in arrays:
        t = _with_shape(path, arrays, "t", (None,))
        q = _with_shape(path, arrays, "q", (len(t), robot.nq))
        joints = arrays.get("joints")
        last = np.append(np.diff(t) != 0, True)[: len(t)]  # at a phase transition the later sample
        t, q = t[last], q[last]
    else:
        missing = [name for name in ("fps", "joint_pos", "body_pos_w", "body_quat_w") if name not in arrays]
        if missing:
            raise _prowl.InputError(f"{path}: no arrays {', '.join(missing)}; need these, or t and q")
        positions = _with_shape(path, arrays, "joint_pos", (None, robot.nu))
        places = _with_shape(path, arrays, "body_pos_w", (len(positions), None, 3))
        turns = _with_shape(path, arrays, "body_quat_w", (len(positions), places.shape[1], 4))
        fps = np.ravel(arrays["fps"])
        if fps.size != 1 or fps.dtype.kind not in "fiu" or not 0 < fps[0] < np.inf or places.shape[1] == 0:
            raise _prowl.InputError(f"{path}: fps, bodies: need one number above zero, and one body or more")
        q = np.column_stack([places[:, 0], np.roll(turns[:, 0], -1, axis=1), positions])  # from w x y z
        t = np.arange(len(q)) / float(fps[0])
        joints = arrays.get("joint_names")
    if joints is not None:
        names = [str(name) for name in np.ravel(joints)]
        if sorted(names) != sorted(robot.joint_names):
            odd = sorted(set(names) ^ set(robot.joint_names))
            raise _prowl.InputError(f"{path}: joints are not those of {robot.name}: {', '.join(odd[:4])}")
        q[:, 7:] = q[:, [7 + names.index(name) for name in robot.joint_names]]
    return _checked(path, t, q, _columns(robot))


def read_reference(motion: str | os.PathLike[str], robot: _prowl.Robot, fps: float | None) -> Reference:
    """Raises InputError with file, row and column."""
    path = Path(motion)
    if not path.is_file():
        raise _prowl.InputError(f"{path}: no such file")
    if path.suffix == ".npz":
        return _arrays(path, robot)
    with path.open(encoding="utf-8", errors="replace") as file:
        heading = file.readline()
    if "time_s" not in heading.split(","):
        return _rows(path, fps, robot)
    t, q = robot.read_reference(path)
    return _checked(path, np.asarray(t), np.asarray(q), _columns(robot))
