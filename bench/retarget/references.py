"""References by inverse kinematics, some with a planted flaw: `references.py FOLDER` writes them and what is planted.

A list of what each contains is in CASES: base motion over feet that stand, or walk through steps. None is optimised,
so none obeys dynamics.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np

import prowl

RATE = 50.0  #: [Hz]


def smooth(s: np.ndarray) -> np.ndarray:
    """From 0 to 1, at rest at both ends."""
    s = np.clip(s, 0.0, 1.0)
    return s**3 * (10 - 15 * s + 6 * s**2)


def there_and_back(t: np.ndarray, duration: float) -> np.ndarray:
    return smooth(2 * t / duration) * smooth(2 * (duration - t) / duration)


@dataclass(frozen=True)
class Step:
    """A swing of the contacts of one foot."""

    foot: str  #: frame of its contacts
    start: float
    end: float
    way: tuple[float, float] = (0.0, 0.0)  #: [m]
    height: float = 0.06


@dataclass(frozen=True)
class Case:
    name: str
    robot: str
    duration: float
    base: Callable[[np.ndarray, float], np.ndarray]  #: times, size -> tangent (N, 6) of the base
    steps: tuple[Step, ...] = ()
    flaw: str = ""  #: what is planted; empty: feasible
    speed: float = 1.0  #: the file is this much faster
    slide: tuple[str, float, float, float] | None = None  #: foot, from, to, way [m]
    told: tuple[str, ...] = field(default=())  #: words, one of which the reasons must contain


def tangent(n: int, **entries: np.ndarray) -> np.ndarray:
    result = np.zeros((n, 6))
    for name, values in entries.items():
        result[:, ("x", "y", "z", "roll", "pitch", "yaw").index(name)] = values
    return result


def inverse_kinematics(robot: prowl.Robot, q: np.ndarray, targets: np.ndarray) -> np.ndarray:
    """Joints that put all contacts at their targets, the base as it is; least change."""
    dynamics = prowl.Dynamics(robot)
    for _ in range(60):
        off = (targets - dynamics.contact_positions(q)).ravel()
        if np.abs(off).max() < 1e-10:
            break
        jacobian = dynamics.contact_jacobian(q).reshape(off.size, -1)[:, 6:]
        gain = jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-6 * np.eye(off.size), off)
        q = prowl.integrate(q, np.concatenate([np.zeros(6), gain]))
    return q


def postures(case: Case) -> tuple[np.ndarray, np.ndarray]:
    robot = prowl.read_robot(case.robot)
    t = np.arange(round(case.duration * RATE) + 1) / RATE
    start = robot.nominal_configuration
    places = prowl.Dynamics(robot).contact_positions(start)
    frames = [contact.frame for contact in robot.contacts]
    base = case.base(t, float(start[2]))
    q, rows = start.copy(), []
    for k, now in enumerate(t):
        targets = places.copy()
        for step in case.steps:
            s = np.array((now - step.start) / (step.end - step.start))
            move = np.array([*(float(smooth(s)) * np.array(step.way)), 0.0])
            inside = np.clip(s, 0.0, 1.0)
            move[2] = step.height * float(16 * inside**2 * (1 - inside) ** 2)
            targets[[frame == step.foot for frame in frames]] += move
        if case.slide is not None:
            foot, first, last, way = case.slide
            share = float(smooth(np.array((now - first) / (last - first))))
            targets[[frame == foot for frame in frames], 0] += way * share
        moved = prowl.integrate(start, np.concatenate([base[k], np.zeros(robot.nu)]))
        q = np.concatenate([moved[:7], q[7:]])
        q = inverse_kinematics(robot, q, targets)
        rows.append(q)
    return t / case.speed, np.array(rows)


def write(case: Case, folder: Path) -> Path:
    robot = prowl.read_robot(case.robot)
    t, q = postures(case)
    names = ["time_s", "base_px_m", "base_py_m", "base_pz_m", "base_qx", "base_qy", "base_qz", "base_qw"]
    names += [f"q_{joint}_rad" for joint in robot.joint_names]
    path = folder / f"{case.name}.csv"
    np.savetxt(path, np.column_stack([t, q]), delimiter=",", header=",".join(names), comments="", fmt="%.9g")
    return path


def bow(size: float, angle: float) -> Callable[[np.ndarray, float], np.ndarray]:
    return lambda t, h: tangent(len(t), pitch=angle * there_and_back(t, t[-1]), z=-size * h * there_and_back(t, t[-1]))


def sway(x: float, y: float) -> Callable[[np.ndarray, float], np.ndarray]:
    def move(t: np.ndarray, h: float) -> np.ndarray:
        window = smooth(t / 0.5) * smooth((t[-1] - t) / 0.5)
        turn = 2 * np.pi * t / t[-1] * 2
        return tangent(len(t), x=x * h * window * np.sin(turn), y=y * h * window * np.cos(turn))

    return move


def squat(depth: float) -> Callable[[np.ndarray, float], np.ndarray]:
    return lambda t, h: tangent(len(t), z=-depth * h * there_and_back(t, t[-1]))


def twist(yaw: float, roll: float = 0.0) -> Callable[[np.ndarray, float], np.ndarray]:
    return lambda t, h: tangent(len(t), yaw=yaw * there_and_back(t, t[-1]), roll=roll * there_and_back(t, t[-1]))


def lean_and_step(
    lean: list[tuple[float, float, float]], forward: float = 0.0
) -> Callable[[np.ndarray, float], np.ndarray]:
    """Waypoints of the base: time, x, y as shares of the height; at rest in between."""

    def move(t: np.ndarray, h: float) -> np.ndarray:
        x, y = np.zeros(len(t)), np.zeros(len(t))
        for (before, *old), (after, *new) in pairwise(lean):
            s = smooth((t - before) / (after - before))
            x += (new[0] - old[0]) * s
            y += (new[1] - old[1]) * s
        return tangent(len(t), x=h * x + forward * smooth(t / t[-1]), y=h * y)

    return move


def quadruped_steps(robot: str, feet: tuple[str, str, str, str], way: float) -> dict[str, object]:
    """Each foot once (left hind, left fore, right hind, right fore), the base over the other three."""
    times = [0.6 + 0.9 * k for k in range(4)]
    lean = [(0.0, 0.0, 0.0)]
    sides = {0: (0.08, -0.1), 1: (-0.08, -0.1), 2: (0.08, 0.1), 3: (-0.08, 0.1)}
    for k, time in enumerate(times):
        lean += [(time, *sides[k]), (time + 0.45, *sides[k])]
    lean.append((times[-1] + 1.2, 0.0, 0.0))
    steps = tuple(Step(foot, time, time + 0.45, (way, 0.0), 0.05) for foot, time in zip(feet, times))
    return {"robot": robot, "duration": times[-1] + 1.2, "base": lean_and_step(lean, forward=way), "steps": steps}


HYQ = ("lh_foot", "lf_foot", "rh_foot", "rf_foot")
GO2 = ("RL_foot", "FL_foot", "RR_foot", "FR_foot")
TALOS = {
    "robot": "talos",
    "base": lean_and_step([(0, 0, 0), (1.2, 0, 0.09), (2.4, 0, 0.09), (3.4, 0, 0)]),
    "duration": 3.6,
}

CASES = (
    Case("hyq_bow", "hyq", 2.0, bow(0.1, 0.25)),
    Case("hyq_sway", "hyq", 4.0, sway(0.08, 0.08)),
    Case("hyq_squat", "hyq", 2.0, squat(0.3)),
    Case("hyq_twist", "hyq", 2.4, twist(0.3, 0.1)),
    Case("hyq_steps", **quadruped_steps("hyq", HYQ, 0.1)),
    Case("go2_bow", "go2", 1.6, bow(0.1, 0.25)),
    Case("go2_sway", "go2", 3.0, sway(0.1, 0.1)),
    Case("go2_squat", "go2", 1.6, squat(0.3)),
    Case("go2_twist", "go2", 2.0, twist(0.35, 0.15)),
    Case("go2_steps", **quadruped_steps("go2", GO2, 0.06)),
    Case("talos_bow", "talos", 3.0, bow(0.03, 0.12)),
    Case("talos_squat", "talos", 3.0, squat(0.12)),
    Case("talos_sway", "talos", 4.0, sway(0.01, 0.04)),
    Case("talos_twist", "talos", 3.0, twist(0.12)),
    Case("talos_step", steps=(Step("right_sole_link", 1.3, 2.3, (0.1, 0.0), 0.06),), **TALOS),
    Case(
        "hyq_slide", "hyq", 2.0, squat(0.2), flaw="slides", slide=("lf_foot", 0.5, 1.5, 0.02), told=("lf_foot: slides",)
    ),
    Case(
        "go2_slide",
        "go2",
        2.0,
        sway(0.06, 0.06),
        flaw="slides",
        slide=("RR_foot", 0.4, 1.4, -0.02),
        told=("RR_foot: slides",),
    ),
    Case("go2_quick", "go2", 0.3, squat(0.45), flaw="too fast", told=("load of",)),
    Case("hyq_quick", "hyq", 0.45, squat(0.45), flaw="torque", told=("torque of",)),
    Case(
        "talos_quick",
        steps=(Step("right_sole_link", 1.3, 1.8, (0.25, 0.0), 0.12),),
        speed=1.1,
        **TALOS,
        flaw="10 % too fast",
        told=("rad/s, the limit is",),
    ),
)


def main() -> None:
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for case in CASES:
        write(case, folder)
    listed = [{"name": case.name, "robot": case.robot, "flaw": case.flaw, "told": case.told} for case in CASES]
    (folder / "list.json").write_text(json.dumps(listed, indent=1) + "\n")


if __name__ == "__main__":
    main()
