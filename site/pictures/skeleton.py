"""A robot as lines between its joints, from its URDF and the columns of trajectory.csv."""

import xml.etree.ElementTree as ElementTree

import numpy as np
from scipy.spatial.transform import Rotation


class Skeleton:
    """Serial legs of revolute joints on a base, which is the URDF's root."""

    def __init__(self, urdf: str):
        self._joints = [_joint(element) for element in ElementTree.fromstring(urdf).findall("joint")]
        children = {joint["child"] for joint in self._joints}
        self._root = next(joint["parent"] for joint in self._joints if joint["parent"] not in children)
        self._before = {joint["child"]: joint for joint in self._joints}
        self.names = [joint["name"] for joint in self._joints if joint["moves"]]

    def chain(self, link: str) -> list[dict]:
        joints = []
        while link != self._root:
            joints.append(self._before[link])
            link = self._before[link]["parent"]
        return joints[::-1]

    def points(self, link: str, base: tuple[np.ndarray, Rotation], angles: dict[str, float]):
        """Places of the joints on the way to `link`, the link's own last, and the axes of those that move, in the world."""
        place, turn = base
        places, axes = [], []
        for joint in self.chain(link):
            place = place + turn.apply(joint["xyz"])
            turn = turn * joint["rpy"]
            if joint["moves"]:
                places.append(place)
                axes.append((joint["name"], turn.apply(joint["axis"]), place))
                turn = turn * Rotation.from_rotvec(angles[joint["name"]] * joint["axis"])
        return np.array([*places, place]), axes

    def jacobian(self, links: list[str], base, angles) -> np.ndarray:
        """Velocities of the links' origins over (base's linear velocity, its angular velocity, joint rates), world axes."""
        rows = []
        for link in links:
            places, axes = self.points(link, base, angles)
            block = np.zeros((3, 6 + len(self.names)))
            block[:, :3] = np.eye(3)
            arm = places[-1] - base[0]
            block[:, 3:6] = -np.array([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])
            for name, axis, place in axes:
                block[:, 6 + self.names.index(name)] = np.cross(axis, places[-1] - place)
            rows.append(block)
        return np.vstack(rows)


def pose(table, row: int):
    """Base and joint angles of one row of a trajectory."""
    base = (
        table.columns("base_px_m", "base_py_m", "base_pz_m")[row],
        Rotation.from_quat(table.columns("base_qx", "base_qy", "base_qz", "base_qw")[row]),
    )
    angles = {name[2:-4]: table[name][row] for name in table.names if name.startswith("q_")}
    return base, angles


def draw(axes, skeleton: Skeleton, feet: list[str], base, angles, colours, **style) -> None:
    """Side view, x to the right and z up: the legs in their colours, the trunk between the hips."""
    roots = []
    for foot, colour in zip(feet, colours):
        points, _ = skeleton.points(foot, base, angles)
        axes.plot(points[:, 0], points[:, 2], "-o", color=colour, markersize=2.5, solid_capstyle="round", **style)
        roots.append(points[0])
    roots = np.array(roots)
    axes.plot(
        roots[[0, 1], 0],
        roots[[0, 1], 2],
        color=colours[0],
        linewidth=style.get("linewidth", 2) * 2.2,
        solid_capstyle="round",
        alpha=style.get("alpha", 1.0),
    )


def _joint(element) -> dict:
    origin = element.find("origin")
    vector = lambda node, key, default: np.array(
        (node.get(key, default) if node is not None else default).split(), float
    )  # noqa: E731
    return {
        "name": element.get("name"),
        "parent": element.find("parent").get("link"),
        "child": element.find("child").get("link"),
        "moves": element.get("type") in ("revolute", "continuous"),
        "xyz": vector(origin, "xyz", "0 0 0"),
        "rpy": Rotation.from_euler("xyz", vector(origin, "rpy", "0 0 0")),
        "axis": vector(element.find("axis"), "xyz", "1 0 0"),
    }
