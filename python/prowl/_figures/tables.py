"""Data of the figures as tables: of a plan, its gains and its simulation."""

from __future__ import annotations

import csv
import io
import json
import math
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from .. import _prowl
from .._columns import gain_columns, number

Table = dict[str, np.ndarray]  # columns by name, in order
AXES = ("x", "y", "z")
STEP = 0.005  # of contact accelerations [s]
CURVE_POINTS = 200


def _read(path: Path) -> Table:
    """Reads a CSV file of numbers with a header."""
    with open(path, newline="", encoding="utf-8") as file:
        names = next(csv.reader(file))
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return {name: values[:, i] for i, name in enumerate(names)}


def rounded(table: Table) -> str:
    """Text of a CSV file, nine digits."""
    text = io.StringIO()
    text.write(",".join(table) + "\n")
    np.savetxt(text, np.column_stack(list(table.values())), fmt="%.9g", delimiter=",")
    return text.getvalue()


def exact(table: Table) -> str:
    """Text of a CSV file, all digits."""
    rows = zip(*(column.tolist() for column in table.values()))
    return ",".join(table) + "\n" + "".join(",".join(map(number, row)) + "\n" for row in rows)


def legs(robot: _prowl.Robot) -> list[list[str]]:
    """Joints by leg: the joints that move contacts, grouped by their first joint at the base, in the order of
    the contacts. Other joints (arms, head) come last."""
    by_first: dict[str, set[str]] = {}
    for joints in _prowl.Dynamics(robot).contact_joints:
        if joints:  # else the contact is on the base
            by_first.setdefault(joints[0], set()).update(joints)
    groups = [*by_first.values(), set(robot.joint_names).difference(*by_first.values())]
    return [[joint for joint in robot.joint_names if joint in group] for group in groups if group]


def gains_joint(robot: _prowl.Robot, name: str | None) -> str:
    """A joint by name; None: the first with a torque limit over position (a knee of HyQ), or else the last of
    the first leg. Raises InputError with the nearest name."""
    if name is None:
        first_leg = next(iter(_prowl.Dynamics(robot).contact_joints), [])
        return next(iter(robot.torque_over_position), first_leg[-1] if first_leg else robot.joint_names[0])
    if name not in robot.joint_names:
        hint = _prowl.did_you_mean(name, robot.joint_names)
        raise _prowl.InputError(f"joint: {robot.name} has no joint '{name}'{hint}")
    return name


def limit_curves(robot: _prowl.Robot) -> dict[str, np.ndarray]:
    """Per joint with a torque limit over position: positions, largest and smallest torque at rest (3 rows) over the
    range of its table."""
    curves = {}
    for joint, (first, last) in robot.torque_over_position.items():
        j = robot.joint_names.index(joint)
        positions = first + (last - first) * np.arange(CURVE_POINTS) / (CURVE_POINTS - 1)
        q = np.tile(robot.nominal_configuration, (CURVE_POINTS, 1))
        q[:, 7 + j] = positions
        lower, upper = robot.torque_limits(q, np.zeros((CURVE_POINTS, robot.nv)))
        curves[joint] = np.array([positions, upper[:, j], lower[:, j]])
    return curves


def limit_curves_text(curves: dict[str, np.ndarray]) -> str:
    rows = (
        f"{joint}," + ",".join(map(number, row)) + "\n" for joint, curve in curves.items() for row in curve.T.tolist()
    )
    return "joint,position_rad,limit_Nm,lower_limit_Nm\n" + "".join(rows)


def gains(plan: _prowl.Plan, joint: str) -> Table | None:
    """One row of K(t): the 2 nv gains of the torque of a joint, at every sample of the tracker, two at a
    phase transition. None without gains."""
    if plan.tracker is None:
        return None
    t, K = plan.tracker.t, plan.tracker.K[:, plan.robot.joint_names.index(joint)]
    segment = np.concatenate([[0], np.cumsum(np.diff(t) <= 0)])
    return {"time_s": t, "segment": segment} | dict(zip(gain_columns(plan.robot.joint_names), K.T))


