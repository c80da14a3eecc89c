"""Judges a motion, whoever planned it: does it solve the dynamics, and does it keep to its task?

The one measure of error is re-integration. Each interval is integrated alone from its first node, with the torque that the
plan gives for every moment of it and rigid contacts, by Dormand-Prince 8(5,3) to 1e-9; what is missing at the end to the
next node, in position and in velocity, is the error. It takes from a plan only what a plan is (states at nodes, torque in
time) and needs no interpolant, of which an Euler step with held torque and a trapezoid with linear torque have different ones:
any choice would flatter one of them. Limits between nodes are judged along the same integrated motion, for both alike.
"""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

from judge.contact_dynamics import ContactDynamics
from judge.motion import Motion, difference
from judge.motion_task import MotionTask

SAMPLES = 10  # points an interval at which limits are judged, besides its first node
TOLERANCE = 1e-9  # of the re-integration


@dataclass
class Finding:
    """Worst value of one check; it is kept if value <= limit. Limits are those of Prowl's certificate (docs/verification.md)."""

    limit: float
    unit: str
    value: float = 0.0
    time: float = 0.0
    where: str = ""

    def see(self, value: float, time: float, where: str) -> None:
        if not value <= self.value:  # so that NaN is taken too
            self.value, self.time, self.where = float(value), float(time), where


@dataclass
class Verdict:
    interval_errors: np.ndarray  # max over coordinates, one an interval [-]
    error: float  # the largest of them, phase switches included
    error_per_second: float  # largest sum of them over any second of the motion, coordinate by coordinate
    cost: float  # of the task, along the integrated motion
    findings: dict[str, Finding]

    @property
    def worst(self) -> tuple[str, Finding]:
        return max(self.findings.items(), key=lambda item: np.nan_to_num(item[1].value / item[1].limit, nan=np.inf))

    @property
    def worst_share(self) -> float:
        """Worst value over its limit: at most 1 if the motion keeps to its task."""
        finding = self.worst[1]
        return finding.value / finding.limit


def coordinate_scales(motion: Motion) -> np.ndarray:
    """S_i = 1 + max |x_i| over the nodes, positions counted from the first node (docs/verification.md)."""
    tangents = np.array([difference(motion.q[0], q) for q in motion.q])
    return 1.0 + np.abs(np.hstack([tangents, motion.v])).max(axis=0)


def reintegrate(dynamics: ContactDynamics, motion: Motion, k: int) -> tuple[np.ndarray, np.ndarray]:
    """States at SAMPLES + 1 even times of the interval that begins at node k: rows of q, rows of v."""
    nq, step = dynamics.model.nq, motion.time[k + 1] - motion.time[k]

    def rate(s: float, state: np.ndarray) -> np.ndarray:
        q, v = state[:nq].copy(), state[nq:]
        q[3:7] /= np.linalg.norm(q[3:7])
        a, _, _ = dynamics(q, v, motion.torque_at(k, s / step))
        turn = pin.Quaternion(q[3:7])
        spin = (turn * pin.Quaternion(np.append(v[3:6], 0.0))).coeffs() / 2  # d quat / dt = quat (0, ω) / 2
        return np.concatenate([turn.matrix() @ v[:3], spin, v[6:], a])

    if not all(np.isfinite(row).all() for row in (motion.q[k], motion.v[k], motion.tau[k : k + 2])):
        return np.full((SAMPLES + 1, nq), np.nan), np.full((SAMPLES + 1, dynamics.model.nv), np.nan)
    times = np.linspace(0.0, step, SAMPLES + 1)
    found = solve_ivp(
        rate,
        (0.0, step),
        np.concatenate([motion.q[k], motion.v[k]]),
        method="DOP853",
        t_eval=times,
        rtol=TOLERANCE,
        atol=TOLERANCE,
        first_step=step,
    )
    states = np.full((SAMPLES + 1, nq + dynamics.model.nv), np.nan)
    states[: found.y.shape[1]] = found.y.T
    states[:, 3:7] /= np.linalg.norm(states[:, 3:7], axis=1, keepdims=True)
    return states[:, :nq], states[:, nq:]


def largest_in_a_second(times: np.ndarray, errors: np.ndarray) -> float:
    """max over coordinates and over windows of 1 s of the sum of errors (rows) whose interval ends in the window."""
    worst = 0.0
    for start in range(len(times)):
        inside = (times >= times[start] - 1e-9) & (times < times[start] + 1.0 - 1e-9)
        worst = max(worst, errors[inside].sum(axis=0).max())
    return float(worst)


