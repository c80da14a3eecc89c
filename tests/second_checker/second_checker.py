"""A second opinion on a plan: dynamics by MuJoCo from the URDF, limits and goals by a reading of its own of the TOML files.

It shares no code with Prowl. It reads `trajectory.csv` and checks at each node: equation of motion, contacts on their
surface, friction, torques, ranges of joints; and the goals on the base, and limits of terms. Robots with point contacts.
"""

import csv
import pathlib
import tomllib
import xml.etree.ElementTree

import mujoco
import numpy as np
from scipy.interpolate import PchipInterpolator

GRAVITY = 9.81
# Shares of the weight (forces), of the limit (torques), and [m, rad, m/s].
FORCE, BALANCE, TORQUE, POSITION, ANGLE, RATE, RANGE = 0.01, 1e-4, 0.02, 1e-3, 1e-3, 5e-3, 1e-3
SLOW = 0.05  # of a joint, over which dry friction is smoothed [rad/s]


def numbers(element, name: str, otherwise: str) -> np.ndarray:
    return np.array([float(x) for x in (otherwise if element is None else element.get(name, otherwise)).split()])


def merge_inertias(root: xml.etree.ElementTree.Element, carriers: dict, payloads: list) -> None:
    """Gives each moving link the inertia of those fixed to it: MuJoCo refuses links that are not physical alone."""
    masses, moments, tensors = {}, {}, {}  # moments and tensors about the origin of the carrier
    links = {link.get("name"): link for link in root.findall("link")}
    for name, link in links.items():
        inertial = link.find("inertial")
        if inertial is None:
            continue
        link.remove(inertial)
        carrier, place = carriers[name]
        origin, entries = inertial.find("origin"), inertial.find("inertia")
        mass = float(inertial.find("mass").get("value"))
        center = (place @ [*numbers(origin, "xyz", "0 0 0"), 1])[:3]
        turn = place[:3, :3] @ from_rpy(*numbers(origin, "rpy", "0 0 0"))
        xx, xy, xz, yy, yz, zz = (float(entries.get(f"i{axes}")) for axes in ("xx", "xy", "xz", "yy", "yz", "zz"))
        own = turn @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ turn.T
        masses[carrier] = masses.get(carrier, 0) + mass
        moments[carrier] = moments.get(carrier, 0) + mass * center
        tensors[carrier] = (
            tensors.get(carrier, 0) + own + mass * (center @ center * np.eye(3) - np.outer(center, center))
        )
    for payload in payloads:
        carrier, place = carriers[payload["body"]]
        mass, center = payload["mass_kg"], (place @ [*payload.get("com_m", (0, 0, 0)), 1])[:3]
        masses[carrier] += mass
        moments[carrier] += mass * center
        tensors[carrier] += mass * (center @ center * np.eye(3) - np.outer(center, center))
    for name, mass in masses.items():
        center = moments[name] / mass
        tensor = tensors[name] - mass * (center @ center * np.eye(3) - np.outer(center, center))
        inertial = xml.etree.ElementTree.SubElement(links[name], "inertial")
        xml.etree.ElementTree.SubElement(inertial, "origin", xyz=" ".join(map(repr, center.tolist())))
        xml.etree.ElementTree.SubElement(inertial, "mass", value=repr(float(mass)))
        entries = {f"i{'xyz'[i]}{'xyz'[j]}": repr(float(tensor[i, j])) for i in range(3) for j in range(i, 3)}
        xml.etree.ElementTree.SubElement(inertial, "inertia", entries)


