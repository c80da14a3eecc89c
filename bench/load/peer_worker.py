"""The peers' side of scripts/load, in their environment: `python -m load.peer_worker`.

Each line of stdin is a task with Prowl's motion of it, each line of stdout what the judge found of that and of the peers' motions,
in JSON. Every solve is in a process of its own. A solver is `sqp`, on the mesh of the task, or `sqp:0.01`, with steps of 10 ms.
"""

import json
import os
import pathlib
import sys

import numpy as np

from judge.checker import judge
from judge.motion import Motion
from judge.motion_task import MotionTask, parse_task
from peers.clock import Clock
from peers.measure import JUDGING, NoResult, in_own_process, judged, measure_peer
from peers.peer_solvers import PeerSetup


def motion_of(columns: dict) -> Motion:
    """From the arrays of a prowl.Plan."""
    return Motion(*(np.array(columns[name]) for name in ("t", "phase", "q", "v", "tau")), torque="linear")


def task_of(job: dict) -> MotionTask:
    return parse_task(
        job["document"],
        pathlib.Path(job["folder"]),
        [pathlib.Path(path) for path in job["packages"]],
        f"task {job['number']}",
    )


def ask_peer(task: MotionTask, solver: str, time_limit: float) -> dict:
    name, _, step = solver.partition(":")
    setup = PeerSetup(name, float(step) if step else task.duration / task.intervals)
    return measure_peer("load", task, setup, Clock(time_limit=time_limit))


def judge_prowl(task: MotionTask, motion: Motion) -> dict:
    try:
        return in_own_process(lambda: judged(judge(task, motion)), JUDGING)
    except NoResult as why:
        return {"failed": f"judge: {why}"}


def answer(job: dict) -> dict:
    task = task_of(job)
    found = {"prowl": judge_prowl(task, motion_of(job["motion"]))} if job["motion"] else {}
    return found | {solver: ask_peer(task, solver, job["time_limit"]) for solver in job["solvers"]}


def main() -> None:
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # whatever a library prints is no answer
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), file=answers, flush=True)


if __name__ == "__main__":
    main()
