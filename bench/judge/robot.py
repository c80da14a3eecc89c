"""A robot file (docs/robot-file.md) as a Pinocchio model with its contacts, limits and start posture."""

import pathlib
import tomllib
from dataclasses import dataclass, field

import numpy as np
import pinocchio as pin
from scipy.interpolate import BSpline, make_interp_spline

GRAVITY = 9.81  # [m/s²]


@dataclass(frozen=True)
class Contact:
    name: str
    frame: int
    radius: float  # of the ball around the frame's origin [m]
    parent: str  # frame of the URDF
    offset: tuple[float, ...]  # of the ball in that [m]


@dataclass(frozen=True)
class Robot:
    urdf: pathlib.Path
    model: pin.Model
    contacts: tuple[Contact, ...]
    nominal: np.ndarray  # configuration at rest, mean of the contacts over the origin, lowest ball on z = 0
    torque_limit: np.ndarray  # both ways, one a joint [N m]
    # joint -> limits over its position, of positive and of negative torques
    torque_curves: dict[int, tuple[BSpline, BSpline]] = field(default_factory=dict)

    @property
    def joints(self) -> list[str]:
        return list(self.model.names)[2:]

    @property
    def weight(self) -> float:
        return GRAVITY * pin.computeTotalMass(self.model)

    def contact(self, name: str) -> Contact:
        return next(contact for contact in self.contacts if contact.name == name)

    def torque_bound(self, q: np.ndarray, tau: np.ndarray) -> np.ndarray:
        """Limit of every joint's torque at configuration q, in the direction of tau."""
        bound = self.torque_limit.copy()
        for joint, curves in self.torque_curves.items():
            bound[joint] = min(bound[joint], float(curves[int(tau[joint] < 0)](q[7 + joint])))
        return bound

    def places(self, q: np.ndarray) -> dict[str, np.ndarray]:
        """Centres of all contact balls in the world [m]."""
        data = self.model.createData()
        pin.framesForwardKinematics(self.model, data, q)
        return {contact.name: data.oMf[contact.frame].translation.copy() for contact in self.contacts}

    def moving(self, q: np.ndarray, base: np.ndarray, held: frozenset[str]) -> np.ndarray:
        """Velocity with this twist of the base whose joint rates keep the held contacts where they are."""
        v = np.concatenate([base, np.zeros(self.model.nv - 6)])
        if not base.any() or not held:
            return v
        data = self.model.createData()
        pin.computeJointJacobians(self.model, data, q)
        pin.updateFramePlacements(self.model, data)
        jacobian = np.vstack(
            [
                pin.getFrameJacobian(self.model, data, self.contact(name).frame, pin.LOCAL_WORLD_ALIGNED)[:3]
                for name in sorted(held)
            ]
        )
        v[6:] = -np.linalg.pinv(jacobian[:, 6:], rcond=1e-6) @ (jacobian[:, :6] @ base)
        return v


def limit_curve(table: list[list[float]]) -> BSpline:
    """The curve of prowl/model/limit_curve.hpp: a cubic B-spline through the points, its knots averages of theirs."""
    x, limit = np.array(table, dtype=float).T
    inner = [x[i : i + 3].mean() for i in range(1, len(x) - 3)]
    return make_interp_spline(x, limit, k=3, t=[x[0]] * 4 + inner + [x[-1]] * 4)


def read_contact(model: pin.Model, contact: dict) -> Contact:
    """On a frame of the URDF, or where the ball is beside it on one of its own, added to the model."""
    frame = model.getFrameId(contact["frame"])
    offset = np.array(contact.get("offset_m", [0, 0, 0]), dtype=float)
    if offset.any():
        parent = model.frames[frame]
        frame = model.addFrame(
            pin.Frame(
                f"contact {contact['name']}",
                parent.parentJoint,
                frame,
                parent.placement * pin.SE3(np.eye(3), offset),
                pin.FrameType.OP_FRAME,
            )
        )
    return Contact(contact["name"], frame, contact.get("radius_m", 0.0), contact["frame"], tuple(offset))


def find_urdf(text: str, robot_file: pathlib.Path, package_dirs: list[pathlib.Path]) -> pathlib.Path:
    if not text.startswith("package://"):
        return robot_file.parent / text
    tried = [folder / text.removeprefix("package://") for folder in package_dirs]
    for path in tried:
        if path.is_file():
            return path
    raise SystemExit(f"bench: {robot_file}: urdf {text} is in none of {', '.join(map(str, tried))}; give --package-dir")


def read_robot(robot_file: pathlib.Path, package_dirs: list[pathlib.Path]) -> Robot:
    table = tomllib.loads(robot_file.read_text())
    urdf = find_urdf(table["urdf"], robot_file, package_dirs)
    model = pin.buildModelFromUrdf(str(urdf), pin.JointModelFreeFlyer())
    joints = list(model.names)[2:]
    contacts = tuple(read_contact(model, contact) for contact in table["contact"])

    torque_limit, curves = np.array(model.effortLimit[6:]), {}
    lower, upper, speed = (
        np.array(limit) for limit in (model.lowerPositionLimit, model.upperPositionLimit, model.velocityLimit)
    )
    for joint, limits in table.get("limits", {}).items():
        j = joints.index(joint)
        torque_limit[j] = limits.get("torque_Nm", torque_limit[j])
        lower[7 + j], upper[7 + j] = limits.get("position_rad", (lower[7 + j], upper[7 + j]))
        speed[6 + j] = limits.get("velocity_radps", speed[6 + j])
        if "torque_over_position" in limits:
            both = limits["torque_over_position"]
            curves[j] = (limit_curve(both), limit_curve(limits.get("negative_torque_over_position", both)))
        known = {"torque_Nm", "position_rad", "velocity_radps", "torque_over_position", "negative_torque_over_position"}
        if unknown := set(limits) - known:
            raise SystemExit(f"bench: {robot_file}: limits.{joint}: {', '.join(unknown)} is not translated")
    model.lowerPositionLimit, model.upperPositionLimit, model.velocityLimit = lower, upper, speed

    if unknown := set(table["nominal"]) - {"joints"}:
        raise SystemExit(f"bench: {robot_file}: nominal: {', '.join(unknown)} is not translated")
    q = pin.neutral(model)
    for joint, value in table["nominal"]["joints"].items():
        q[7 + joints.index(joint)] = value
    robot = Robot(urdf, model, contacts, q, torque_limit, curves)
    places = robot.places(q)
    q[:2] = -np.mean([places[contact.name][:2] for contact in contacts], axis=0)
    q[2] = -min(places[contact.name][2] - contact.radius for contact in contacts)
    return robot
