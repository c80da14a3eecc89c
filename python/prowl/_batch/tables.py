"""Tables of a library: one row for each motion in the index, one for each sample in the shards."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from .. import _prowl
from .motion import Motion

_CHECK = pa.struct([("name", pa.string()), ("worst", pa.float64()), ("limit", pa.float64()), ("unit", pa.string())])


def _draw_type(value: float | bool | str) -> pa.DataType:
    return pa.bool_() if isinstance(value, bool) else pa.float64() if isinstance(value, float) else pa.string()


def index_schema(job: _prowl.Job) -> pa.Schema:
    """Columns that no motion has are null: those of a task that Prowl refuses, say."""
    drawn = [(name, _draw_type(value)) for name, value in zip(job.draw_names, job.values(0))]
    columns = pa.schema(
        [
            ("index", pa.int64()),
            ("kept", pa.bool_()),
            ("cause", pa.string()),
            ("grade", pa.string()),
            ("status", pa.string()),
            ("cost", pa.float64()),
            ("duration", pa.float64()),
            ("iterations", pa.int32()),
            ("nodes", pa.int32()),
            ("simulated", pa.bool_()),
            ("succeeded", pa.bool_()),
            ("checks", pa.list_(_CHECK)),
            ("diagnosis", pa.string()),
            ("task_sha256", pa.string()),
        ]
    )
    for name, _ in drawn:
        if name in columns.names:
            raise _prowl.InputError(f'draw: "{name}" is a column of the index; put another key first')
    return pa.schema([*columns, *(pa.field(name, kind) for name, kind in drawn)])


def index_table(job: _prowl.Job, motions: Iterable[Motion]) -> pa.Table:
    """One row for each motion, in this order."""
    rows: list[dict[str, Any]] = []
    for motion in motions:
        assert motion.row is not None
        row = dict(motion.row)
        draws = row.pop("draws")
        rows.append(row | dict(zip(job.draw_names, draws)))
    return pa.Table.from_pylist(rows, schema=index_schema(job))


def samples_schema(gains: bool) -> pa.Schema:
    numbers = pa.list_(pa.float64())
    columns = [
        ("index", pa.int64()),
        ("t", pa.float64()),
        ("phase", pa.int32()),
        ("q", numbers),
        ("v", numbers),
        ("a", numbers),
        ("tau", numbers),
        ("f", numbers),
        ("in_contact", pa.list_(pa.bool_())),
    ]
    return pa.schema(columns + [("gains", numbers)] * gains)


def _lists(values: np.ndarray) -> pa.Array:
    """One list for each row of an array."""
    flat = np.ascontiguousarray(values).reshape(len(values), -1)
    offsets = np.arange(len(flat) + 1, dtype=np.int32) * flat.shape[1]
    return pa.ListArray.from_arrays(pa.array(offsets), pa.array(flat.ravel()))


def _samples_of(index: int, motion: Motion, gains: bool) -> pa.Table:
    samples = motion.samples
    assert samples is not None
    of_motion = samples.motion
    count = len(of_motion.t)
    columns = [
        pa.array(np.full(count, index, dtype=np.int64)),
        pa.array(of_motion.t),
        pa.array(np.asarray(of_motion.phase, dtype=np.int32)),
        *(_lists(values) for values in (of_motion.q, of_motion.v, of_motion.a, of_motion.tau, of_motion.f)),
        _lists(np.asarray(samples.in_contact, dtype=bool)),
    ]
    if gains:
        columns.append(_lists(samples.gains))
    return pa.table(columns, schema=samples_schema(gains))


def samples_table(motions: Sequence[Motion], first: int, gains: bool) -> pa.Table:
    """Samples of the motions that are kept; their indices count from `first`."""
    tables = [_samples_of(first + i, motion, gains) for i, motion in enumerate(motions) if motion.samples is not None]
    return pa.concat_tables([samples_schema(gains).empty_table(), *tables])


def to_bytes(table: pa.Table) -> bytes:
    """For the way from a worker to the client."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema) as writer:
        writer.write_table(table)
    return sink.getvalue().to_pybytes()


def from_bytes(content: bytes) -> pa.Table:
    with pa.ipc.open_stream(content) as reader:
        return reader.read_all()
