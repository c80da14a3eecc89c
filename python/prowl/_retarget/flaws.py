"""What no motion of the robot can have: flaws of a reference, and limits that a plan keeps."""

from __future__ import annotations

import numpy as np

from .. import _prowl
from .reference import Reference
from .stances import GRAVITY, Feet, runs

_SLIDE = 0.01  #: [m] that a foot on the ground may move: its place is the mean
_ANGLE = 0.01  #: [rad] beyond a range
_NEAR = 0.98  #: of a limit: the plan keeps it there
_LEAST_LOAD = 0.2  #: of the even load, that each foot carries at least: the default of tasks


def _when(t: np.ndarray, beyond: np.ndarray) -> str:
    times = t[beyond]
    return f"at {times[0]:.2f} s" if times[-1] - times[0] < 0.005 else f"from {times[0]:.2f} to {times[-1]:.2f} s"


def flaws_of(robot: _prowl.Robot, reference: Reference, feet: Feet) -> list[str]:
    """In words, with place, time, size and limit."""
    told = []
    joints, rates = reference.q[:, 7:], np.abs(reference.velocities()[:, 6:])
    outside = np.maximum(robot.position_lower - joints, joints - robot.position_upper)
    for i, name in enumerate(robot.joint_names):
        if (beyond := outside[:, i] > _ANGLE).any():
            told.append(
                f"{name}: up to {outside[:, i].max():.2f} rad beyond its range "
                f"[{robot.position_lower[i]:g}, {robot.position_upper[i]:g}] {_when(reference.t, beyond)}"
            )
        if (beyond := rates[:, i] > robot.velocity_limit[i]).any():
            told.append(
                f"{name}: up to {rates[:, i].max():.3g} rad/s, the limit is {robot.velocity_limit[i]:.3g}, "
                f"{_when(reference.t, beyond)}"
            )
    for foot, names in enumerate(feet.names):
        for first, after in runs(feet.stands[:, foot]):
            place = feet.place[first:after, foot, :2]
            way = float(np.linalg.norm(place.max(axis=0) - place.min(axis=0)))
            if feet.stands[first, foot] and way > _SLIDE:
                when = f"from {reference.t[first]:.2f} to {reference.t[after - 1]:.2f} s"
                told.append(f"{names[0]}: slides {100 * way:.1f} cm while it stands, {when}")
    return told


def limits_kept(plan: _prowl.Plan, off: np.ndarray, at: np.ndarray) -> list[str]:
    """Limits that the plan reaches at some of these nodes, most frequent first. off: its joints less the reference's."""
    robot = plan.robot
    lower, upper = robot.torque_limits(plan.q, plan.v)
    share = np.maximum(plan.tau / upper, plan.tau / lower)
    reached: dict[str, int] = {}

    def count(name: str, where: np.ndarray) -> None:
        if (times := int(np.count_nonzero(where & at))) > 0:
            reached[name] = times

    for i, joint in enumerate(robot.joint_names):
        range_ = robot.position_upper[i] - robot.position_lower[i]
        inside = np.minimum(plan.q[:, 7 + i] - robot.position_lower[i], robot.position_upper[i] - plan.q[:, 7 + i])
        count(f"torque of {joint}", share[:, i] > _NEAR)
        count(f"velocity of {joint}", np.abs(plan.v[:, 6 + i]) > _NEAR * robot.velocity_limit[i])
        count(f"range of {joint}", (inside < (1 - _NEAR) * range_) & (np.abs(off[:, i]) > _ANGLE))
    friction, weight = plan.task.surfaces[0].friction, robot.mass * GRAVITY
    held = np.array([[name in phase.contacts for name in robot.contact_names] for phase in plan.task.phases])[
        plan.phase
    ]
    even = weight / np.maximum(held.sum(axis=1), 1)
    for c, contact in enumerate(robot.contact_names):
        force = plan.f[:, c]
        count(f"load of {contact}", held[:, c] & (force[:, 2] < _LEAST_LOAD * even / _NEAR))
        slips = np.linalg.norm(force[:, :2], axis=1) > _NEAR * friction * force[:, 2]
        count(f"friction of {contact}", held[:, c] & (force[:, 2] > 1e-3 * weight) & slips)
    return sorted(reached, key=lambda name: -reached[name])
