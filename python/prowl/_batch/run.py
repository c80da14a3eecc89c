"""batch(): the motions of a job on Dask."""

from __future__ import annotations

import logging
import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import _prowl
from .._extras import needs
from .._runs.bar import batch_bar, run_with_bar
from .job import AnyJob, read_job

if TYPE_CHECKING:
    from .library import Library

_BLOCK = 8  #: motions of one Dask task: a second of work, so that neither its overhead nor what a kill loses matters
_WAITING = 3  #: blocks a worker has ahead


@dataclass
class BatchProgress:
    """State of a job while it runs."""

    total: int  #: motions of the job
    done: int = 0
    kept: int = 0
    causes: dict[str, int] = field(default_factory=dict)  #: failed motions by cause
    unfinished: int = 0  #: took longer than the job allows
    seconds: float = 0.0
    dashboard: str = ""  #: address of Dask's page

    @property
    def rate(self) -> float:
        """Motions per second of this run."""
        return self.done_here / self.seconds if self.seconds > 0 else 0.0

    done_here: int = 0


def _spawn_workers_without_main() -> None:
    """New processes import the script of their parent, unless that is no file: what calls batch() would call it again.
    Dask's workers need nothing of it."""
    from multiprocessing import spawn

    prepared = spawn.get_preparation_data
    if getattr(prepared, "without_main", False):
        return

    def prepare(name: str) -> dict[str, Any]:
        data = prepared(name)
        if not name.startswith("Dask Worker"):
            return data
        return {key: value for key, value in data.items() if not key.startswith("init_main")}

    prepare.without_main = True  # type: ignore[attr-defined]
    spawn.get_preparation_data = prepare


@contextmanager
def _client(workers: int | None, scheduler: str | None, tls: dict[str, str] | None) -> Iterator[Any]:
    """A client of the cluster, or of a new one on this machine with one process a core."""
    import distributed

    if scheduler is not None:
        security = distributed.Security(require_encryption=True, **tls) if tls else None
        try:
            client = distributed.Client(scheduler, security=security, timeout="30s", set_as_default=False)
            client.wait_for_workers(1, timeout=60)
        except (OSError, ValueError, TypeError) as error:  # TypeError: no certificates for tls://
            raise _prowl.InputError(f"scheduler: {scheduler} and a worker of it cannot be reached: {error}") from error
        with client:
            yield client
        return
    import dask

    _spawn_workers_without_main()

    # A task that lost its worker three times is not tried again.
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 2}),
        distributed.LocalCluster(
            n_workers=workers or os.cpu_count() or 1,
            threads_per_worker=1,
            processes=True,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.ERROR,
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as client,
    ):
        yield client


