"""Datasets of LeRobot, version 3: one episode for each motion."""

from __future__ import annotations

import io
import json
from collections.abc import Iterator

import numpy as np
import pandas
import pyarrow as pa
import pyarrow.parquet as pq

from .. import _prowl

_DATA = "data/chunk-{chunk_index:03d}/file-{file_index:03d}.parquet"
_EPISODES = "meta/episodes/chunk-000/file-000.parquet"
_FRAMES_A_FILE = 100_000  #: some ten megabytes
_COUNTERS = ("timestamp", "frame_index", "episode_index", "index", "task_index")


def features(robot: _prowl.Robot) -> dict[str, list[str]]:
    """Names of the entries of each feature: state is q and v, action the torques."""
    joints = list(robot.joint_names)
    base = [f"base_{axis}" for axis in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    twist = [f"base_{axis}" for axis in ("vx", "vy", "vz", "wx", "wy", "wz")]
    return {
        "observation.state": base + [f"{joint}.pos" for joint in joints] + twist + [f"{joint}.vel" for joint in joints],
        "observation.contact_force": [f"{contact}.{axis}" for contact in robot.contact_names for axis in "xyz"],
        "observation.in_contact": list(robot.contact_names),
        "action": [f"{joint}.torque" for joint in joints],
    }


def _frames(motion: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    return {
        "observation.state": np.hstack([motion["q"], motion["v"]]),
        "observation.contact_force": motion["f"],
        "observation.in_contact": motion["in_contact"],
        "action": motion["tau"],
    }


def _parquet(table: pa.Table) -> bytes:
    file = io.BytesIO()
    pq.write_table(table, file, compression="snappy")
    return file.getvalue()


def _rows(values: np.ndarray) -> pa.Array:
    flat = np.ascontiguousarray(values, dtype=np.float32)
    return pa.FixedSizeListArray.from_arrays(pa.array(flat.ravel()), flat.shape[1])


def _statistics(values: np.ndarray) -> dict[str, list[float]]:
    columns = values.reshape(len(values), -1).astype(float)
    quantiles = {
        f"q{round(100 * share):02d}": np.quantile(columns, share, axis=0) for share in (0.01, 0.1, 0.5, 0.9, 0.99)
    }
    result = {
        "min": columns.min(axis=0),
        "max": columns.max(axis=0),
        "mean": columns.mean(axis=0),
        "std": columns.std(axis=0),
        **quantiles,
    }
    return {name: entry.tolist() for name, entry in result.items()} | {"count": [len(columns)]}


class Dataset:
    """Collects the files of a dataset, whole Parquet files each."""

    def __init__(self, robot: _prowl.Robot, fps: float, task: str) -> None:
        if fps != round(fps):
            raise _prowl.InputError(f"rate: {fps:g} is not allowed; LeRobot needs a whole number of frames a second")
        self._robot, self._fps, self._task = robot, round(fps), task
        self._features = features(robot)
        self._episodes: list[dict[str, object]] = []
        self._all: dict[str, list[np.ndarray]] = {}
        self._open: dict[str, list[np.ndarray]] = {}  # of the data file that is not written yet
        self._frames = self._files = 0

    def add(self, motion: dict[str, np.ndarray]) -> Iterator[tuple[str, bytes]]:
        """Adds an episode; returns the files that are complete with it."""
        frames = _frames(motion)
        count, episode = len(frames["action"]), len(self._episodes)
        counted = {
            "timestamp": np.arange(count) / self._fps,
            "frame_index": np.arange(count),
            "episode_index": np.full(count, episode),
            "index": self._frames + np.arange(count),
            "task_index": np.zeros(count, dtype=int),
        }
        self._episodes.append(
            {
                "episode_index": episode,
                "tasks": [self._task],
                "length": count,
                "data/chunk_index": 0,
                "data/file_index": self._files,
                "dataset_from_index": self._frames,
                "dataset_to_index": self._frames + count,
                "meta/episodes/chunk_index": 0,
                "meta/episodes/file_index": 0,
            }
            | {
                f"stats/{key}/{name}": value
                for key, values in (frames | counted).items()
                for name, value in _statistics(values).items()
            }
        )
        for key, values in (frames | counted).items():
            self._open.setdefault(key, []).append(values)
            self._all.setdefault(key, []).append(values)
        self._frames += count
        if sum(len(values) for values in self._open["index"]) >= _FRAMES_A_FILE:
            yield self._data_file()

    def _data_file(self) -> tuple[str, bytes]:
        columns = {key: np.concatenate(values) for key, values in self._open.items()}
        table = {key: _rows(columns[key]) for key in self._features}
        table["timestamp"] = pa.array(columns["timestamp"].astype(np.float32))
        table |= {key: pa.array(columns[key].astype(np.int64)) for key in _COUNTERS[1:]}
        name = _DATA.format(chunk_index=0, file_index=self._files)
        self._files += 1
        self._open = {}
        return name, _parquet(pa.table(table))

    def close(self) -> Iterator[tuple[str, bytes]]:
        """The last files."""
        if self._open:
            yield self._data_file()
        yield _EPISODES, _parquet(pa.Table.from_pylist(self._episodes))
        tasks = io.BytesIO()
        pandas.DataFrame({"task_index": [0]}, index=[self._task]).to_parquet(tasks)
        yield "meta/tasks.parquet", tasks.getvalue()
        statistics = {key: _statistics(np.concatenate(values)) for key, values in self._all.items()}
        yield "meta/stats.json", (json.dumps(statistics, indent=1) + "\n").encode()
        yield "meta/info.json", (json.dumps(self._info(), indent=1) + "\n").encode()

    def _info(self) -> dict[str, object]:
        described = {
            key: {"dtype": "float32", "shape": [len(names)], "names": names} for key, names in self._features.items()
        }
        described |= {
            key: {"dtype": "float32" if key == "timestamp" else "int64", "shape": [1], "names": None}
            for key in _COUNTERS
        }
        return {
            "codebase_version": "v3.0",
            "robot_type": self._robot.name,
            "total_episodes": len(self._episodes),
            "total_frames": self._frames,
            "total_tasks": 1,
            "chunks_size": 1000,
            "data_files_size_in_mb": 100,
            "video_files_size_in_mb": 200,
            "fps": self._fps,
            "splits": {"train": f"0:{len(self._episodes)}"},
            "data_path": _DATA,
            "video_path": None,
            "features": described,
        }
