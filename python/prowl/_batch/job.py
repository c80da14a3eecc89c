"""Jobs: from files, or from dicts with the same keys."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import _prowl
from .._documents import toml_text
from .._files import SHARE, parse_task

AnyJob = str | os.PathLike[str] | Mapping[str, Any]


def read_job(job: AnyJob) -> _prowl.Job:
    """The job, and its task; raises InputError with file, line and column."""
    if isinstance(job, Mapping):
        return _prowl.parse_job(toml_text(job), Path.cwd() / "job.toml", SHARE / "tasks")
    return _prowl.read_job(os.fspath(job), SHARE / "tasks")


_PARTS = 4  #: of the time after which a motion hangs: so no part that Prowl gives to one of its steps ends before it


def drawn_task(job: _prowl.Job, index: int, package_dirs: tuple[str, ...]) -> _prowl.Task:
    """The task of one motion. A time limit of the task would make its result depend on the machine."""
    return parse_task(
        job.task_text(index), folder=job.task_path.parent, package_dirs=package_dirs, max_time=_PARTS * job.hang_seconds
    )


def refine_of(job: _prowl.Job) -> str | None:
    """Grade that the meshes are refined to; that of drafts is the default, of meshes that Prowl chooses."""
    return "certified" if job.grade == "certified" else None


def files_sha256(job: _prowl.Job, package_dirs: tuple[str, ...]) -> str:
    """Of all robot files, URDFs and references of the job, as this machine has them. Raises InputError unless the task is
    right at both ends of every draw."""
    total = hashlib.sha256()
    for content in job.check(list(package_dirs)):
        total.update(hashlib.sha256(content).digest())
    return total.hexdigest()
