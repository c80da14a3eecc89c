"""A task file (docs/task-file.md) as plain data: phases, goals, cost. tasks/**/*.toml is the only definition of a task.

What is not understood is an error, so that no part of a task is left out in silence.
"""

import dataclasses
import pathlib
import tomllib
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from judge.contact_dynamics import standing_torques
from judge.robot import Robot, read_robot

CLEARANCE = 0.05  # default swing clearance over the standing height of the base: docs/reference.md


PEERS_RATE = 40  # intervals in a second, where the task leaves the mesh to Prowl; even numbers: a node in the middle
BASE_VELOCITY = ("base_linear_velocity_mps", "base_angular_velocity_radps")


@dataclass(frozen=True)
class Phase:
    name: str
    contacts: frozenset[str]
    duration: float  # [s]; of a free one the middle of its range, until with_durations()
    duration_range: tuple[float, float]  # equal where it is fixed [s]
    intervals: int
    places: dict[str, np.ndarray]  # where contacts have to touch, by name, on the floor [m]


@dataclass(frozen=True)
class Goal:
    """At `fraction` of phase `phase`. NaN entries are free. Rotation: axis i of the base counts where `turn` says so."""

    phase: int
    fraction: float
    position: np.ndarray  # of the base, world [m]
    rotation: np.ndarray | None  # of the base
    turn: np.ndarray  # bool, 3
    velocity: np.ndarray  # of the base: linear, angular, base frame, 6


@dataclass(frozen=True)
class Cost:
    """1/2 ∫ Σ weight x difference² dt, about the start at rest and the torques `torque_reference`."""

    configuration: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    torque: np.ndarray
    torque_reference: np.ndarray
    force: np.ndarray  # of each contact, world x y z
    time: float


@dataclass(frozen=True)
class MotionTask:
    name: str
    robot: Robot
    start: np.ndarray
    velocity: np.ndarray  # at the start
    friction: float
    floor: float  # height of the ground over the world's origin [m]
    normal: np.ndarray  # of the ground, unit length
    clearance: float  # [m]
    phases: tuple[Phase, ...]
    goals: tuple[Goal, ...]
    cost: Cost

    @property
    def duration(self) -> float:
        return sum(phase.duration for phase in self.phases)

    @property
    def intervals(self) -> int:
        return sum(phase.intervals for phase in self.phases)

    def height(self, place: np.ndarray) -> float:
        """Distance of a point from the ground, negative inside it [m]."""
        return float(self.normal @ (place - [0.0, 0.0, self.floor]))

    @property
    def ground_axes(self) -> np.ndarray:
        """Columns: x turned into the plane, across, normal; the world's axes on a level floor."""
        along = np.array([1.0, 0.0, 0.0]) - self.normal[0] * self.normal
        along /= np.linalg.norm(along)
        return np.column_stack([along, np.cross(self.normal, along), self.normal])

    def free_durations(self) -> bool:
        return any(phase.duration_range[0] < phase.duration_range[1] for phase in self.phases)

    def with_durations(self, durations: list[float]) -> "MotionTask":
        phases = tuple(
            dataclasses.replace(phase, duration=duration)
            for phase, duration in zip(self.phases, durations, strict=True)
        )
        return dataclasses.replace(self, phases=phases)

    def opens(self, phase: int) -> frozenset[str]:
        """Contacts that hold in this phase and not in the next."""
        return (
            self.phases[phase].contacts - self.phases[phase + 1].contacts
            if phase + 1 < len(self.phases)
            else frozenset()
        )

    def lands(self, phase: int) -> frozenset[str]:
        """Contacts that hold in this phase and not in the one before."""
        return self.phases[phase].contacts - self.phases[phase - 1].contacts if phase > 0 else frozenset()

    def swing_height(self, contact: str, phase: int, fraction: float) -> float:
        """Least height of an open contact's ball over the floor: c 16 s²(1 - s)², c s² if it does not land (docs/transcription.md),
        with s counted in time, which is the planner's where all intervals of a swing are equally long."""
        is_open = [contact not in p.contacts for p in self.phases]
        first = last = phase
        while first > 0 and is_open[first - 1]:
            first -= 1
        while last + 1 < len(self.phases) and is_open[last + 1]:
            last += 1
        lengths = [p.duration for p in self.phases]
        s = (sum(lengths[first:phase]) + fraction * lengths[phase]) / sum(lengths[first : last + 1])
        if first == 0:
            return 0.0
        if last + 1 == len(self.phases):
            return self.clearance * s**2
        return self.clearance * 16 * s**2 * (1 - s) ** 2


