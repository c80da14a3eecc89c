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
from peers.clock import Clock
from peers.peer_solvers import PeerSetup, solve
from peers.prowl_command import ProwlCommand, ProwlError

JUDGING = 60.0  # CPU time that building the problem and judging its motion may take besides the solve [s]
RULES = {"euler": "Euler", "semi-implicit": "semi-implicit Euler", "rk2": "RK2", "rk4": "RK4"}


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


def _timed(seconds: list[float], guess: float, setup: float) -> dict:
    """CPU times: of the solver, and with what comes before it."""
    median = statistics.median(seconds)
    return {
        "repetitions": len(seconds),
        "seconds": median,
        "seconds_min": min(seconds),
        "seconds_max": max(seconds),
        "guess_seconds": guess,
        "whole_seconds": median + guess + setup,
    }


def label(setup: PeerSetup) -> str:
    return f"{setup.peer.label}, {RULES[setup.rule]}"


def peer_record(kind: str, task: MotionTask, setup: PeerSetup, clock: Clock = Clock()) -> dict:
    """Without bounds on the joints; with them where the motion would break them, since they cost iterations."""
    for tried in (setup, setup.with_joint_bounds()):
        run = solve(tried, task, clock)
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
        "solver": setup.solver,
        "rule": setup.rule,
        "label": label(setup),
        "step_s": setup.step,
        "intervals": run.nodes - 1,
        "iterations": run.iterations,
        "converged": run.converged,
        "joint_bounds": tried.joint_bounds,
        **_timed(run.seconds, run.guess_seconds, run.setup_seconds),
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


def measure_peer(kind: str, task: MotionTask, setup: PeerSetup, clock: Clock) -> dict:
    try:
        return in_own_process(
            lambda: peer_record(kind, task, setup, clock), 2 * (clock.time_limit + clock.patience) + JUDGING
        )
    except NoResult as why:
        return failure(kind, task.name, setup.solver, label(setup), str(why), rule=setup.rule, step_s=setup.step)


def measure_prowl(
    kind: str, command: ProwlCommand, task: MotionTask, task_file: pathlib.Path, clock: Clock, options: list[str]
) -> dict:
    try:
        run = command.plan(task_file, clock, options)
    except ProwlError as error:
        return failure(kind, task.name, "prowl", "Prowl", str(error))
    verdict = judge(task.with_durations(run.durations), run.motion)
    return {
        "kind": kind,
        "task": task.name,
        "solver": "prowl",
        "rule": "corrected trapezoid",
        "label": "Prowl",
        "intervals": run.levels[-1]["intervals"],
        "iterations": sum(level["iterations"] for level in run.levels),
        "iterations_by_mesh": [level["iterations"] for level in run.levels],
        "converged": run.converged,
        "split_s": run.split,
        **_timed(run.seconds, run.guess_seconds, 0.0),
        "whole_seconds": float(np.median(run.process_seconds)),
        **judged(verdict),
        "grade": run.grade,
        "certificate_reintegration": run.reintegration,
    }