def contact_acceleration(plan: _prowl.Plan) -> Table:
    """J a and −J̇v of every contact, world axes [m/s²], at the nodes and between them at most STEP apart; nan
    in the air. In stance both are equal, except for errors of the transcription."""
    places, times = [*range(len(plan))], []
    for k in np.flatnonzero(np.diff(plan.phase) == 0):
        length = plan.t[k + 1] - plan.t[k]
        parts = max(1, math.ceil(length / STEP - 1e-9))
        places += [k + i / parts for i in range(1, parts)]
        times += [plan.t[k] + length * i / parts for i in range(1, parts)]
    motions = [plan.motion, plan.at(times)] if times else [plan.motion]
    order = np.argsort(places)
    t, phase, q, v, a = (
        np.concatenate([getattr(motion, name) for motion in motions])[order] for name in ("t", "phase", "q", "v", "a")
    )
    dynamics, names = _prowl.Dynamics(plan.robot), plan.robot.contact_names
    held = np.array([[name in phase.contacts for name in names] for phase in plan.task.phases])[phase][:, :, np.newaxis]
    terms = {
        "Ja": np.where(held, dynamics.contact_acceleration(q, np.zeros_like(v), a), np.nan),
        "minus_Jdotv": np.where(held, -dynamics.contact_acceleration(q, v, np.zeros_like(a)), np.nan),
    }
    columns = {
        f"{term}_{name}_{axis}_mps2": values[:, c, i]
        for c, name in enumerate(names)
        for term, values in terms.items()
        for i, axis in enumerate(AXES)
    }
    return {"time_s": t, "phase": phase} | columns


class Shown:
    """A plan with its gains and simulation, as arrays by name."""

    def __init__(self, plan: _prowl.Plan, directory: Path, joint: str):
        self.title = f"{plan.robot.name}, {plan.task.name}"
        self.joints: list[str] = plan.robot.joint_names
        self.contacts: list[str] = plan.robot.contact_names
        self.legs = legs(plan.robot)
        self.joint, self.gains = joint, gains(plan, joint)
        self.phases = [
            (phase.name, *(float(plan.t[plan.phase == p][end]) for end in (0, -1)))
            for p, phase in enumerate(plan.task.phases)
        ]  # name, start and end [s]
        lower, upper = plan.robot.torque_limits(plan.q, plan.v)
        self.nodes: Table = {"time_s": plan.t}
        for j, name in enumerate(self.joints):
            self.nodes |= {f"q_{name}_rad": plan.q[:, 7 + j], f"tau_{name}_Nm": plan.tau[:, j]}
            self.nodes |= {f"lower_{name}_Nm": lower[:, j], f"upper_{name}_Nm": upper[:, j]}
        self.limit_curves = limit_curves(plan.robot)
        self.contact_acceleration = contact_acceleration(plan)
        self.simulated: Table | None = None
        if (directory / "simulate.csv").exists():
            self.simulated = _read(directory / "simulate.csv")
            self.simulation = json.loads((directory / "simulate.json").read_text(encoding="utf-8"))

    def settings(self) -> str:
        """Settings of the simulation on one line."""
        if not self.simulated:
            return "planned motion only: not simulated yet"
        options = self.simulation["options"]
        result = "success" if self.simulation["success"] else "FAILED"
        loop = f"{'open' if options['open_loop'] else 'closed'} loop"
        if self.simulation["engine"] == "rollout":
            rate = options["control_rate_Hz"]
            offset = any(options["base_offset_m"] + options["base_offset_rad"])
            return ", ".join(
                [
                    "rollout of the projected dynamics",
                    loop,
                    f"control at {rate:g} Hz" if rate else "continuous control",
                    *(["base off at the start"] if offset else []),
                    result,
                ]
            )
        parts = [
            f"MuJoCo, {loop}",
            "true state"
            if options["perfect_state"]
            else f"estimated state, sensor noise × {options['noise']['scale']:g}",
            f"delay {1e3 * options['delay_s']:g} ms",
            f"seed {options['seed']}",
        ]
        if options["mass_scale"] != 1:
            parts.append(f"masses × {options['mass_scale']:g}")
        if options["friction"] is not None:
            parts.append(f"friction {options['friction']:g}")
        if options["pushes"]:
            parts.append(f"{len(options['pushes'])} push(es)")
        parts.append(result)
        return ", ".join(parts)


