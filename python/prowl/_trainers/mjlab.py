"""The npz files of mjlab and whole_body_tracking: one for each motion."""

from __future__ import annotations

import io

import numpy as np

from .. import _prowl
from .bodies import Order, body_motion


def motion_arrays(robot: _prowl.Robot, q: np.ndarray, v: np.ndarray, fps: float, order: Order) -> dict[str, np.ndarray]:
    """What their csv_to_npz writes, and the names: positions of links, not of their centres of mass."""
    bodies = body_motion(robot, q, v, order.bodies)
    joints = [robot.joint_names.index(name) for name in order.joints]
    arrays = {
        "joint_pos": q[:, 7:][:, joints],
        "joint_vel": v[:, 6:][:, joints],
        "body_pos_w": bodies.position,
        "body_quat_w": bodies.quaternion,
        "body_lin_vel_w": bodies.linear_velocity,
        "body_ang_vel_w": bodies.angular_velocity,
    }
    return {
        "fps": np.array([round(fps) if fps == round(fps) else fps]),
        **{name: values.astype(np.float32) for name, values in arrays.items()},
        "joint_names": np.array(order.joints),
        "body_names": np.array(order.bodies),
    }


def npz(arrays: dict[str, np.ndarray]) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()
