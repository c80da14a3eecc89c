"""retarget()."""

from __future__ import annotations

import os
import re
import tempfile
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import _prowl
from .._documents import toml_text
from .._files import parse_task, read_robot
from .._runs.solve import solve
from .flaws import flaws_of, limits_kept
from .reference import Reference, read_reference
from .stances import find_feet, spans
from .task import task_of

FOLLOWED = 0.1  #: [rad] root mean square of the joints' deviations, at which a reference counts as followed
_STEP = 1.1  #: between two tries of a longer time
_TOLD = {"joint": 0.1, "base": 0.03}  #: [rad, m] deviations from here on are told


@dataclass(frozen=True)
class Deviation:
    """How far a plan is from its reference."""

    name: str  #: a joint, or "base"
    rms: float  #: root mean square over time [rad, m]
    largest: float
    time: float  #: of the largest [s]
    start: float  #: first and last time with a deviation that is told [s]
    end: float
    limits: tuple[str, ...]  #: that the plan reaches there, or else elsewhere, most frequent first


@dataclass(frozen=True)
class Retargeted:
    """Result of retarget()."""

    plan: _prowl.Plan
    task: str  #: text of its task file
    time_scale: float  #: duration of the plan over that of the reference
    joint_rms: float  #: root mean square of the deviations of all joints over time [rad]; inf without a plan
    deviations: tuple[Deviation, ...]  #: of joints by more than 0.1 rad and the base by more than 3 cm, largest first
    flaws: tuple[str, ...]  #: of the reference: what no motion of this robot can have
    reasons: tuple[str, ...]  #: why it is not followed; empty if it is

    @property
    def followed(self) -> bool:
        """True if the plan is good and its joints deviate by at most 0.1 rad (root mean square)."""
        return self.plan.good and self.joint_rms <= FOLLOWED

    def summary(self) -> str:
        """What a person wants to know, in lines."""
        plan, lines = self.plan, []
        if self.followed:
            lines.append(f"followed: joints within {self.joint_rms:.3f} rad (root mean square)")
        else:
            lines.append("not followed:")
            lines += [f"  {reason}" for reason in self.reasons]
        if self.time_scale != 1.0:
            lines.append(f"in {self.time_scale:.2f} times the time of the reference")
        for one in self.deviations:
            unit = "m" if one.name == "base" else "rad"
            at = f"; at their limits: {', '.join(one.limits[:3])}" if one.limits else ""
            lines.append(
                f"  {one.name}: off by up to {one.largest:.2f} {unit} from {one.start:.2f} to {one.end:.2f} s{at}"
            )
        if self.flaws:
            lines.append("the reference has what this robot cannot do:")
            lines += [f"  {flaw}" for flaw in self.flaws]
        lines.append(f"plan: {plan.status}, certificate: {plan.certificate.grade}, {plan.duration:.2f} s")
        return "\n".join(lines) + "\n"


def _deviations(plan: _prowl.Plan, reference: Reference) -> tuple[float, tuple[Deviation, ...]]:
    off = _prowl.difference(reference.at(plan.t), plan.q)
    weights = np.gradient(plan.t) if len(plan.t) > 1 else np.ones(1)
    weights = np.maximum(weights, 0.0) / max(float(np.maximum(weights, 0.0).sum()), 1e-12)
    joints = off[:, 6:]
    rms = float(np.sqrt((weights @ joints**2).mean()))
    named = [(name, np.abs(joints[:, i]), _TOLD["joint"]) for i, name in enumerate(plan.robot.joint_names)]
    named.append(("base", np.linalg.norm(off[:, :3], axis=1), _TOLD["base"]))
    told = []
    for name, size, least in named:
        far = size > least
        if far.any():
            worst = int(size.argmax())
            told.append(
                Deviation(
                    name,
                    float(np.sqrt(weights @ size**2)),
                    float(size[worst]),
                    float(plan.t[worst]),
                    float(plan.t[far][0]),
                    float(plan.t[far][-1]),
                    tuple(limits_kept(plan, joints, far) or limits_kept(plan, joints, np.ones_like(far))),
                )
            )
    return rms, tuple(sorted(told, key=lambda one: -one.largest))


