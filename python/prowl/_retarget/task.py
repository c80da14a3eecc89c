"""The task of a reference: start, phases, costs."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _prowl
from .reference import Reference
from .stances import Feet, Span, runs

_REST = 0.02  #: [m/s, rad/s] of the base: slower is at rest
_CLEARANCE = 0.05  #: of the standing height, Prowl's default
_SWING_SHARE = 0.5  #: of the reference's height, that the parabola of Prowl's clearance stays below smooth swings
_BASE_SHARE = 0.1  #: of a joint's radian for a metre of the base: joints move first


def _onto_ground(robot: _prowl.Robot, q: np.ndarray, names: list[str]) -> np.ndarray:
    """The posture with these contacts on the ground, by small changes of joints within their ranges and of the base's
    height; as near as that gets."""
    q = q.copy()
    q[7:] = np.clip(q[7:], robot.position_lower, robot.position_upper)
    if not names:
        return q
    dynamics = _prowl.Dynamics(robot, names)
    radius = np.array([contact.radius for contact in robot.contacts if contact.name in names])
    for _ in range(50):
        below = radius - dynamics.contact_positions(q)[:, 2]
        if np.abs(below).max() < 1e-9:
            break
        jacobian = dynamics.contact_jacobian(q)[:, 2]
        stuck = (q[7:] <= robot.position_lower) | (q[7:] >= robot.position_upper)
        slopes = np.column_stack([np.full(len(names), _BASE_SHARE), np.where(stuck, 0.0, jacobian[:, 6:])])
        change = np.linalg.lstsq(slopes, below, rcond=None)[0]
        q[2] += _BASE_SHARE * change[0]
        q[7:] = np.clip(q[7:] + change[1:], robot.position_lower, robot.position_upper)
    return q


def _rpy(quaternion: np.ndarray) -> list[float]:
    """R = Rz(yaw) Ry(pitch) Rx(roll)."""
    x, y, z, w = quaternion
    return [
        float(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))),
        float(np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0))),
        float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))),
    ]


def _start(robot: _prowl.Robot, reference: Reference, v: np.ndarray, names: list[str]) -> dict[str, Any]:
    q = _onto_ground(robot, reference.q[0], names)
    start: dict[str, Any] = {
        "base_position_m": q[:3],
        "base_rpy_rad": _rpy(q[3:7]),
        "joints": dict(zip(robot.joint_names, q[7:])),
    }
    if np.abs(v[0, :6]).max() > _REST:
        start |= {"base_linear_velocity_mps": v[0, :3], "base_angular_velocity_radps": v[0, 3:6]}
    return start


def _clearance(robot: _prowl.Robot, feet: Feet) -> float:
    """Half the lowest swing of the reference, at most the default."""
    least = _CLEARANCE * float(robot.nominal_configuration[2])
    for foot in range(feet.stands.shape[1]):
        for first, after in runs(feet.stands[:, foot])[1:-1]:
            if not feet.stands[first, foot]:
                least = min(least, _SWING_SHARE * max(0.0, float(feet.place[first:after, foot, 2].max())))
    return least


def task_of(
    robot: _prowl.Robot, reference: Reference, feet: Feet, spans: list[Span], friction: float, file: str
) -> dict[str, Any]:
    """A dict for parse_task(). The weights are those at which a centimetre or a degree weighs more than smoothness."""
    v = reference.velocities()
    phases = []
    for number, span in enumerate(spans):
        contacts = [name for names, stands in zip(feet.names, span.stands) if stands for name in names]
        duration = float(reference.t[span.last] - reference.t[span.first])
        phases.append({"name": f"phase {number + 1}", "contacts": contacts, "duration_s": duration})
    task: dict[str, Any] = {
        "name": "retargeted",
        "robot": robot,
        "swing_clearance_m": _clearance(robot, feet),
        "surface": [{"name": "floor", "friction": friction}],
        "start": _start(robot, reference, v, phases[0]["contacts"]),
        "phase": phases,
        "reference": {
            "file": file,
            "base_position": 200.0,
            "base_orientation": 50.0,
            "joint_position": 50.0,
        },
        "cost": {
            "base_linear_acceleration": 0.02,
            "base_angular_acceleration": 0.02,
            "joint_acceleration": 2e-4,
            "torque": 0.05 / robot.mass**2,
        },
    }
    if np.abs(v[-1, :6]).max() <= _REST and len(phases[-1]["contacts"]) >= 3:
        task["goal"] = [{"base_linear_velocity_mps": [0, 0, 0], "base_angular_velocity_radps": [0, 0, 0]}]
    return task