def judge(task: MotionTask, motion: Motion) -> Verdict:
    robot, weight = task.robot, task.robot.weight
    findings = {
        "torque": Finding(1e-3, "of limit too much"),
        "joint position": Finding(1e-3, "rad"),
        "joint velocity": Finding(1e-3, "of limit too much"),
        "friction": Finding(0.01 * weight, "N"),
        "pulling": Finding(0.01 * weight, "N"),
        "slip": Finding(1e-3, "m"),
        "contact speed": Finding(5e-3, "m/s"),
        "penetration": Finding(1e-3, "m"),
        "landing": Finding(1e-3, "m"),
        "force before opening": Finding(0.01 * weight, "N"),
        "goal position": Finding(1e-3, "m"),
        "goal angle": Finding(1e-3, "rad"),
        "goal velocity": Finding(5e-3, "m/s, rad/s"),
        "start": Finding(1e-6, "SI"),
    }
    scales = coordinate_scales(motion)
    dynamics = [ContactDynamics(robot, phase.contacts) for phase in task.phases]
    anchors: dict[str, np.ndarray] = {}
    ends, errors, cost = [], [], 0.0
    findings["start"].see(
        np.abs(np.append(difference(task.start, motion.q[0]), motion.v[0] - task.velocity)).max(), 0.0, "start"
    )

    for k in range(len(motion.time) - 1):
        phase, step = int(motion.phase[k]), motion.time[k + 1] - motion.time[k]
        end = np.append(difference(motion.q[k], motion.q[k + 1]), motion.v[k + 1] - motion.v[k])
        if motion.phase[k + 1] != phase:
            _see_landing(task, motion, k + 1, findings)
            errors.append(np.abs(end) / scales)
            ends.append(motion.time[k + 1])
            continue
        qs, vs = reintegrate(dynamics[phase], motion, k)
        reached = np.append(difference(motion.q[k], qs[-1]), vs[-1] - motion.v[k])
        errors.append(np.abs(reached - end) / scales)
        ends.append(motion.time[k + 1])

        rates = np.zeros(SAMPLES + 1)
        for i, (q, v) in enumerate(zip(qs, vs)):
            share = i / SAMPLES
            time, tau = motion.time[k] + share * step, motion.torque_at(k, share)
            a, forces, speeds = dynamics[phase](q, v, tau)
            rates[i] = running_cost(task, q, v, a, tau, forces)
            losses = robot.model.damping[6:] * v[6:] if motion.has_losses else 0.0
            _see_joints(task, q, v, tau + losses, time, findings)
            _see_contacts(task, phase, robot.places(q), forces, speeds, time, anchors, findings)
            if i == SAMPLES and (k + 2 == len(motion.time) or motion.phase[k + 2] != phase):
                _see_opening(task, phase, dynamics[phase], forces, time, findings)
        cost += np.trapezoid(rates, dx=step / SAMPLES)

    _see_goals(task, motion, findings)
    errors, ends = np.array(errors), np.array(ends)
    errors = np.where(np.isfinite(errors), errors, np.inf)
    return Verdict(errors.max(axis=1), float(errors.max()), largest_in_a_second(ends, errors), float(cost), findings)


def running_cost(task: MotionTask, q, v, a, tau, forces) -> float:
    """`forces`: one row a contact that holds, in the world."""
    cost = task.cost
    return cost.time + 0.5 * (
        cost.configuration @ difference(task.start, q) ** 2
        + cost.velocity @ v**2
        + cost.acceleration @ a**2
        + cost.torque @ (tau - cost.torque_reference) ** 2
        + (forces**2 @ cost.force).sum()
    )


def _see_joints(task, q, v, tau, time, findings) -> None:
    robot, model = task.robot, task.robot.model
    excess = {
        "torque": np.abs(tau) / robot.torque_bound(q, tau) - 1.0,
        "joint position": np.maximum(model.lowerPositionLimit[7:] - q[7:], q[7:] - model.upperPositionLimit[7:]),
        "joint velocity": np.abs(v[6:]) / model.velocityLimit[6:] - 1.0,
    }
    for name, values in excess.items():
        joint = int(values.argmax())
        findings[name].see(values[joint], time, robot.joints[joint])


def _see_contacts(task, phase, places, forces, speeds, time, anchors, findings) -> None:
    held = [contact for contact in task.robot.contacts if contact.name in task.phases[phase].contacts]
    for contact, force, speed in zip(held, forces, speeds):
        name, place = contact.name, places[contact.name]
        push = task.normal @ force
        findings["friction"].see(
            np.linalg.norm(force - push * task.normal) - task.friction * max(push, 0.0), time, name
        )
        findings["pulling"].see(-push, time, name)
        findings["slip"].see(np.linalg.norm(place - anchors.setdefault(name, place)), time, name)
        findings["contact speed"].see(np.linalg.norm(speed), time, name)
        findings["penetration"].see(contact.radius - task.height(place), time, name)
    for contact in task.robot.contacts:
        if contact not in held:
            anchors.pop(contact.name, None)
            findings["penetration"].see(contact.radius - task.height(places[contact.name]), time, contact.name)


def _see_landing(task, motion, node, findings) -> None:
    places = task.robot.places(motion.q[node])
    phase = int(motion.phase[node])
    for name in task.lands(phase):
        place = places[name] - np.array([0, 0, task.robot.contact(name).radius])
        away = place - task.phases[phase].places.get(name, np.array([place[0], place[1], task.floor]))
        findings["landing"].see(np.linalg.norm(away), motion.time[node], name)


def _see_opening(task, phase, dynamics, forces, time, findings) -> None:
    for contact, force in zip(dynamics.contacts, forces):
        if contact.name in task.opens(phase):
            findings["force before opening"].see(np.linalg.norm(force), time, contact.name)


def _see_goals(task, motion, findings) -> None:
    for number, goal in enumerate(task.goals, start=1):
        node = motion.node_at(goal.phase, goal.fraction)
        q, v, time, where = motion.q[node], motion.v[node], motion.time[node], f"goal {number}"
        findings["goal position"].see(np.nanmax(np.append(np.abs(q[:3] - goal.position), 0.0)), time, where)
        if goal.rotation is not None:
            turn = pin.log3(goal.rotation.T @ pin.Quaternion(q[3:7] / np.linalg.norm(q[3:7])).matrix())
            findings["goal angle"].see(np.abs(turn[goal.turn]).max(), time, where)
        findings["goal velocity"].see(np.nanmax(np.append(np.abs(v[:6] - goal.velocity), 0.0)), time, where)
