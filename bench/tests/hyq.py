"""HyQ's shipped tasks, and motions of it that are known from elsewhere."""

import dataclasses
import pathlib
import sys

import numpy as np
import pinocchio as pin
from scipy.integrate import solve_ivp

from judge.contact_dynamics import ContactDynamics, standing_torques
from judge.motion import Motion
from judge.motion_task import MotionTask, Phase, read_task

ROOT = pathlib.Path(__file__).resolve().parents[2]
PACKAGES = list(pathlib.Path(sys.prefix).glob("lib/python3*/site-packages/cmeel.prefix/share"))


def shipped(name: str) -> MotionTask:
    return read_task(ROOT / "tasks/hyq" / f"{name}.toml", PACKAGES)


def standing_task(duration: float, contacts: frozenset[str] | None = None) -> MotionTask:
    """One phase, no goals."""
    task = shipped("stand")
    contacts = task.phases[0].contacts if contacts is None else contacts
    return dataclasses.replace(task, goals=(), phases=(Phase("all", contacts, duration, (duration, duration), 1, {}),))


def rocking_torque(task: MotionTask, t: float) -> np.ndarray:
    """Smooth torques about those that stand: they rock the robot by some millimetres."""
    shares = np.linspace(-1.0, 1.0, len(task.robot.joints))
    return standing_torques(task.robot, task.start, task.phases[0].contacts) + 20.0 * shares * np.sin(15.0 * t)


def integrate_exactly(
    task: MotionTask, q: np.ndarray, v: np.ndarray, torque, times: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Solution of the contact dynamics, in other coordinates and by another integrator than the judge's."""
    dynamics, model = ContactDynamics(task.robot, task.phases[0].contacts), task.robot.model
    nv = model.nv

    def rate(t: float, x: np.ndarray) -> np.ndarray:
        here = pin.integrate(model, q, x[:nv])
        a, _, _ = dynamics(here, x[nv:], torque(t))
        jacobian = pin.dIntegrate(model, q, x[:nv], pin.ARG1)  # velocity at q ⊕ x of a rate of x
        return np.concatenate([np.linalg.solve(jacobian, x[nv:]), a])

    found = solve_ivp(
        rate,
        (times[0], times[-1]),
        np.concatenate([np.zeros(nv), v]),
        method="RK45",
        t_eval=times,
        rtol=1e-11,
        atol=1e-12,
    )
    return np.array([pin.integrate(model, q, x[:nv]) for x in found.y.T]), found.y.T[:, nv:]


def rocking_motion(task: MotionTask, intervals: int, torque: str) -> Motion:
    """Nodes of the exact rocking motion; its torque between them is only as exact as `torque`."""
    times = np.linspace(0.0, task.duration, intervals + 1)
    q, v = integrate_exactly(task, task.start, np.zeros(task.robot.model.nv), lambda t: rocking_torque(task, t), times)
    tau = np.array([rocking_torque(task, t) for t in times])
    return Motion(times, np.zeros(intervals + 1, dtype=int), q, v, tau, torque)
