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


@dataclass(frozen=True)
class Robot:
    model: pin.Model
    contacts: tuple[Contact, ...]
    nominal: np.ndarray          # configuration at rest, base over the origin, lowest contact ball on z = 0
    torque_limit: np.ndarray     # both ways, one a joint [N m]
    torque_curves: dict[int, BSpline] = field(default_factory=dict)  # joint -> limit over its position

    @property
    def joints(self) -> list[str]:
        return list(self.model.names)[2:]

    @property
    def weight(self) -> float:
        return GRAVITY * pin.computeTotalMass(self.model)

    def contact(self, name: str) -> Contact:
        return next(contact for contact in self.contacts if contact.name == name)

    def torque_bound(self, q: np.ndarray) -> np.ndarray:
        """Limit of every joint's torque at configuration q, both ways."""
        bound = self.torque_limit.copy()
        for joint, curve in self.torque_curves.items():
            bound[joint] = min(bound[joint], float(curve(q[7 + joint])))
        return bound

    def places(self, q: np.ndarray) -> dict[str, np.ndarray]:
        """Centres of all contact balls in the world [m]."""
        data = self.model.createData()
        pin.framesForwardKinematics(self.model, data, q)
        return {contact.name: data.oMf[contact.frame].translation.copy() for contact in self.contacts}


def limit_curve(table: list[list[float]]) -> BSpline:
    """The curve of prowl/model/limit_curve.hpp: a cubic B-spline through the points, its knots averages of theirs."""
    x, limit = np.array(table, dtype=float).T
    inner = [x[i : i + 3].mean() for i in range(1, len(x) - 3)]
    return make_interp_spline(x, limit, k=3, t=[x[0]] * 4 + inner + [x[-1]] * 4)


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
    for contact in table["contact"]:
        if contact.get("offset_m", [0, 0, 0]) != [0, 0, 0]:
            raise SystemExit(f"bench: {robot_file}: contact {contact['name']} has an offset_m, which is not translated")
    contacts = tuple(Contact(c["name"], model.getFrameId(c["frame"]), c.get("radius_m", 0.0)) for c in table["contact"])

    torque_limit, curves = np.array(model.effortLimit[6:]), {}
    for joint, limits in table.get("limits", {}).items():
        j = joints.index(joint)
        torque_limit[j] = limits.get("torque_Nm", torque_limit[j])
        if "torque_over_position" in limits:
            curves[j] = limit_curve(limits["torque_over_position"])
        if unknown := set(limits) - {"torque_Nm", "torque_over_position"}:
            raise SystemExit(f"bench: {robot_file}: limits.{joint}: {', '.join(unknown)} is not translated")

    q = pin.neutral(model)
    for joint, value in table["nominal"]["joints"].items():
        q[7 + joints.index(joint)] = value
    robot = Robot(model, contacts, q, torque_limit, curves)
    places = robot.places(q)
    q[2] = -min(places[contact.name][2] - contact.radius for contact in contacts)
    return robot