def _why(plan: _prowl.Plan, rms: float, deviations: Sequence[Deviation], flaws: Sequence[str]) -> list[str]:
    if plan.status != "converged":
        return [*flaws, f"no plan: {plan.status}", *plan.reasons, *plan.hints]
    if not plan.good:
        failed = [check for check in plan.certificate.checks if not check.passed]
        return [*flaws, *(f"certificate: {check.name} {check.where} at {check.time:.2f} s" for check in failed)]
    if rms > FOLLOWED:
        limits = list(dict.fromkeys(limit for one in deviations for limit in one.limits[:2]))
        at = f"; at their limits: {', '.join(limits[:4])}" if limits else ""
        return [*flaws, f"joints are {rms:.2f} rad off (root mean square), more than {FOLLOWED:g}{at}"]
    return []


def retarget(
    motion: str | os.PathLike[str],
    robot: _prowl.Robot | str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    fps: float | None = None,
    slowest: float = 1.0,
    friction: float = 0.6,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
) -> Retargeted:
    """A plan with torques that follows a reference of base and joints (docs/retarget.md).

    motion: a CSV file with the columns of a plan's trajectory, one without names (x y z qx qy qz qw joints; needs
    `fps`), or an npz file of mjlab, whole_body_tracking or prowl export. robot: a Robot, robot file or shipped name.
    out: folder for task.toml, reference.csv and the folder `plan`. slowest: longest duration to try, as a
    multiple of the reference's, if its own fails. friction: of the ground, z = 0.

    The feet that are low and slow stand; between them they swing. Raises InputError, with row and column, if the file holds
    no valid motion. Whether the reference is followed, and why not, is in the result.
    """
    if not 1.0 <= slowest < np.inf:
        raise _prowl.InputError(f"slowest: {slowest:g} is not allowed; need 1 or more")
    model = robot if isinstance(robot, _prowl.Robot) else read_robot(robot, package_dirs=package_dirs)
    reference = read_reference(motion, model, fps)
    feet = find_feet(model, reference, motion)
    reference = reference.lower(feet.ground)  # files are millimetres to centimetres off
    flaws = flaws_of(model, reference, feet)
    scale, best = 1.0, None
    while best is None or (not best.followed and scale < slowest):
        scale = 1.0 if best is None else min(scale * _STEP, slowest)
        tried = _tried(model, reference.slower(scale), motion, scale, flaws, friction, package_dirs)
        if best is None or tried.followed:
            best = tried
    if out is not None:
        _write(best, reference.slower(best.time_scale), Path(out))
    return best


def _tried(
    robot: _prowl.Robot,
    reference: Reference,
    source: object,
    scale: float,
    flaws: list[str],
    friction: float,
    package_dirs: Sequence[str | os.PathLike[str]],
) -> Retargeted:
    feet = find_feet(robot, reference, source)
    task = task_of(robot, reference, feet, spans(feet, reference.t), friction, "reference.csv")
    text = toml_text({**task, "robot": os.fspath(robot.path)})
    with tempfile.TemporaryDirectory(prefix="prowl_") as folder:  # the task keeps the text of its reference
        Path(folder, "reference.csv").write_text(reference.csv(robot), encoding="utf-8")
        try:
            parsed = parse_task(task, folder=folder, package_dirs=package_dirs)
        except _prowl.InputError as error:
            told = "; ".join([re.sub(rf"{re.escape(folder)}/task.toml(:\d+)*: ", "", str(error)), *flaws])
            raise _prowl.InputError(f"{source}: it makes no task of {robot.name}: {told}") from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # no gains: the plan says so
        plan = solve(parsed, progress=False)
    rms, deviations = _deviations(plan, reference) if plan.status == "converged" else (np.inf, ())
    reasons = _why(plan, rms, deviations, flaws)
    return Retargeted(plan, text, scale, rms, deviations, tuple(flaws), tuple(reasons))


def _write(result: Retargeted, reference: Reference, folder: Path) -> None:
    files = {"reference.csv": reference.csv(result.plan.robot), "task.toml": result.task}
    _prowl.write_files(folder, {name: text.encode() for name, text in files.items()})
    result.plan.write(folder / "plan")