def _known(table: dict, keys: set[str], where: str) -> None:
    if unknown := set(table) - keys:
        raise SystemExit(f"bench: {where}: {', '.join(sorted(unknown))} is not translated for the peers")


def _numbers(entries, where: str) -> np.ndarray:
    """Numbers with NaN for "free"."""
    if any(isinstance(entry, list) for entry in entries):
        raise SystemExit(f"bench: {where}: a range [min, max] is not translated for the peers")
    return np.array([np.nan if entry == "free" else float(entry) for entry in entries])


def _read_phase(table: dict, index: int, robot: Robot, where: str) -> Phase:
    _known(table, {"name", "contacts", "duration_s", "intervals"}, where)
    names, places = [], {}
    contacts = table["contacts"]
    for entry in [contact.name for contact in robot.contacts] if contacts == "all" else contacts:
        entry = {"contact": entry} if isinstance(entry, str) else entry
        _known(entry, {"contact", "surface", "place_m"}, where)
        names.append(entry["contact"])
        if "place_m" in entry:
            places[entry["contact"]] = np.array(entry["place_m"], dtype=float)
    span = table["duration_s"]
    low, high = span if isinstance(span, list) else (span, span)
    return Phase(
        table.get("name", f"phase {index + 1}"),
        frozenset(names),
        (low + high) / 2,
        (low, high),
        table.get("intervals", 2 * round(0.5 * PEERS_RATE * (low + high) / 2)),
        places,
    )


def _read_goal(table: dict, phases: list[Phase], start: np.ndarray, where: str) -> Goal:
    _known(
        table,
        {
            "time_s",
            "phase",
            "fraction",
            "base_position_m",
            "base_displacement_m",
            "base_rpy_rad",
            "base_linear_velocity_mps",
            "base_angular_velocity_radps",
        },
        where,
    )
    if "phase" in table:
        phase, fraction = [p.name for p in phases].index(table["phase"]), table.get("fraction", 1.0)
    else:
        ends = np.cumsum([p.duration for p in phases])
        phase = int(np.searchsorted(ends, table["time_s"] - 1e-9))
        fraction = (table["time_s"] - ends[phase] + phases[phase].duration) / phases[phase].duration
    free = ["free"] * 3
    position = _numbers(table.get("base_position_m", free), where)
    if "base_displacement_m" in table:
        position = start[:3] + _numbers(table["base_displacement_m"], where)
    angles = _numbers(table.get("base_rpy_rad", free), where)
    turn = ~np.isnan(angles)
    reference = np.where(turn, angles, pin.rpy.matrixToRpy(pin.Quaternion(start[3:7]).matrix()))
    velocity = np.concatenate(
        [_numbers(table.get(key, free), where) for key in ("base_linear_velocity_mps", "base_angular_velocity_radps")]
    )
    return Goal(phase, fraction, position, pin.rpy.rpyToMatrix(*reference) if turn.any() else None, turn, velocity)


