"""Crocoddyl's motion and gains in the place of Prowl's, to be judged as those are."""

import pathlib
import struct
import subprocess
import sys
import tempfile

from shipped_tasks import ROOT

sys.path[:0] = [str(ROOT / "build/python"), str(ROOT / "bench")]
import numpy as np  # noqa: E402  (after the path)
import pinocchio  # noqa: E402
from peers.environment import ENVIRONMENT, install, variables  # noqa: E402
from prowl import Tracker, difference, integrate, read_plan  # noqa: E402

HEADER = "<8s6I2Q"  # prowl/tracker/file_format.hpp


def checksum(payload: bytes) -> int:
    """As prowl/tracker/file_format.hpp has it."""
    value = 0xCBF29CE484222325
    for word in np.frombuffer(payload + bytes(-len(payload) % 8), dtype="<u8").tolist():
        value = ((value ^ word) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return value


def replace_motion(file: pathlib.Path, arrays: list[np.ndarray]) -> None:
    """Of tracker.bin: q, v, tau and gains, which end the file; schedule, names and limits stay."""
    raw = file.read_bytes()
    start = struct.calcsize(HEADER)
    head = list(struct.unpack(HEADER, raw[:start]))
    motion = b"".join(np.ascontiguousarray(array, dtype="<f8").tobytes() for array in arrays)
    payload = raw[start : len(raw) - len(motion)] + motion
    head[-1] = checksum(payload)
    file.write_bytes(struct.pack(HEADER, *head) + payload)


def sampled(tracker: Tracker, joints: list[str], solved: dict[str, np.ndarray]) -> list[np.ndarray]:
    """q, v, tau and gains at the samples of a tracker, in its order of joints: states on straight lines between nodes."""
    nu = len(joints)
    order = [list(solved["joints"]).index(joint) for joint in joints]
    configuration = [*range(7), *(7 + i for i in order)]
    velocity = [*range(6), *(6 + i for i in order)]
    time = solved["time"]
    q = solved["states"][:, : 7 + nu][:, configuration]
    v = solved["states"][:, 7 + nu :][:, velocity]
    torques = solved["torques"][:, order]
    gains = solved["gains"][:, order][:, :, [*velocity, *(6 + nu + i for i in velocity)]]
    nodes = np.clip(np.searchsorted(time, tracker.t, side="right") - 1, 0, len(time) - 2)
    parts = (tracker.t - time[nodes]) / (time[nodes + 1] - time[nodes])
    all_q, all_gains = [], []
    for k, part in zip(nodes, parts, strict=True):
        all_q.append(integrate(q[k], part * difference(q[k], q[k + 1])))
        gain = gains[k].copy()
        gain[:, :3] @= pinocchio.XYZQUATToSE3(q[k][:7]).rotation.T  # Pinocchio displaces the base along its own axes
        all_gains.append(gain.T)  # column by column
    return [
        np.array(all_q),
        v[nodes] + parts[:, None] * (v[nodes + 1] - v[nodes]),
        torques[nodes],
        np.array(all_gains),
    ]


def replace_tracker(task: pathlib.Path, folder: pathlib.Path) -> None:
    """Of a plan of the task: tracker.bin gets what Crocoddyl finds for it, with the durations of the plan."""
    plan = read_plan(folder)
    ends = [np.flatnonzero(plan.phase == p)[-1] for p in range(plan.phase.max() + 1)]
    durations = np.diff([0.0, *(plan.t[end] for end in ends)])
    install(ENVIRONMENT)
    with tempfile.TemporaryDirectory() as scratch:
        out = pathlib.Path(scratch) / "crocoddyl.npz"
        subprocess.run(
            [ENVIRONMENT / "bin/python", "-m", "peers.crocoddyl_feedback", task, out, *map(str, durations)],
            env=variables(),
            check=True,
        )
        with np.load(out) as solved:
            arrays = sampled(plan.tracker, plan.robot.joint_names, dict(solved))
    replace_motion(folder / "tracker.bin", arrays)