class _Run:
    """Blocks of motions in the order of their indices, a few ahead of the workers, and shards as they get complete."""

    def __init__(self, client: Any, library: Library, tell: Callable[[BatchProgress], object]) -> None:
        self._client, self._library, self._tell = client, library, tell
        self._blocks: dict[int, list[Any]] = {}  # of shards that are not complete
        self._ranges: dict[str, tuple[int, int]] = {}  # of futures: first motion, count
        self._suspects: list[int] = []  # motions that lost their worker again and again
        self._start = time.monotonic()
        self.progress = BatchProgress(library.count, dashboard=client.dashboard_link or "")
        self._count(library.index)
        self.progress.done = library.done

    def _count(self, index: Any) -> None:
        self.progress.kept += sum(index["kept"].to_pylist())
        for cause in filter(None, index["cause"].to_pylist()):
            self.progress.causes[cause] = self.progress.causes.get(cause, 0) + 1

    def _missing(self) -> Iterator[tuple[int, int]]:
        job = self._library.job
        for shard in range(self._library.shards):
            if self._library.has_shard(shard):
                continue
            end = min((shard + 1) * job.shard, job.count)
            for first in range(shard * job.shard, end, _BLOCK):
                yield first, min(_BLOCK, end - first)

    def _submit(self, first: int, count: int) -> Any:
        from .worker import plan_block

        future = self._client.submit(plan_block, self._library.text, first, count, pure=False, priority=-first)
        self._ranges[future.key] = (first, count)
        return future

    def run(self) -> None:
        """Raises Error if the scheduler dies."""
        from concurrent.futures import CancelledError

        from distributed.comm import CommClosedError

        from .alone import plan_alone

        try:
            self._run_on_workers()
        except (CommClosedError, CancelledError) as error:
            raise _prowl.Error("the scheduler is gone; repeat the command to resume") from error
        for index in self._suspects:  # when all else is done
            self._keep(plan_alone(self._library.text, index, self._library.job))

    def _run_on_workers(self) -> None:
        from distributed import as_completed

        missing = self._missing()
        futures = as_completed(loop=self._client.loop)
        self._tell(self.progress)
        ahead = 0
        while True:
            cores = sum(self._client.nthreads().values()) or 1
            while ahead < _WAITING * cores and (block := next(missing, None)):
                futures.add(self._submit(*block))
                ahead += 1
            if ahead == 0:
                return
            future = next(futures)
            ahead -= 1
            for again in self._take(future):
                futures.add(self._submit(*again))
                ahead += 1

    def _take(self, future: Any) -> list[tuple[int, int]]:
        """Keeps what a future has; returns what has to be done again."""
        from distributed.scheduler import KilledWorker

        first, count = self._ranges.pop(future.key)
        try:
            block = future.result()
        except (KilledWorker, MemoryError):
            if count > 1:
                return [(index, 1) for index in range(first, first + count)]
            self._suspects.append(first)
            return []
        self._keep(block)
        return []

    def _keep(self, block: Any) -> None:
        import pyarrow as pa

        from .tables import from_bytes

        index = from_bytes(block.index)
        self._count(index)
        self.progress.done += index.num_rows
        self.progress.done_here += index.num_rows
        self.progress.unfinished += len(block.unfinished)
        self.progress.seconds = time.monotonic() - self._start
        job = self._library.job
        shard = block.first // job.shard
        blocks = self._blocks.setdefault(shard, [])
        blocks.append(block)
        if sum(one.count for one in blocks) == min(job.shard, job.count - shard * job.shard):
            del self._blocks[shard]
            blocks.sort(key=lambda one: one.first)
            if any(one.unfinished for one in blocks):
                self.progress.done -= sum(from_bytes(one.index).num_rows for one in blocks)
            else:
                # In one piece: the bytes of a file depend on the pieces.
                index, samples = (
                    pa.concat_tables(from_bytes(getattr(one, kind)) for one in blocks).combine_chunks()
                    for kind in ("index", "samples")
                )
                self._library.write_shard(shard, index, samples)
        self._tell(self.progress)


def batch(
    job: AnyJob,
    out: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    tls: dict[str, str] | None = None,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
    progress: bool | None = None,
    on_progress: Callable[[BatchProgress], object] | None = None,
) -> Library:
    """Makes a library of motions: plans, certifies and optionally simulates each motion of a job (docs/batch.md).

    job: the path of a job file, or a dict with its keys. out: folder of the library; an incomplete one is
    resumed. workers: processes on this machine; default one a core. scheduler: address of a running Dask
    scheduler instead, with the certificates of `tls` (tls_ca_file, tls_client_cert, tls_client_key). progress: a bar
    by tqdm; None: in a terminal or notebook. on_progress: called with a BatchProgress after each block of motions.

    The files depend on the job alone, not on workers, their number or order, or on interruptions. A motion that fails
    is a row of the index with its cause. Raises InputError for mistakes in the job, before the first motion.
    """
    with needs("batch"):
        import distributed  # noqa: F401
        import pyarrow  # noqa: F401
    from .job import files_sha256
    from .library import Library
    from .tables import index_schema
    from .worker import JobText, own_versions

    if workers is not None and workers < 1:
        raise _prowl.InputError(f"workers: {workers} is not allowed; need 1 or more")
    asked = read_job(job)
    folders = tuple(os.fspath(Path(folder).absolute()) for folder in package_dirs)
    sha256 = files_sha256(asked, folders)
    index_schema(asked)
    text = JobText(
        job=asked.text,
        job_path=os.fspath(asked.path),
        task=asked.base_task,
        task_path=os.fspath(asked.task_path),
        files_sha256=sha256,
        versions=own_versions(),
        package_dirs=folders,
    )
    library = Library.create(Path(out), text, asked)

    def run(tell: Callable[[BatchProgress], object] | None) -> Library:
        with library.lock(), _client(workers, scheduler, tls) as client:
            try:
                _Run(client, library, tell or (lambda _: None)).run()
            finally:
                library.write_index()
        return library

    return run_with_bar(progress, batch_bar(), run, on_progress)