def _read_cost(table: dict, robot: Robot, start: np.ndarray, first_contacts: frozenset[str], where: str) -> Cost:
    scalars = {
        f"{body}_{what}" for body in ("base_linear", "base_angular", "joint") for what in ("velocity", "acceleration")
    }
    scalars |= {"base_position", "base_orientation", "joint_position", "torque"}
    _known(table, scalars | {"time", "torque_reference", "force"}, where)
    n = len(robot.joints)

    def weights(linear: str, angular: str, joint: str) -> np.ndarray:
        return np.concatenate(
            [np.full(3, table.get(linear, 0.0)), np.full(3, table.get(angular, 0.0)), np.full(n, table.get(joint, 0.0))]
        )

    static = table.get("torque_reference", "static") == "static"
    return Cost(
        configuration=weights("base_position", "base_orientation", "joint_position"),
        velocity=weights("base_linear_velocity", "base_angular_velocity", "joint_velocity"),
        acceleration=weights("base_linear_acceleration", "base_angular_acceleration", "joint_acceleration"),
        torque=np.full(n, table.get("torque", 0.0)),
        torque_reference=standing_torques(robot, start, first_contacts) if static else np.zeros(n),
        force=np.broadcast_to(np.array(table.get("force", 0.0), dtype=float), 3),
        time=table.get("time", 0.0),
    )


def _read_ground(table: dict, where: str) -> tuple[dict, np.ndarray, np.ndarray]:
    """The one surface, its unit normal and its point."""
    surfaces = table.get("surface", [{"name": "floor"}])
    if len(surfaces) > 1 or "patch_m" in surfaces[0]:
        raise SystemExit(f"bench: {where}: only one surface, without an edge, is translated for the peers")
    normal = np.array(surfaces[0].get("normal", [0, 0, 1]), dtype=float)
    return surfaces[0], normal / np.linalg.norm(normal), np.array(surfaces[0].get("point_m", [0, 0, 0]), dtype=float)


def _put_on(normal: np.ndarray, point: np.ndarray, level: np.ndarray) -> np.ndarray:
    """A posture on level ground, turned the shortest way to a slope; what was at the origin comes to `point`."""
    q, turn = level.copy(), pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), normal)
    q[:3] = point + turn.matrix() @ level[:3]
    q[3:7] = (turn * pin.Quaternion(level[3:7])).coeffs()
    return q


def _base_velocity(placed: dict) -> np.ndarray:
    return np.concatenate([np.array(placed.get(key, [0, 0, 0]), dtype=float) for key in BASE_VELOCITY])


def parse_task(table: dict, folder: pathlib.Path, package_dirs: list[pathlib.Path], where: str) -> MotionTask:
    """`folder`: that paths are relative to. `where`: for messages."""
    _known(
        table,
        {"name", "robot", "surface", "start", "phase", "goal", "cost", "swing_clearance_m", "tracking", "simulation"},
        where,
    )
    robot = read_robot(folder / table["robot"], package_dirs)
    ground, normal, point = _read_ground(table, where)
    height = robot.nominal[2]
    phases = [_read_phase(phase, i, robot, where) for i, phase in enumerate(table["phase"])]

    placed = table.get("start", {})
    _known(placed, {"on", *BASE_VELOCITY}, f"{where}: start")
    if normal[2] < 1.0 and ("on" not in placed or any(phase.contacts != phases[0].contacts for phase in phases)):
        raise SystemExit(
            f"bench: {where}: of tasks that do not begin with [start] on = their slope, or where contacts open, "
            "only those on a level floor are translated for the peers"
        )
    start = robot.nominal + np.append([0.0, 0.0, point[2]], np.zeros(robot.model.nq - 3))
    if placed:
        start = _put_on(normal, point, robot.nominal)
    goals = tuple(_read_goal(goal, phases, start, where) for goal in table.get("goal", []))
    return MotionTask(
        table.get("name", where),
        robot,
        start,
        robot.moving(start, _base_velocity(placed), phases[0].contacts),
        ground.get("friction", 0.5),
        float(normal @ point / normal[2]),
        normal,
        table.get("swing_clearance_m", CLEARANCE * height),
        tuple(phases),
        goals,
        _read_cost(table.get("cost", {}), robot, start, phases[0].contacts, where),
    )


def read_task(task_file: pathlib.Path, package_dirs: list[pathlib.Path]) -> MotionTask:
    table = tomllib.loads(task_file.read_text())
    return parse_task({"name": task_file.stem, **table}, task_file.parent, package_dirs, str(task_file))
