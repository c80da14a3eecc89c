"""Text exports. Frames, units and keys: docs/exports.md."""

from __future__ import annotations

import json

import numpy as np

from .. import _prowl
from .._columns import gain_columns, number
from .samples import Samples

FORMAT = 1


def _compact(document: dict) -> str:
    """JSON on one line: indented arrays would have one number per line."""
    return json.dumps(document, separators=(",", ":"), ensure_ascii=False, allow_nan=False) + "\n"


def gains_csv(plan: _prowl.Plan, samples: Samples) -> str:
    """One row per sample: time_s, phase, and K row by row, JOINT:COLUMN."""
    joints = plan.robot.joint_names
    names = [f"{joint}:{column}" for joint in joints for column in gain_columns(joints)]
    table = np.column_stack([samples.motion.t, samples.motion.phase, samples.gains.reshape(len(samples.gains), -1)])
    rows = (",".join(map(number, row)) + "\n" for row in table.tolist())
    return ",".join(["time_s", "phase", *names]) + "\n" + "".join(rows)


def _components(plan: _prowl.Plan) -> dict[str, list[str]]:
    """Columns of trajectory.csv by quantity; names contain units."""
    columns, nu = plan.to_csv().partition("\n")[0].split(",")[2:], plan.robot.nu  # without time and phase
    base, joints = columns[:19], columns[19:]
    return {
        "q": base[:7] + joints[:nu],
        "v": base[7:13] + joints[nu : 2 * nu],
        "a": base[13:] + joints[2 * nu : 3 * nu],
        "tau": joints[3 * nu : 4 * nu],
        "K": gain_columns(plan.robot.joint_names),
    }


def _phases(plan: _prowl.Plan) -> list[dict]:
    """Planned phases with their times."""
    return [
        {
            "name": phase.name,
            "start_s": float(times[0]),
            "end_s": float(times[-1]),
            "contacts": [{"contact": c, "surface": s} for c, s in zip(phase.contacts, phase.surfaces)],
        }
        for p, phase in enumerate(plan.task.phases)
        if (times := plan.t[plan.phase == p]).size
    ]


def motion_document(plan: _prowl.Plan, samples: Samples) -> dict:
    """motion.json: all data, with placements of links and contacts by forward kinematics."""
    robot, motion = plan.robot, samples.motion
    return {
        "format": FORMAT,
        "robot": robot.name,
        "task": plan.task.name,
        "motion": "simulation" if samples.simulated else "plan",
        "good": plan.good,
        "mass_kg": robot.mass,
        "joints": robot.joint_names,
        "contacts": robot.contact_names,
        "links": [{"name": link.name, "parent": link.parent, "fixed": link.fixed} for link in robot.links],
        "surfaces": [
            {
                "name": surface.name,
                "point_m": surface.point,
                "normal": surface.normal,
                "friction": surface.friction,
                "patch_m": surface.patch,
            }
            for surface in plan.task.surfaces
        ],
        "phases": _phases(plan),
        "components": _components(plan),
        "samples": {
            "time_s": motion.t.tolist(),
            "phase": motion.phase.tolist(),
            "q": motion.q.tolist(),
            "v": motion.v.tolist(),
            "a": None if samples.simulated else motion.a.tolist(),
            "tau": motion.tau.tolist(),
            "in_contact": samples.in_contact.tolist(),
            "force_N": motion.f.tolist(),
            "contact_position_m": _prowl.Dynamics(robot).contact_positions(motion.q).tolist(),
            "link_placement": robot.link_placements(motion.q).tolist(),
            "K": None if samples.gains is None else samples.gains.tolist(),
        },
    }


def motion_json(document: dict) -> str:
    return _compact(document)


def joint_trajectory_json(plan: _prowl.Plan, samples: Samples) -> str:
    """trajectory_msgs/JointTrajectory of ROS as JSON."""
    motion = samples.motion
    points = []
    for i in samples.one_a_time():
        seconds, nanoseconds = divmod(round(1e9 * motion.t[i]), 10**9)
        points.append(
            {
                "positions": motion.q[i, 7:].tolist(),
                "velocities": motion.v[i, 6:].tolist(),
                "accelerations": [] if samples.simulated else motion.a[i, 6:].tolist(),
                "effort": motion.tau[i].tolist(),
                "time_from_start": {"sec": seconds, "nanosec": nanoseconds},
            }
        )
    header = {"stamp": {"sec": 0, "nanosec": 0}, "frame_id": ""}
    return _compact({"header": header, "joint_names": plan.robot.joint_names, "points": points})
