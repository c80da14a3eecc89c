"""Records: one solver on one task and mesh, timed and judged, as a flat dictionary that is one JSON line."""

import math
import multiprocessing
import pathlib
import resource
import signal
import statistics
from collections.abc import Callable

import numpy as np

from judge.checker import Verdict, judge
from judge.motion_task import MotionTask
from peers.peer_solvers import PEERS, solve
from peers.prowl_command import ProwlCommand, ProwlError


def failure(kind: str, task: str, solver: str, label: str, why: str, **more) -> dict:
    return {"kind": kind, "task": task, "solver": solver, "label": label, "failed": why, **more}


def judged(verdict: Verdict) -> dict:
    name, worst = verdict.worst
    return {
        "error": verdict.error,
        "error_per_second": verdict.error_per_second,
        "cost": verdict.cost,
        "keeps_task": verdict.worst_share <= 1.0,
        "worst": {
            "check": name,
            "value": worst.value,
            "unit": worst.unit,
            "limit": worst.limit,
            "time_s": worst.time,
            "where": worst.where,
        },
        "findings": {name: finding.value for name, finding in verdict.findings.items()},
    }


def _timed(seconds: list[float], motion_seconds: float, node_iterations: int) -> dict:
    median = statistics.median(seconds)
    return {
        "repetitions": len(seconds),
        "seconds": median,
        "seconds_min": min(seconds),
        "seconds_max": max(seconds),
        "us_per_node_iteration": 1e6 * median / max(1, node_iterations),
        "ratio_to_motion": median / motion_seconds,
    }


def peer_record(
    kind: str,
    task: MotionTask,
    solver: str,
    step: float,
    repetitions: int = 1,
    patience: float = 0.0,
    time_limit: float = math.inf,
    anchored: bool = False,
) -> dict:
    """Without bounds on the joints; with them where the motion would break them, since they cost iterations. `time_limit`: of each
    solve, after which its last iterate is judged."""
    for bounds in (False, True):
        run = solve(solver, task, step, bounds, repetitions, patience, time_limit, anchored)
        verdict = judge(task, run.motion)
        broken = [
            name
            for name in ("joint position", "joint velocity")
            if verdict.findings[name].value > verdict.findings[name].limit
        ]
        if not broken:
            break
    return {
        "kind": kind,
        "task": task.name,
        "solver": solver,
        "label": PEERS[solver].label,
        "step_s": step,
        "intervals": run.nodes - 1,
        "nodes": run.nodes,
        "iterations": run.iterations,
        "converged": run.converged,
        "joint_bounds": bounds,
        "clock": "cpu",
        **_timed(run.seconds, task.duration, run.iterations * run.nodes),
        **judged(verdict),
    }


class NoResult(RuntimeError):
    """A process that took too long, or stopped without a word."""


def in_own_process(work: Callable[[], dict], seconds: float) -> dict:
    """A crash or a solver without an end takes that process with it, and not the rest. It gets so many seconds of CPU time."""
    context = multiprocessing.get_context("fork")
    receiver, sender = context.Pipe(duplex=False)

    def run() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(seconds), resource.RLIM_INFINITY))
        sender.send(work())

    process = context.Process(target=run)
    process.start()
    sender.close()
    try:
        found = receiver.recv()
    except EOFError:
        process.join()
        raise NoResult("time limit" if process.exitcode == -signal.SIGXCPU else "stopped without a result") from None
    process.join()
    return found


def measure_peer(
    kind: str, task: MotionTask, solver: str, step: float, repetitions: int, patience: float, time_limit: float
) -> dict:
    try:
        return in_own_process(
            lambda: peer_record(kind, task, solver, step, repetitions, patience), 2 * time_limit + 2 * patience
        )
    except NoResult as why:
        return failure(kind, task.name, solver, PEERS[solver].label, str(why), step_s=step)


def measure_prowl(
    kind: str,
    command: ProwlCommand,
    task: MotionTask,
    task_file: pathlib.Path,
    solver: str,
    intervals: int | None = None,
    one_mesh: bool = False,
    repetitions: int = 1,
    patience: float = 0.0,
    threads: int = 1,
    cores: frozenset[int] = frozenset(),
) -> dict:
    """`one_mesh`: iterations and time of the task's own mesh alone: from the task if the command can, else after coarser ones."""
    label = f"Prowl {solver}"
    try:
        run = command.plan(
            task_file, solver, intervals, one_mesh and command.has_one_mesh, repetitions, patience, threads, cores
        )
    except ProwlError as error:
        return failure(kind, task.name, solver, label, str(error), intervals=intervals)
    phases = len(run.durations)
    levels = run.levels[-1:] if one_mesh else run.levels
    seconds = run.last_seconds if one_mesh and len(run.levels) > 1 else run.seconds
    node_iterations = sum(level["iterations"] * (level["intervals"] + phases) for level in levels)
    verdict = judge(task.with_durations(run.durations), run.motion)
    return {
        "kind": kind,
        "task": task.name,
        "solver": solver,
        "label": label,
        "intervals": run.levels[-1]["intervals"],
        "nodes": len(run.motion.time),
        "iterations": sum(level["iterations"] for level in levels),
        "iterations_by_mesh": [level["iterations"] for level in run.levels],
        "after_coarser_meshes": len(run.levels) > 1,
        "converged": run.converged,
        "clock": run.clock,
        "split_s": run.split,
        **_timed(seconds, float(np.sum(run.durations)), node_iterations),
        **judged(verdict),
        "threads": threads,
        "wall_seconds": statistics.median(run.wall_seconds),
        "wall_seconds_min": min(run.wall_seconds),
        "wall_seconds_max": max(run.wall_seconds),
        "grade": run.grade,
        "certificate_reintegration": run.reintegration,
    }
