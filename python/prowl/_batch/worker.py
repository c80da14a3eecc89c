"""What a Dask worker does: motions of one block."""

from __future__ import annotations

import functools
from dataclasses import dataclass

from .. import _prowl
from .motion import plan_motion
from .tables import index_table, samples_table, to_bytes


@dataclass(frozen=True)
class JobText:
    """A job and its task as the client read them: workers may have no such files."""

    job: str
    job_path: str
    task: str
    task_path: str
    instruction_set: str
    package_dirs: tuple[str, ...] = ()


@dataclass(frozen=True)
class Block:
    """Results of the motions first ... first + count - 1."""

    first: int
    count: int
    unfinished: tuple[int, ...]  #: took longer than the job allows; in no table
    index: bytes
    samples: bytes


@functools.lru_cache(maxsize=4)
def _job(text: JobText) -> _prowl.Job:
    return _prowl.job_of(text.job, text.job_path, text.task, text.task_path)


def plan_block(text: JobText, first: int, count: int) -> Block:
    """Raises RuntimeError on a machine that computes with other instructions: its last digits may differ."""
    own = _prowl.versions()["vector instructions"]
    if own != text.instruction_set:
        import socket

        raise RuntimeError(
            f"worker on {socket.gethostname()} computes with {own}; this library needs {text.instruction_set}"
        )
    job = _job(text)
    motions = [plan_motion(job, index, text.package_dirs) for index in range(first, first + count)]
    unfinished = tuple(first + i for i, motion in enumerate(motions) if motion.row is None)
    done = [motion for motion in motions if motion.row is not None]
    samples = samples_table(motions, first, job.gains)
    return Block(first, count, unfinished, to_bytes(index_table(job, done)), to_bytes(samples))
