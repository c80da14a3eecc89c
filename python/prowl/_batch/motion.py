"""One motion of a job: planned, checked, simulated. It depends on the job and its index alone."""

from __future__ import annotations

import hashlib
import os
import time
import warnings
from dataclasses import dataclass
from typing import Any

from .. import _prowl
from .._exports.samples import Samples, sample_plan
from .._runs.solve import solve
from .job import drawn_task, refine_of


@dataclass(frozen=True)
class Motion:
    row: dict[str, Any] | None  #: of the index; None for a motion that took too long
    samples: Samples | None  #: of a motion that is kept


def _failed(row: dict[str, Any], cause: str, diagnosis: str) -> Motion:
    return Motion(row | {"kept": False, "cause": cause, "diagnosis": diagnosis}, None)


def _cause(plan: _prowl.Plan, asked: str) -> tuple[str, str]:
    """Why a plan is not kept, and what Prowl says about it; empty if it is."""
    certificate = plan.certificate
    if plan.status != "converged":
        return plan.status, "\n".join([*plan.reasons, *plan.hints]) or plan.message
    if certificate.grade == "certified" or certificate.grade == asked:
        return "", ""
    beyond = [
        check
        for check in certificate.checks
        if check.worst > (check.limit if asked == "draft" else check.certified_limit)
    ]
    told = "\n".join(
        f"{check.name} {check.where}: {check.worst:.3g} {check.unit} at {check.time:.3g} s" for check in beyond
    )
    return f"certificate: {beyond[0].name}" if beyond else "certificate", told


def plan_motion(job: _prowl.Job, index: int, package_dirs: tuple[str, ...] = ()) -> Motion:
    """Plans, certifies and, if the job says so, simulates motion `index`."""
    text = job.task_text(index)
    row = {"index": index, "task_sha256": hashlib.sha256(text.encode()).hexdigest(), "draws": job.values(index)}
    try:
        return _planned(job, index, row, package_dirs)
    except _prowl.InputError as error:
        return _failed(row, "input", str(error).replace(f"{job.task_path.parent}{os.sep}", ""))
    except _prowl.NumericalError as error:
        return _failed(row, "numerical", str(error))


def _planned(job: _prowl.Job, index: int, row: dict[str, Any], package_dirs: tuple[str, ...]) -> Motion:
    start = time.monotonic()
    task = drawn_task(job, index, package_dirs)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # no gains: told below
        plan = solve(task, refine=refine_of(job), gains=job.gains or job.simulation, progress=False)
    if time.monotonic() - start > job.hang_seconds or plan.status in ("time_limit", "interrupted"):
        return Motion(None, None)
    row |= {
        "status": plan.status,
        "grade": plan.certificate.grade,
        "cost": plan.cost,
        "iterations": plan.iterations,
        "duration": plan.duration,
        "nodes": len(plan),
        "checks": [
            {"name": check.name, "worst": check.worst, "limit": check.limit, "unit": check.unit}
            for check in plan.certificate.checks
        ],
    }
    cause, diagnosis = _cause(plan, job.grade)
    if cause:
        return _failed(row, cause, diagnosis)
    if (job.gains or job.simulation) and plan.tracker is None:
        return _failed(row, "no gains", plan.message)
    if job.simulation:
        simulation = _prowl.simulate(plan, seed=job.seed + index)
        row |= {"simulated": True, "succeeded": simulation.success}
        if not simulation.success:
            return _failed(row, "simulation", repr(simulation))
    return Motion(row | {"kept": True, "cause": "", "diagnosis": ""}, sample_plan(plan, job.rate))
