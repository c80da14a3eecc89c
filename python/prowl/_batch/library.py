"""Libraries of motions on disk."""

from __future__ import annotations

import fcntl
import hashlib
import io
import json
import os
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from .. import _prowl
from .._extras import needs
from .._files import parse_task
from .._runs.solve import solve
from .job import drawn_task, refine_of
from .tables import index_schema
from .worker import JobText, why_other

FORMAT = 2  #: of the folder; a change of columns or file names makes the next
_ABOUT, _INDEX = "library.json", "index.parquet"


def _write(folder: Path, name: str, content: bytes) -> None:
    """Whole or not at all."""
    try:
        _prowl.write_files(folder, {name: content})
    except _prowl.FileError as error:
        raise _prowl.FileError(f"{error}; what is complete is kept") from None


def _write_table(path: Path, table: pa.Table) -> None:
    content = io.BytesIO()
    pq.write_table(table, content, compression="zstd")
    _write(path.parent, path.name, content.getvalue())


class Library:
    """A folder with motions: `index` has a row for each, shards have the samples of those that are kept.

    Files: library.json, job.toml and task.toml (its input), index.parquet, and for each shard index/K.parquet and
    motions/K.parquet. docs/batch.md explains the columns.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        """Raises InputError if the folder is no library, or one of another version."""
        self.folder = Path(folder)
        try:
            about = json.loads((self.folder / _ABOUT).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            raise _prowl.InputError(f"{self.folder}: no library of motions: no readable {_ABOUT}") from None
        if about.get("format") != FORMAT:
            raise _prowl.InputError(
                f"{self.folder}: a library of format {about.get('format')}; this version reads {FORMAT}: make it again"
            )
        self._about = about
        self._index: pa.Table | None = None  # until another shard is written
        self.text = JobText(
            job=(self.folder / "job.toml").read_bytes().decode(),  # line ends as they are
            job_path=about["job_path"],
            task=(self.folder / "task.toml").read_bytes().decode(),
            task_path=about["task_path"],
            files_sha256=about["files_sha256"],
            versions=tuple(sorted(about["versions"].items())),
            package_dirs=tuple(about["package_dirs"]),
        )
        self.job: _prowl.Job = _prowl.job_of(self.text.job, self.text.job_path, self.text.task, self.text.task_path)

    @classmethod
    def create(cls, folder: Path, text: JobText, job: _prowl.Job) -> Library:
        """An empty one; an existing one of the same job is opened, any other content refused."""
        about = {
            "format": FORMAT,
            "versions": dict(text.versions),
            "files_sha256": text.files_sha256,
            "count": job.count,
            "shard": job.shard,
            "job_path": text.job_path,
            "task_path": text.task_path,
            "package_dirs": list(text.package_dirs),
        }
        if (folder / _ABOUT).exists():
            library = cls(folder)
            if library.text != text or library._about != about:
                raise _prowl.InputError(
                    f"{folder}: the library of another job, version or machine; need another folder"
                )
            return library
        begun = {"index", "motions", "job.toml", "task.toml"}  # of one that was interrupted at once
        if folder.exists() and any(path.name not in begun and path.name[0] != "." for path in folder.iterdir()):
            raise _prowl.InputError(f"{folder}: not empty and no library; need another folder")
        _write(folder, "job.toml", text.job.encode())
        _write(folder, "task.toml", text.task.encode())
        _write(folder, _ABOUT, (json.dumps(about, indent=1) + "\n").encode())
        return cls(folder)

    @contextmanager
    def lock(self) -> Iterator[None]:
        """Raises FileError if another batch() writes this library."""
        file = os.open(self.folder, os.O_RDONLY)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            yield
        except BlockingIOError:
            raise _prowl.FileError(f"{self.folder}: another batch writes this library") from None
        finally:
            os.close(file)

    @property
    def count(self) -> int:
        """Motions of the job, made or not."""
        return self.job.count

    @property
    def shards(self) -> int:
        return -(-self.job.count // self.job.shard)

    def _part(self, shard: int, kind: str) -> Path:
        return self.folder / kind / f"{shard:05d}.parquet"

    def has_shard(self, shard: int) -> bool:
        return self._part(shard, "index").exists() and self._part(shard, "motions").exists()

    def write_shard(self, shard: int, index: pa.Table, samples: pa.Table) -> None:
        """The index is last: with it, the shard is complete."""
        self._index = None
        _write_table(self._part(shard, "motions"), samples)
        _write_table(self._part(shard, "index"), index)

    def write_index(self) -> None:
        """One table of all complete shards."""
        if self.done:
            _write_table(self.folder / _INDEX, self.index.combine_chunks())

    @property
    def index(self) -> pa.Table:
        """One row for each motion that is done."""
        if self._index is None:
            parts = [pq.read_table(self._part(k, "index")) for k in range(self.shards) if self.has_shard(k)]
            self._index = pa.concat_tables([index_schema(self.job).empty_table(), *parts])
        return self._index

    def samples(self, index: int) -> pa.Table:
        """Samples of a motion; without rows if it was not kept. Raises InputError if it is not done."""
        self._check(index)
        shard = index // self.job.shard
        if not self.has_shard(shard):
            raise _prowl.InputError(f"{self.folder}: motion {index} is not done yet")
        return pq.read_table(self._part(shard, "motions"), filters=[("index", "=", index)])

    def arrays(self, index: int) -> dict[str, np.ndarray]:
        """Samples of a motion as arrays: t (N), q (N, nq), ...; empty if it was not kept. Raises as samples() does."""
        table = self.samples(index)
        arrays: dict[str, np.ndarray] = {}
        for name in table.column_names:
            column = table[name].combine_chunks()
            is_list = pa.types.is_list(column.type)
            values = column.flatten() if is_list else column
            flat = values.to_numpy(zero_copy_only=False)
            arrays[name] = flat.reshape(table.num_rows, -1) if is_list and table.num_rows else flat
        return arrays

    def task(self, index: int) -> _prowl.Task:
        """The task of a motion, with its drawn values."""
        self._check(index)
        return drawn_task(self.job, index, self.text.package_dirs)

    def robot(self, index: int) -> _prowl.Robot:
        """The robot of a motion; the same object for all motions unless draws change it."""
        draws_robot = any(name.split("[")[0] in ("robot", "payload") for name in self.job.draw_names)
        return self.task(index).robot if draws_robot else self._robot

    @cached_property
    def _robot(self) -> _prowl.Robot:
        return self.base_task().robot

    def base_task(self) -> _prowl.Task:
        """The job's task without draws."""
        return parse_task(self.job.base_task, folder=self.job.task_path.parent, package_dirs=self.text.package_dirs)

    def write(
        self,
        format: str,
        out: str | os.PathLike[str],
        *,
        rate: float | None = None,
        model: str | os.PathLike[str] | None = None,
        on_progress: Callable[[int, int], object] | None = None,
    ) -> list[str]:
        """Writes the motions that are kept for a trainer (docs/trainers.md), and returns the names of the files.

        format: "mjlab", one npz file a motion, or "lerobot", a dataset of version 3. out: an empty or new folder. rate:
        samples per second; None: that of the library. model: MJCF file whose order of bodies and joints mjlab uses;
        None: that of Prowl's own. Raises InputError, FileError.
        """
        with needs("trainers"):
            from .._trainers import lerobot  # noqa: F401  (a package that is missing is told before the first file)
            from .._trainers.write import write_for_trainer
        return write_for_trainer(self, format, out, rate, model, on_progress)

    def write_page(self, file: str | os.PathLike[str]) -> None:
        """Writes a page with outcomes, drawn values and margins: one file, needs no network. Raises InputError for a
        library without motions."""
        from .page import library_page

        if not self.done:
            raise _prowl.InputError(f"{self.folder}: no motion is done yet")
        path = Path(file)
        _prowl.write_files(path.parent, {path.name: library_page(self).encode()})

    def plan(self, index: int) -> _prowl.Plan:
        """Plans a motion again, for its report or a simulation. Raises InputError where it would not be the same: with
        other versions, instructions or another robot."""
        self._check(index)
        if why := why_other(self.text):
            raise _prowl.InputError(f"{self.folder}: this machine {why}: the motion would not be the same")
        return solve(self.task(index), refine=refine_of(self.job), progress=False)

    def _check(self, index: int) -> None:
        if not 0 <= index < self.job.count:
            raise _prowl.InputError(f"index: {index} is not allowed; need 0 to {self.job.count - 1}")

    def causes(self) -> dict[str, int]:
        """Failed motions by cause, most frequent first."""
        causes = self.index["cause"].to_pylist()
        return dict(Counter(cause for cause in causes if cause).most_common())

    def grades(self) -> dict[str, int]:
        """Kept motions by grade of their certificate."""
        return dict(Counter(self.kept_rows["grade"].to_pylist()))

    @property
    def done(self) -> int:
        return self.index.num_rows

    @property
    def kept_rows(self) -> pa.Table:
        """Rows of the index with the motions that are kept."""
        return self.index.filter(self.index["kept"])

    @property
    def kept(self) -> int:
        return self.kept_rows.num_rows

    def sha256(self) -> str:
        """Of all files but library.json, which names paths of this machine: equal libraries have equal hashes."""
        total = hashlib.sha256()
        for path in sorted(self.folder.rglob("*")):
            parts = path.relative_to(self.folder).parts
            if not path.is_file() or path.name == _ABOUT or any(part.startswith(".") for part in parts):
                continue
            with path.open("rb") as file:
                content = hashlib.file_digest(file, "sha256").hexdigest()
            total.update(f"{path.relative_to(self.folder).as_posix()} {content}\n".encode())
        return total.hexdigest()

    def __repr__(self) -> str:
        return f"<prowl.Library {self.folder}: {self.kept} of {self.done} motions kept, {self.count} asked>"