def floating(urdf: pathlib.Path, payloads: list) -> tuple[mujoco.MjModel, dict, dict]:
    """The robot without shapes on a free base; limits of its joints; the moving link and the place on it of each link."""
    root = xml.etree.ElementTree.parse(urdf).getroot()
    for link in root.iter("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            link.remove(shape)
    compiler = '<mujoco><compiler fusestatic="true" balanceinertia="true" discardvisual="true"/></mujoco>'
    root.append(xml.etree.ElementTree.fromstring(compiler))
    joints = root.findall("joint")
    above = {joint.find("child").get("link"): joint for joint in joints}
    limits = {}
    for joint in joints:
        if joint.get("type") == "revolute":
            limit = joint.find("limit")
            limits[joint.get("name")] = {
                name: float(limit.get(name)) for name in ("lower", "upper", "effort", "velocity")
            }
    carriers = {}
    for link in root.findall("link"):
        name, place = link.get("name"), np.eye(4)
        while name in above and above[name].get("type") == "fixed":
            origin = above[name].find("origin")
            step = np.eye(4)
            step[:3, 3] = numbers(origin, "xyz", "0 0 0")
            step[:3, :3] = from_rpy(*numbers(origin, "rpy", "0 0 0"))
            place, name = step @ place, above[name].find("parent").get("link")
        carriers[link.get("name")] = (name, place)
    merge_inertias(root, carriers, payloads)
    spec = mujoco.MjSpec.from_string(xml.etree.ElementTree.tostring(root, encoding="unicode"))
    spec.bodies[1].add_freejoint()
    return spec.compile(), limits, carriers


def rotation(xyzw: np.ndarray) -> np.ndarray:
    matrix = np.empty(9)
    mujoco.mju_quat2Mat(matrix, np.roll(xyzw, 1))
    return matrix.reshape(3, 3)


def from_rpy(roll: float, pitch: float, yaw: float) -> np.ndarray:
    (a, b), (c, d), (e, f) = ((np.cos(x), np.sin(x)) for x in (roll, pitch, yaw))
    return (
        np.array([[e, -f, 0], [f, e, 0], [0, 0, 1]])
        @ np.array([[c, 0, d], [0, 1, 0], [-d, 0, c]])
        @ np.array([[1, 0, 0], [0, a, -b], [0, b, a]])
    )


def angle_between(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.arccos(np.clip((np.trace(one.T @ other) - 1) / 2, -1, 1)))


class Plan:
    """What the files say: states and forces at the nodes."""

    def __init__(self, folder: pathlib.Path, task: pathlib.Path, packages: pathlib.Path):
        self.task = tomllib.loads(task.read_text())
        robot_file = (task.parent / self.task["robot"]).resolve()
        self.robot = tomllib.loads(robot_file.read_text())
        urdf = packages / self.robot["urdf"].removeprefix("package://")
        self.model, self.limits, self.carriers = floating(urdf, self.task.get("payload", []))
        self.model.opt.gravity[:] = (0, 0, -GRAVITY)
        # Motors make up for both losses, and their torque is limited; the plan's torque moves the links.
        self.damping, self.friction = self.model.dof_damping.copy(), self.model.dof_frictionloss.copy()
        self.model.dof_damping[:] = self.model.dof_frictionloss[:] = 0
        self.data = mujoco.MjData(self.model)
        with (folder / "trajectory.csv").open() as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        names = list(rows[0])
        self.joints = [name[2:-4] for name in names if name.startswith("q_")]
        self.columns = {name: np.array([float(row[name] or "nan") for row in rows]) for name in names}
        self.count = len(rows)
        self.weight = mujoco.mj_getTotalmass(self.model) * GRAVITY
        self.address = [self.model.joint(name).dofadr[0] for name in self.joints]
        self.locked = [self.model.joint(name).dofadr[0] for name in self.robot.get("locked_joints", [])]
        nominal = self.robot["nominal"]["joints"]
        self.locked_at = [nominal.get(name, 0.0) for name in self.robot.get("locked_joints", [])]
        floor = {"name": "floor", "friction": 0.5}
        self.surfaces = {surface["name"]: surface for surface in self.task.get("surface", [floor])}

    def at(self, k: int, *names: str) -> np.ndarray:
        return np.array([self.columns[name][k] for name in names])

    def of_joints(self, k: int, kind: str, unit: str) -> np.ndarray:
        return self.at(k, *(f"{kind}_{name}_{unit}" for name in self.joints))

    def held(self, k: int) -> dict[str, dict]:
        """Contacts that the task holds at a node, with their surfaces. Of a gait, those that the plan holds."""
        names = [contact["name"] for contact in self.robot["contact"]]
        first = next(iter(self.surfaces.values()))
        if "phase" not in self.task:
            return {name: first for name in names if self.columns[f"contact_{name}"][k] == 1}
        held = self.task["phase"][int(self.columns["phase"][k])]["contacts"]
        if held == "all":
            return dict.fromkeys(names, first)
        of = [one if isinstance(one, dict) else {"contact": one} for one in held]
        return {one["contact"]: self.surfaces[one["surface"]] if "surface" in one else first for one in of}

    def phase(self, entry: dict) -> int:
        """Number of the phase that a goal or a term names."""
        names = [phase.get("name", f"phase {i + 1}") for i, phase in enumerate(self.task["phase"])]
        return names.index(entry["phase"]) if isinstance(entry["phase"], str) else entry["phase"] - 1

    def when(self, entry: dict) -> tuple[float, float]:
        """First and last time of a goal or a term."""
        numbered, times = self.columns["phase"], self.columns["time_s"]
        if "time_s" in entry:
            return tuple(entry["time_s"]) if isinstance(entry["time_s"], list) else (entry["time_s"],) * 2
        if "phase" not in entry:
            return times[0], times[-1]
        within = times[numbered == self.phase(entry)]
        start, end = within.min(), within.max()
        if "fraction" in entry:
            return (start + entry["fraction"] * (end - start),) * 2
        return start, end

    def pose(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        place = self.at(k, *(f"base_p{axis}_m" for axis in "xyz"))
        return place, rotation(self.at(k, *(f"base_q{axis}" for axis in "xyzw")))

    def twist(self, k: int) -> tuple[np.ndarray, np.ndarray]:
        return self.at(k, *(f"base_v{a}_mps" for a in "xyz")), self.at(k, *(f"base_w{a}_radps" for a in "xyz"))


def residual(plan: Plan, k: int) -> float:
    """Largest generalised force that torques and contact forces leave over [N, N m]. Sets the posture of the node."""
    model, data = plan.model, plan.data
    place, turn = plan.pose(k)
    linear, angular = plan.twist(k)
    data.qpos[:3] = place
    data.qpos[3:7] = np.roll(plan.at(k, *(f"base_q{axis}" for axis in "xyzw")), 1)
    data.qvel[:3], data.qvel[3:6] = turn @ linear, angular
    rates = plan.at(k, *(f"base_a{a}_mps2" for a in "xyz"))
    data.qacc[:3] = turn @ (rates + np.cross(angular, linear))
    data.qacc[3:6] = plan.at(k, *(f"base_dw{a}_radps2" for a in "xyz"))
    for kind, unit, to in (("q", "rad", data.qpos[1:]), ("v", "radps", data.qvel), ("a", "radps2", data.qacc)):
        to[plan.address] = plan.of_joints(k, kind, unit)
    data.qpos[1:][plan.locked] = plan.locked_at
    acceleration = data.qacc.copy()
    mujoco.mj_forward(model, data)
    data.qacc[:] = acceleration
    mujoco.mj_inverse(model, data)
    left = data.qfrc_inverse.copy()
    left[plan.address] -= plan.of_joints(k, "tau", "Nm")
    jacobian = np.empty((3, model.nv))
    for contact in plan.robot["contact"]:
        force = plan.at(k, *(f"f_{contact['name']}_{axis}_N" for axis in "xyz"))
        carrier, _ = plan.carriers[contact["frame"]]
        mujoco.mj_jac(model, data, jacobian, None, point(plan, contact), model.body(carrier).id)
        left -= jacobian.T @ np.nan_to_num(force)
    left[plan.locked] = 0
    return float(np.abs(left).max())


def point(plan: Plan, contact: dict) -> np.ndarray:
    """Of the contact, in the posture that was set last."""
    carrier, place = plan.carriers[contact["frame"]]
    body = plan.data.body(carrier)
    return body.xpos + body.xmat.reshape(3, 3) @ (place @ [*contact.get("offset_m", (0, 0, 0)), 1])[:3]


def largest_torque(plan: Plan, joint: str, position: float, torque: float) -> float:
    """In the direction of the torque."""
    own = plan.robot.get("limits", {}).get(joint, {})
    largest = own.get("torque_Nm", plan.limits[joint]["effort"])
    table = own.get("torque_over_position")
    if torque < 0:
        table = own.get("negative_torque_over_position", table)
    if table:
        largest = min(largest, float(PchipInterpolator(*np.array(table).T)(position)))
    return largest


def check_node(plan: Plan, k: int) -> set[str]:
    """Names of what is wrong."""
    wrong = set()
    if not residual(plan, k) <= BALANCE * plan.weight:  # NaN, too
        wrong.add("equation of motion")
    held = plan.held(k)
    for contact in plan.robot["contact"]:
        holds = contact["name"] in held
        if holds != (plan.columns[f"contact_{contact['name']}"][k] == 1):
            wrong.add("schedule")
        if not holds:
            if np.abs(np.nan_to_num(plan.at(k, *(f"f_{contact['name']}_{axis}_N" for axis in "xyz")))).max() > 0:
                wrong.add("force without contact")
            continue
        surface = held[contact["name"]]
        normal = np.array(surface.get("normal", (0, 0, 1)), float)
        normal /= np.linalg.norm(normal)
        height = normal @ (point(plan, contact) - surface.get("point_m", (0, 0, 0))) - contact.get("radius_m", 0)
        if not abs(height) <= POSITION:
            wrong.add("contact on its surface")
        force = plan.at(k, *(f"f_{contact['name']}_{axis}_N" for axis in "xyz"))
        across, along = np.linalg.norm(force - normal @ force * normal), normal @ force
        allowed = surface.get("friction", 0.5) * along + FORCE * plan.weight
        if not across <= allowed or not along >= -FORCE * plan.weight:
            wrong.add("friction cone")
    for joint, q, v, tau in zip(
        plan.joints,
        plan.of_joints(k, "q", "rad"),
        plan.of_joints(k, "v", "radps"),
        plan.of_joints(k, "tau", "Nm"),
        strict=True,
    ):
        limit = plan.limits[joint]
        if not limit["lower"] - RANGE <= q <= limit["upper"] + RANGE or not abs(v) <= limit["velocity"] + RANGE:
            wrong.add("range of a joint")
        degree = plan.model.joint(joint).dofadr[0]
        motor = tau + plan.damping[degree] * v + plan.friction[degree] * np.tanh(v / SLOW)
        if not abs(motor) <= (1 + TORQUE) * largest_torque(plan, joint, q, motor):
            wrong.add("torque")
    return wrong


def check_goals(plan: Plan) -> set[str]:
    """Goals on the base, from the start posture; angles "free" and ranges are left out."""
    wrong = set()
    start, _ = plan.pose(0)
    times = plan.columns["time_s"]
    for goal in plan.task.get("goal", []):
        _, time = plan.when(goal)
        k = int(np.abs(times - time).argmin())
        place, turn = plan.pose(k)
        if abs(times[k] - time) > 1e-9:
            wrong.add("time of a goal")
        if (
            "base_displacement_m" in goal
            and "free" not in goal["base_displacement_m"]
            and np.abs(place - start - goal["base_displacement_m"]).max() > POSITION
        ):
            wrong.add("goal")
        if "base_rpy_rad" in goal and angle_between(from_rpy(*goal["base_rpy_rad"]), turn) > ANGLE:
            wrong.add("goal")
        for key, value in zip(("base_linear_velocity_mps", "base_angular_velocity_radps"), plan.twist(k), strict=True):
            if key in goal and np.abs(value - goal[key]).max() > RATE:
                wrong.add("goal")
    return wrong


def link(plan: Plan, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Position and rotation of a link, in the posture that was set last."""
    carrier, place = plan.carriers.get(name, (plan.model.body(1).name, np.eye(4)))  # "base": the first moving link
    body = plan.data.body(carrier)
    turn = body.xmat.reshape(3, 3)
    return body.xpos + turn @ place[:3, 3], turn @ place[:3, :3]


def outside(values, bounds) -> float:
    """How far numbers are beyond numbers, ranges or "free"."""
    worst = 0.0
    for value, bound in zip(values, bounds, strict=True):
        if bound == "free":
            continue
        low, high = bound if isinstance(bound, list) else (bound, bound)
        worst = max(worst, 0.0 if low == "free" else low - value, 0.0 if high == "free" else value - high)
    return worst


def excess(plan: Plan, k: int, term: dict, own: dict) -> tuple[float, float]:
    """How far a term is beyond its limits at a node, and what is allowed. `own`: functions of the terms of one's own."""
    place, turn = link(plan, term.get("frame", "base"))
    if "relative_to" in term:
        other, axes = link(plan, term["relative_to"])
        place, turn = axes.T @ (place - other), axes.T @ turn
    if "position_m" in term:
        return outside(place, term["position_m"]), POSITION
    if "orientation_rpy_rad" in term:
        angle = angle_between(from_rpy(*term["orientation_rpy_rad"]), turn)
        return angle - np.sqrt(3) * term.get("within_rad", 0), ANGLE
    if "axis" in term:
        axis = turn @ term["axis"]
        to = np.array(term["points_along"] if "points_along" in term else term["points_at_m"] - place, float)
        angle = np.arccos(np.clip(axis @ to / np.linalg.norm(axis) / np.linalg.norm(to), -1, 1))
        return angle - np.sqrt(2) * term.get("within_rad", 0), ANGLE
    if "force_N" in term:
        force = plan.at(k, *(f"f_{term['contact']}_{axis}_N" for axis in "xyz"))
        return outside(np.nan_to_num(force), term["force_N"]), FORCE * plan.weight
    if "com_m" in term:
        return outside(plan.data.subtree_com[1], term["com_m"]), POSITION
    return outside(own[term["own"]](plan), term["value"]), POSITION


def check_terms(plan: Plan, k: int, own: dict) -> set[str]:
    """Limits of terms, in the posture that was set last. Costs are left out."""
    wrong, time, phase = set(), plan.columns["time_s"][k], plan.columns["phase"][k]
    for term in plan.task.get("term", []):
        first, last = plan.when(term)
        is_elsewhere = "phase" in term and phase != plan.phase(term)  # both nodes of a phase transition have its time
        if "weight" in term or is_elsewhere or not first - 1e-9 <= time <= last + 1e-9:
            continue
        beyond, allowed = excess(plan, k, term, own)
        if not beyond <= allowed:
            wrong.add(f"term {term['name']}")
    return wrong


def check(plan: Plan, own: dict | None = None) -> set[str]:
    wrong = check_goals(plan)
    for k in range(plan.count):
        wrong |= check_node(plan, k) | check_terms(plan, k, own or {})
    return wrong
