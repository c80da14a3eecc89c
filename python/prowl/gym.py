"""prowl/TrackMotion-v0, an environment of Gymnasium: follow the motions of a library in MuJoCo.

    import gymnasium, prowl.gym

    env = gymnasium.make("prowl/TrackMotion-v0", library="out/crouches")
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

It needs pip install "prowl[gym]". docs/trainers.md explains observations and rewards.
"""

from __future__ import annotations

import os
from typing import Any

import gymnasium
import mujoco
import numpy as np

from ._batch import read_library

__all__ = ["TrackMotion"]

_TORQUE_ERROR = 0.5  #: [rad] off its target, a joint has its largest torque
_DAMPING_TIME = 0.025  #: [s] of damping over stiffness
_REACH = 0.5  #: [rad] that an action of one moves a target
_LOST_TILT, _LOST_WAY = 1.0, 0.5  #: [rad], heights of the robot


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
        task = self.library.base_task()
        self._robot = robot = task.robot
        kept = self.library.index.filter(self.library.index["kept"])["index"].to_pylist()
        self._indices = kept if motions is None else list(motions)
        if not self._indices:
            raise ValueError(f"{self.library.folder}: no motion was kept")
        self._motions: dict[int, dict[str, np.ndarray]] = {}
        self._model = mujoco.MjModel.from_xml_string(task.mujoco_xml())
        self._data = mujoco.MjData(self._model)
        self._steps = max(1, round(1.0 / (rate * self._model.opt.timestep)))
        self._period = self._steps * self._model.opt.timestep
        self._noise = noise
        self._height = float(robot.nominal_configuration[2])
        self._find_joints()
        self._drive()
        entries = 1 + 3 + 3 + 6 + 3 + 2 * robot.nu + len(robot.contacts) + 1
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (entries,), np.float64)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (robot.nu,), np.float32)

    def _find_joints(self) -> None:
        """Where MuJoCo has the robot's joints and their motors."""
        model = self._model
        joints = [mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, name) for name in self._robot.joint_names]
        self._q, self._v = model.jnt_qposadr[joints], model.jnt_dofadr[joints]
        motors = {int(model.actuator_trnid[i, 0]): i for i in range(model.nu)}
        self._motors = np.array([motors[joint] for joint in joints])

    def _drive(self) -> None:
        """Turns motors into drives: force = stiffness (control - q) - damping v, within the limit of the motor."""
        model = self._model
        limit = np.array(self._robot.torque_limit)
        finite = np.isfinite(limit)
        limit[~finite] = 10.0 * limit[finite].max() if finite.any() else self._robot.mass * 9.81 * self._height
        self._stiffness = limit / _TORQUE_ERROR
        self._damping = _DAMPING_TIME * self._stiffness
        model.actuator_gaintype[self._motors] = mujoco.mjtGain.mjGAIN_FIXED
        model.actuator_biastype[self._motors] = mujoco.mjtBias.mjBIAS_AFFINE
        model.actuator_gainprm[self._motors, 0] = self._stiffness
        model.actuator_biasprm[self._motors, 1] = -self._stiffness
        model.actuator_biasprm[self._motors, 2] = -self._damping
        model.actuator_ctrllimited[self._motors] = 0
        model.actuator_forcelimited[self._motors] = 1
        model.actuator_forcerange[self._motors, 0] = -limit
        model.actuator_forcerange[self._motors, 1] = limit

    def _motion(self, index: int) -> dict[str, np.ndarray]:
        """At the times of the actions."""
        if index not in self._motions:
            arrays = self.library.arrays(index)
            times = np.arange(int(arrays["t"][-1] / self._period) + 1) * self._period
            at = np.minimum(np.searchsorted(arrays["t"], times - 1e-9), len(arrays["t"]) - 1)
            motion = {name: arrays[name][at] for name in ("q", "v", "tau", "in_contact")}
            targets = motion["q"][:, 7:] + (motion["tau"] + self._damping * motion["v"][:, 6:]) / self._stiffness
            self._motions[index] = motion | {"targets": targets, "flags": motion["in_contact"].astype(float)}
        return self._motions[index]

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """options: {"motion": index} chooses one."""
        super().reset(seed=seed)
        index = (options or {}).get("motion")
        if index is None:
            index = self._indices[int(self.np_random.integers(len(self._indices)))]
        self._now, self._index = self._motion(index), index
        self._last = len(self._now["q"]) - 1
        self._k = 0
        mujoco.mj_resetData(self._model, self._data)
        q, v = self._now["q"][0], self._now["v"][0]
        qpos, qvel = self._data.qpos, self._data.qvel
        qpos[:3], qpos[3], qpos[4:7] = q[:3], q[6], q[3:6]
        qpos[self._q] = q[7:] + self._noise * self.np_random.standard_normal(self._robot.nu)
        mujoco.mju_rotVecQuat(qvel[:3], np.ascontiguousarray(v[:3]), np.ascontiguousarray(qpos[3:7]))
        qvel[3:6], qvel[self._v] = v[3:6], v[6:]
        mujoco.mj_forward(self._model, self._data)
        observation, _ = self._observe()
        return observation, {"motion": index}

    def step(self, action: np.ndarray) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One period of actions."""
        targets = self._now["targets"][self._k] + _REACH * np.clip(action, -1.0, 1.0)
        self._data.ctrl[self._motors] = targets
        mujoco.mj_step(self._model, self._data, self._steps)
        self._k += 1
        observation, (way, tilt, joints, rates) = self._observe()
        reward = (
            0.5 * np.exp(-20.0 * joints) + 0.3 * np.exp(-20.0 * (way * way + tilt * tilt)) + 0.2 * np.exp(-0.1 * rates)
        )
        terminated = bool(tilt > _LOST_TILT or way > _LOST_WAY)
        truncated = self._k >= self._last
        return observation, float(reward), terminated, truncated, {"motion": self._index}

    def _observe(self) -> tuple[np.ndarray, tuple[float, float, float, float]]:
        """Also errors: of the base in heights and rad, mean squares of those of the joints."""
        k, data = self._k, self._data
        q, v = self._now["q"][k], self._now["v"][k]
        w, x, y, z = data.qpos[3:7]
        axes = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        )
        off = (q[:3] - data.qpos[:3]) @ axes / self._height
        # The vector part of the turn from the base to its reference.
        rx, ry, rz, rw = q[3], q[4], q[5], q[6]
        turn = np.array(
            [
                w * rx - x * rw - y * rz + z * ry,
                w * ry + x * rz - y * rw - z * rx,
                w * rz - x * ry + y * rx - z * rw,
            ]
        )
        joints, rates = data.qpos[self._q] - q[7:], data.qvel[self._v] - v[6:]
        observation = np.concatenate(
            (
                [data.qpos[2] / self._height],
                off,
                turn,
                data.qvel[:3] @ axes,
                data.qvel[3:6],
                -axes[2],
                joints,
                rates,
                self._now["flags"][k],
                [k / self._last],
            )
        )
        tilt = 2.0 * float(np.arcsin(min(1.0, float(np.sqrt(turn @ turn)))))
        way = float(np.sqrt(off @ off))
        return observation, (way, tilt, float(joints @ joints) / len(joints), float(rates @ rates) / len(rates))


gymnasium.register(id="prowl/TrackMotion-v0", entry_point=TrackMotion)
