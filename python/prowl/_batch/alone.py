"""One motion in a process of its own, with limited memory: for a motion that lost its worker again and again.

Reads a pickled (JobText, index, bytes) from stdin and writes a pickled Block to stdout; exit status 3 if memory ends.
"""

from __future__ import annotations

import pickle
import resource
import subprocess
import sys

from .. import _prowl
from .._processes import die_with_parent
from .motion import Motion
from .worker import Block, JobText, block_of, plan_block, why_other_once

MEMORY = 4 << 30  #: [bytes] of data, without what is reserved only: many times what a worker needs
_OUT_OF_MEMORY = 3


def plan_alone(text: JobText, index: int, job: _prowl.Job) -> Block:
    """The motion is unfinished if it ends its process for another reason than memory."""
    run = subprocess.run(
        [sys.executable, "-c", "import sys, pickle; sys.path[:] = pickle.load(sys.stdin.buffer); "
         "from prowl._batch.alone import main; main()"],
        input=pickle.dumps(sys.path) + pickle.dumps((text, index, MEMORY)),
        stdout=subprocess.PIPE,
        check=False,
    )  # fmt: skip
    if run.returncode == _OUT_OF_MEMORY:
        row = {
            "index": index,
            "task_sha256": "",
            "draws": job.values(index),
            "kept": False,
            "cause": "out of memory",
            "diagnosis": f"needs more than {MEMORY >> 20} MiB",
        }
        return block_of(job, index, [Motion(row, None)])
    if run.returncode != 0:
        return block_of(job, index, [Motion(None, None)])
    return pickle.loads(run.stdout)


def main() -> None:
    die_with_parent()
    text, index, memory = pickle.load(sys.stdin.buffer)
    why_other_once(text)  # reads what is not of the motion
    resource.setrlimit(resource.RLIMIT_DATA, (memory, memory))
    try:
        content = pickle.dumps(plan_block(text, index, 1))
    except MemoryError:
        sys.exit(_OUT_OF_MEMORY)
    sys.stdout.buffer.write(content)
