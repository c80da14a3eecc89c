"""prowl/TrackMotion-v0, an environment of Gymnasium: follow the motions of a library in MuJoCo.

    import gymnasium, prowl.gym

    env = gymnasium.make("prowl/TrackMotion-v0", library="out/crouches")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

It needs pip install "prowl[gym]". docs/trainers.md explains observations and rewards.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any

import gymnasium
import mujoco
import numpy as np

from . import _prowl
from ._batch import read_library
from ._trainers.write import even_samples

__all__ = ["TrackMotion"]

_TORQUE_ERROR = 0.5  #: [rad] off its target, a joint has its largest torque
_DAMPING_TIME = 0.025  #: [s] of damping over stiffness
_REACH = 0.5  #: [rad] that an action of one moves a target
_LOST_TILT, _LOST_WAY = 1.0, 0.5  #: [rad], heights of the robot


class _Plant:
    """A robot on its ground in MuJoCo, with a drive at each joint: force = stiffness (control - q) - damping v, within
    the limit of the motor."""

    def __init__(self, task: _prowl.Task) -> None:
        robot = task.robot
        self.model = mujoco.MjModel.from_xml_string(task.mujoco_xml())
        self.data = mujoco.MjData(self.model)
        self.height = float(robot.nominal_configuration[2])
        joints = [mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in robot.joint_names]
        self.q, self.v = self.model.jnt_qposadr[joints], self.model.jnt_dofadr[joints]
        motors = {int(self.model.actuator_trnid[i, 0]): i for i in range(self.model.nu)}
        self.motors = np.array([motors[joint] for joint in joints])
        limit = np.array(robot.torque_limit)
        finite = np.isfinite(limit)
        limit[~finite] = 10.0 * limit[finite].max() if finite.any() else robot.mass * 9.81 * self.height
        self.stiffness = limit / _TORQUE_ERROR
        self.damping = _DAMPING_TIME * self.stiffness
        self._drive(limit)

    def _drive(self, limit: np.ndarray) -> None:
        """Turns motors into drives."""
        model, motors = self.model, self.motors
        model.actuator_gaintype[motors] = mujoco.mjtGain.mjGAIN_FIXED
        model.actuator_biastype[motors] = mujoco.mjtBias.mjBIAS_AFFINE
        model.actuator_gainprm[motors, 0] = self.stiffness
        model.actuator_biasprm[motors, 1] = -self.stiffness
        model.actuator_biasprm[motors, 2] = -self.damping
        model.actuator_ctrllimited[motors] = 0
        model.actuator_forcelimited[motors] = 1
        model.actuator_forcerange[motors, 0] = -limit
        model.actuator_forcerange[motors, 1] = limit

    def place(self, q: np.ndarray, v: np.ndarray) -> None:
        """Puts the robot into a state of Prowl."""
        mujoco.mj_resetData(self.model, self.data)
        qpos, qvel = self.data.qpos, self.data.qvel
        qpos[:3], qpos[3], qpos[4:7], qpos[self.q] = q[:3], q[6], q[3:6], q[7:]
        mujoco.mju_rotVecQuat(qvel[:3], np.ascontiguousarray(v[:3]), np.ascontiguousarray(qpos[3:7]))
        qvel[3:6], qvel[self.v] = v[3:6], v[6:]
        mujoco.mj_forward(self.model, self.data)


@dataclass(frozen=True)
class _Followed:
    """A motion at the times of the actions, and where it takes place."""

    plant: _Plant
    q: np.ndarray
    v: np.ndarray
    targets: np.ndarray  #: of the joints, at which the drives give the torques of the motion
    in_contact: np.ndarray

    @property
    def last(self) -> int:
        return len(self.q) - 1


class TrackMotion(gymnasium.Env[np.ndarray, np.ndarray]):
    """The robot of a library in MuJoCo, with a motion of the library as its reference.

    Action: (nu) in [-1, 1], moves the targets of the joints by up to 0.5 rad off the reference. Each joint is driven by
    stiffness and damping to its target, plus the torque of the motion, within its limits. Observation: base
    height; base pose error, twist and gravity, in base axes; joint positions and velocities minus the reference;
    planned contacts; elapsed share of the motion. Reward: in (0, 1], 1 on the reference.
    """

    metadata = {"render_modes": []}

    def __init__(
        self,
        library: str | os.PathLike[str],
        *,
        rate: float = 50.0,
        noise: float = 0.02,
        motions: list[int] | None = None,
    ) -> None:
        """rate: of actions [Hz]. noise: standard deviation of the start's joints [rad]. motions: indices; None: all that
        are kept."""
        self.library = read_library(library)
        kept = self.library.kept_rows["index"].to_pylist()
        self._indices = kept if motions is None else list(motions)
        if not self._indices or not set(self._indices) <= set(kept):
            raise ValueError(f"{self.library.folder}: need motions that were kept, one or more")
        self._rate, self._noise = rate, noise
        self._plants: dict[str, _Plant] = {}
        self._motions: dict[int, _Followed] = {}
        self._robot = self.library.robot(self._indices[0])
        entries = 1 + 3 + 3 + 6 + 3 + 2 * self._robot.nu + len(self._robot.contacts) + 1
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (entries,), np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (self._robot.nu,), np.float32)

    def _motion(self, index: int) -> _Followed:
        """With the ground, payload and robot that were drawn for it."""
        if index not in self._motions:
            task = self.library.task(index)
            if list(task.robot.joint_names) != list(self._robot.joint_names):
                raise ValueError(f"{self.library.folder}: motions of robots with other joints; choose with motions=")
            xml = task.mujoco_xml()
            if xml not in self._plants:
                self._plants[xml] = _Plant(task)
            plant = self._plants[xml]
            period = self._steps(plant.model) * plant.model.opt.timestep
            motion = even_samples(self.library.arrays(index), 1.0 / period)
            targets = motion["q"][:, 7:] + (motion["tau"] + plant.damping * motion["v"][:, 6:]) / plant.stiffness
            flags = motion["in_contact"].astype(float)
            self._motions[index] = _Followed(plant, motion["q"], motion["v"], targets, flags)
        return self._motions[index]

    def _steps(self, model: mujoco.MjModel) -> int:
        """Of MuJoCo, in one of the environment."""
        return max(1, round(1.0 / (self._rate * model.opt.timestep)))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """options: {"motion": index} chooses one."""
        super().reset(seed=seed)
        index = (options or {}).get("motion")
        if index is None:
            index = self._indices[int(self.np_random.integers(len(self._indices)))]
        if index not in self._indices:
            raise ValueError(f"motion: {index} is none of those of this environment")
        self._now, self._index, self._k = self._motion(index), index, 0
        start = self._now.q[0].copy()
        start[7:] += self._noise * self.np_random.standard_normal(self._robot.nu)
        self._now.plant.place(start, self._now.v[0])
        observation, _ = self._observe()
        return observation, {"motion": index}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One period of actions."""
        now, plant = self._now, self._now.plant
        plant.data.ctrl[plant.motors] = now.targets[self._k] + _REACH * np.clip(action, -1.0, 1.0)
        mujoco.mj_step(plant.model, plant.data, self._steps(plant.model))
        self._k = min(self._k + 1, now.last)
        observation, (way, tilt, joints, rates) = self._observe()
        reward = (
            0.5 * np.exp(-20.0 * joints) + 0.3 * np.exp(-20.0 * (way * way + tilt * tilt)) + 0.2 * np.exp(-0.1 * rates)
        )
        terminated = bool(tilt > _LOST_TILT or way > _LOST_WAY)
        truncated = self._k >= now.last
        return observation, float(reward), terminated, truncated, {"motion": self._index}

    def _observe(self) -> tuple[np.ndarray, tuple[float, float, float, float]]:
        """Also errors: of the base in heights and rad, mean squares of those of the joints."""
        k, now, plant = self._k, self._now, self._now.plant
        data, q, v = plant.data, now.q[k], now.v[k]
        w, x, y, z = data.qpos[3:7]
        axes = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        off = (q[:3] - data.qpos[:3]) @ axes / plant.height
        # The vector part of the turn from the base to its reference.
        rx, ry, rz, rw = q[3], q[4], q[5], q[6]
        turn = np.array(
            [
                w * rx - x * rw - y * rz + z * ry,
                w * ry + x * rz - y * rw - z * rx,
                w * rz - x * ry + y * rx - z * rw,
            ]
        )
        turn *= 1.0 if w * rw + x * rx + y * ry + z * rz >= 0.0 else -1.0  # q and -q are one rotation
        joints, rates = data.qpos[plant.q] - q[7:], data.qvel[plant.v] - v[6:]
        observation = np.concatenate(
            (
                [data.qpos[2] / plant.height],
                off,
                turn,
                data.qvel[:3] @ axes,
                data.qvel[3:6],
                -axes[2],
                joints,
                rates,
                now.in_contact[k],
                [k / max(now.last, 1)],
            )
        )
        tilt = 2.0 * float(np.arcsin(min(1.0, float(np.sqrt(turn @ turn)))))
        way = float(np.sqrt(off @ off))
        return observation, (way, tilt, float(joints @ joints) / len(joints), float(rates @ rates) / len(rates))


gymnasium.register(id="prowl/TrackMotion-v0", entry_point=TrackMotion)
