"""What a Dask worker does: motions of one block."""

from __future__ import annotations

import atexit
import functools
import socket
from dataclasses import dataclass

import pyarrow as pa

from .. import _prowl
from .job import files_sha256
from .motion import Motion, plan_motion
from .tables import index_table, samples_table, to_bytes


@dataclass(frozen=True)
class JobText:
    """A job and its task as the client read them: workers may have no such files, but need those of the robot."""

    job: str
    job_path: str
    task: str
    task_path: str
    files_sha256: str  #: of robot files, URDFs and references, which workers read themselves
    versions: tuple[tuple[str, str], ...]  #: of Prowl, its libraries and their instruction set
    package_dirs: tuple[str, ...] = ()


@dataclass(frozen=True)
class Block:
    """Results of the motions first ... first + count - 1."""

    first: int
    count: int
    unfinished: tuple[int, ...]  #: took longer than the job allows; in no table
    index: bytes
    samples: bytes


def block_of(job: _prowl.Job, first: int, motions: list[Motion]) -> Block:
    """Of these motions, in order from `first`."""
    unfinished = tuple(first + i for i, motion in enumerate(motions) if motion.row is None)
    index = index_table(job, [motion for motion in motions if motion.row is not None])
    samples = samples_table(motions, first, job.gains)
    return Block(first, len(motions), unfinished, to_bytes(index), to_bytes(samples))


@functools.lru_cache(maxsize=4)
def _job(text: JobText) -> _prowl.Job:
    return _prowl.job_of(text.job, text.job_path, text.task, text.task_path)


atexit.register(_job.cache_clear)  # a job is of the compiled module, which ends before this one


def own_versions() -> tuple[tuple[str, str], ...]:
    return tuple(sorted({**_prowl.versions(), "Arrow": pa.__version__}.items()))


def why_other(text: JobText) -> str:
    """Why this process would not make the same bytes; "" if it would."""
    own, needed = dict(own_versions()), dict(text.versions)
    names = sorted(name for name in own.keys() | needed.keys() if own.get(name) != needed.get(name))
    if names:
        return "has " + "; ".join(f"{name} {own.get(name)}, not {needed.get(name)}" for name in names)
    return (
        ""
        if files_sha256(_job(text), text.package_dirs) == text.files_sha256
        else "has another robot file, URDF or reference"
    )


why_other_once = functools.lru_cache(maxsize=4)(why_other)  #: once a job


def plan_block(text: JobText, first: int, count: int) -> Block:
    """Raises Error on a machine that would not make the same bytes, and names it."""
    if why := why_other_once(text):
        raise _prowl.Error(f"the worker on {socket.gethostname()} {why}; need the same as where the library began")
    job = _job(text)
    return block_of(job, first, [plan_motion(job, index, text.package_dirs) for index in range(first, first + count)])
