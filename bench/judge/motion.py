"""A planned motion as its planner claims it: states at the nodes, and torques as a function of time."""

import csv
import pathlib
from dataclasses import dataclass

import numpy as np
import pinocchio as pin


@dataclass(frozen=True)
class Motion:
    """Nodes in order, at any times; a phase switch has two at one time, with the phase before and after it.

    Torque between two nodes is either that of the first (`held`: Euler steps of the peers) or linear (Prowl's trapezoid).
    """

    time: np.ndarray  # [s]
    phase: np.ndarray  # counts from 0
    q: np.ndarray  # one row a node, Pinocchio's free flyer first
    v: np.ndarray
    tau: np.ndarray
    torque: str  # "held" or "linear"
    has_losses: bool = False  # motors give the damping of the URDF besides the torques

    def __post_init__(self):
        if self.torque not in ("held", "linear"):
            raise ValueError(f'torque: "{self.torque}" is not allowed; need "held" or "linear"')
        if np.any(np.diff(self.time) < 0) or np.any((np.diff(self.time) == 0) != (np.diff(self.phase) != 0)):
            raise ValueError("time: has to increase inside a phase, and to stand still where the phase changes")

    @property
    def duration(self) -> float:
        return float(self.time[-1] - self.time[0])

    @property
    def intervals(self) -> list[int]:
        """Left nodes of the mesh intervals."""
        return [k for k in range(len(self.time) - 1) if self.phase[k] == self.phase[k + 1]]

    @property
    def switches(self) -> list[int]:
        """Left nodes of the phase switches."""
        return [k for k in range(len(self.time) - 1) if self.phase[k] != self.phase[k + 1]]

    def torque_at(self, k: int, share: float) -> np.ndarray:
        """Torque at a share 0 ... 1 of the interval that begins at node k."""
        return self.tau[k] if self.torque == "held" else (1 - share) * self.tau[k] + share * self.tau[k + 1]

    def node_at(self, phase: int, fraction: float) -> int:
        """Node at a fraction of a phase; the mesh has to have one there."""
        nodes = np.flatnonzero(self.phase == phase)
        first, last = self.time[nodes[0]], self.time[nodes[-1]]
        away = np.abs(self.time[nodes] - (first + fraction * (last - first)))
        if away.min() > 1e-6:
            raise ValueError(f"phase {phase + 1}: no node at {fraction} of it; the nearest is {away.min():.3g} s away")
        return int(nodes[away.argmin()])


def difference(q0: np.ndarray, q1: np.ndarray) -> np.ndarray:
    """Tangent from q0 to q1 on R³ × SO(3) × Rⁿ, as in prowl/model/configuration.hpp."""
    turn = pin.Quaternion(q0[3:7]).inverse() * pin.Quaternion(q1[3:7] / np.linalg.norm(q1[3:7]))
    return np.concatenate([q1[:3] - q0[:3], pin.log3(turn.matrix()), q1[7:] - q0[7:]])


def read_plan_motion(plan: pathlib.Path) -> Motion:
    """The motion in a folder that `prowl plan` wrote (docs/plan-directory.md)."""
    with open(plan / "trajectory.csv", newline="") as file:
        reader = csv.reader(file)
        header = next(reader)
        table = np.array([[float(entry) for entry in row] for row in reader])

    def columns(prefix: str, suffix: str) -> np.ndarray:
        return table[:, [i for i, name in enumerate(header) if name.startswith(prefix) and name.endswith(suffix)]]

    base = [f"base_{c}" for c in ("px_m", "py_m", "pz_m", "qx", "qy", "qz", "qw")]
    twist = [f"base_{c}" for c in ("vx_mps", "vy_mps", "vz_mps", "wx_radps", "wy_radps", "wz_radps")]
    at = [header.index(name) for name in base]
    moving = [header.index(name) for name in twist]
    return Motion(
        time=table[:, 0],
        phase=table[:, 1].astype(int),
        q=np.hstack([table[:, at], columns("q_", "_rad")]),
        v=np.hstack([table[:, moving], columns("v_", "_radps")]),
        tau=columns("tau_", "_Nm"),
        torque="linear",
        has_losses=True,
    )