def torques(shown: Shown) -> Table:
    """Per joint [N m]: planned (nan after the plan's end) with limits, and simulated: feedforward and
    feedback, at the time at which they act, and joint torque. Without a simulation, the plan at its nodes."""
    nodes, sim = shown.nodes, shown.simulated
    planned = {"plan": "tau", "lower": "lower", "upper": "upper"}
    if sim is None:
        return {"time_s": nodes["time_s"]} | {
            f"{name}_{joint}_Nm": nodes[f"{column}_{joint}_Nm"]
            for joint in shown.joints
            for name, column in planned.items()
        }
    time = sim["time_s"]
    delay = shown.simulation["options"].get("delay_s", 0.0)  # absent in a rollout
    table = {"time_s": time}
    for joint in shown.joints:
        for name, column in planned.items():
            table[f"{name}_{joint}_Nm"] = np.interp(time, nodes["time_s"], nodes[f"{column}_{joint}_Nm"], right=np.nan)
        for kind in ("feedforward", "feedback"):
            table[f"{kind}_{joint}_Nm"] = np.interp(time, time + delay, sim[f"{kind}_{joint}_Nm"])
        table[f"tau_{joint}_Nm"] = sim[f"tau_{joint}_Nm"]
    return table


def base_error(shown: Shown) -> Table:
    """Errors of the simulated base from the plan, and of the estimate from the truth: difference of positions
    in the world [m], and rotation vector from the first to the second, in the base frame of the first
    [rad]."""
    sim = shown.simulated
    table = {"time_s": sim["time_s"]}
    for name, before, after in (("error", "ref", "true"), ("estimate_error", "true", "seen")):
        for axis in AXES:
            table[f"{name}_p{axis}_m"] = sim[f"{after}_base_p{axis}_m"] - sim[f"{before}_base_p{axis}_m"]
        orientation = {
            kind: Rotation.from_quat(np.column_stack([sim[f"{kind}_base_q{c}"] for c in "xyzw"]))
            for kind in (before, after)
        }
        turn = (orientation[before].inv() * orientation[after]).as_rotvec()
        table |= {f"{name}_r{axis}_rad": turn[:, i] for i, axis in enumerate(AXES)}
    return table


def joint_error(shown: Shown) -> Table:
    """Per joint [rad]: simulated minus planned position, and estimate minus truth."""
    sim = shown.simulated
    table = {"time_s": sim["time_s"]}
    for joint in shown.joints:
        table[f"error_{joint}_rad"] = sim[f"true_q_{joint}_rad"] - sim[f"ref_q_{joint}_rad"]
        table[f"estimate_error_{joint}_rad"] = sim[f"seen_q_{joint}_rad"] - sim[f"true_q_{joint}_rad"]
    return table


def torque_over_position(shown: Shown) -> dict[str, dict[str, np.ndarray]]:
    """Per joint with a torque limit over position, per series: time [s], position [rad], torque [N m], 3
    rows."""
    table = {}
    for joint in shown.limit_curves:
        columns = {"plan": (shown.nodes, "")} | ({"simulation": (shown.simulated, "true_")} if shown.simulated else {})
        table[joint] = {
            series: np.array([source["time_s"], source[f"{prefix}q_{joint}_rad"], source[f"tau_{joint}_Nm"]])
            for series, (source, prefix) in columns.items()
        }
    return table


def torque_over_position_text(table: dict[str, dict[str, np.ndarray]]) -> str:
    rows = (
        f"{joint},{series}," + ",".join(f"{x:.9g}" for x in row) + "\n"
        for joint, by_series in table.items()
        for series, values in by_series.items()
        for row in values.T
    )
    return "joint,series,time_s,position_rad,torque_Nm\n" + "".join(rows)
