"""A robot with its meshes at one moment of a plan, drawn by matplotlib, from the page that `prowl report` writes.

That page holds what it shows as JSON (report/src/data.ts): meshes, where each belongs on the robot, and the placement of
every body at many times.
"""

import base64
import json
import pathlib
import re

import numpy as np
import style
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from scipy.spatial.transform import Rotation

DATA = re.compile(r'<script type="application/json" id="prowl-data">(.*?)</script>', re.DOTALL)
GREY = (0.72, 0.75, 0.78)
DARK = (0.25, 0.27, 0.3)
SUN = np.array([0.35, -0.55, 0.76])  # towards it; unit length to two digits
ROOM = np.array([0.75, 0.5, 0.9])  # around the robot, to both sides, and up [m]: all pictures have one scale
LONGEST_ARROW = 0.5  # of a force as large as the robot's weight [m]


def _array(text: str, kind: str, *shape: int) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), dtype=kind).reshape(shape)


def _ball(rings: int = 8) -> np.ndarray:
    """Triangles of a unit ball."""
    polar, turn = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1), indexing="ij")
    points = np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    return np.concatenate([np.stack([a, b, c], axis=-2), np.stack([a, c, d], axis=-2)]).reshape(-1, 3, 3)


class Scene:
    """The robot of a plan, as triangles in the frames of its bodies, and where the bodies are over time."""

    def __init__(self, report: pathlib.Path):
        data = json.loads(DATA.search(report.read_text(encoding="utf-8"))[1])
        scene, plan = data["scene"], data["plan"]
        self.time = np.array(plan["time"])
        self.weight = data["weight_N"]
        self.contacts = scene["contacts"]
        self._bodies = scene["bodies"]
        self._placements = _array(plan["placements"], "<f4", len(self.time), len(scene["bodies"]), 7)
        self._forces = _array(plan["forces"], "<f4", len(self.time), len(self.contacts), 3)
        self._parts = [part for visual in scene["visuals"] for part in self._parts_of(visual, scene["meshes"])]

    @staticmethod
    def _parts_of(visual: dict, meshes: list[dict]):
        """Body, triangles in its frame, and colour of one visual. Boxes and cylinders are left out: HyQ's only one is a
        marker inside the trunk."""
        turn, place = Rotation.from_quat(visual["placement"][3:]), np.array(visual["placement"][:3])

        def move(points: np.ndarray) -> np.ndarray:
            return (turn.apply(points.reshape(-1, 3) * visual["size"]) + place).reshape(-1, 3, 3)

        if visual["kind"] == "sphere":
            yield visual["body"], move(_ball()), visual["colour"] or DARK
        for number in visual["meshes"]:
            points = _array(meshes[number]["positions"], "<f4", -1, 3).astype(float)
            corners = points[_array(meshes[number]["triangles"], "<u4", -1)]
            yield visual["body"], move(corners), GREY if visual["body"] == 0 else DARK

    def body(self, name: str, time: float) -> np.ndarray:
        """Where the origin of a body is, world frame [m]."""
        return self._placements[self.node(time), self._bodies.index(name), :3]

    def node(self, time: float) -> int:
        return int(np.argmin(np.abs(self.time - time)))

    def triangles(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Corners in the world and a colour for each triangle."""
        poses = self._placements[self.node(time)]
        corners, colours = [], []
        for body, points, colour in self._parts:
            turn, place = Rotation.from_quat(poses[body, 3:]), poses[body, :3]
            corners.append((turn.apply(points.reshape(-1, 3)) + place).reshape(-1, 3, 3))
            colours.append(np.tile(colour, (len(points), 1)))
        return np.concatenate(corners), np.concatenate(colours)

    def path(self, contact: str) -> np.ndarray:
        """Where a contact point is at all times, world frame [m]."""
        (point,) = [entry for entry in self.contacts if entry["name"] == contact]
        poses = self._placements[:, point["body"]]
        return poses[:, :3] + Rotation.from_quat(poses[:, 3:]).apply(point["point"])

    def paths(self) -> list[np.ndarray]:
        """Ways of the feet that leave their places, by a centimetre or more. The trunk point is no foot."""
        ways = [self.path(contact["name"]) for contact in self.contacts if contact["name"].endswith("foot")]
        return [way for way in ways if np.max(np.linalg.norm(way - way[0], axis=1)) > 0.01]

    def forces(self, time: float) -> list[tuple[np.ndarray, np.ndarray]]:
        """Point and force [N] of each contact that carries more than a thousandth of the weight."""
        node = self.node(time)
        loaded = [c for c in range(len(self.contacts)) if np.linalg.norm(self._forces[node, c]) > 1e-3 * self.weight]
        return [(self.path(self.contacts[c]["name"])[node], self._forces[node, c]) for c in loaded]


def _shaded(corners: np.ndarray, colours: np.ndarray) -> np.ndarray:
    """Lambert's law, both sides alike: meshes do not agree which side is out."""
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    light = 0.45 + 0.55 * np.abs(normals @ SUN)
    return np.clip(colours * light[:, None] + 0.06 * light[:, None] ** 8, 0, 1)


def _floor(axes, low: np.ndarray, high: np.ndarray, step: float = 0.2) -> None:
    x, y = (np.arange(np.floor(low[i] / step), np.ceil(high[i] / step) + 1) * step for i in range(2))
    lines = [((a, y[0], 0), (a, y[-1], 0)) for a in x] + [((x[0], b, 0), (x[-1], b, 0)) for b in y]
    axes.add_collection3d(Line3DCollection(lines, colors="0.85", linewidths=0.6, zorder=1))


def draw(axes, scene: Scene, time: float, view: tuple[float, float] = (14, -62), forces: bool = True) -> np.ndarray:
    """The robot on a floor with lines every 20 cm, its shadow, and its contact forces. Returns its triangles."""
    corners, colours = scene.triangles(time)
    middle = corners.reshape(-1, 3).mean(axis=0) * [1, 1, 0]
    low, high = middle - ROOM * [1, 1, 0], middle + ROOM
    _floor(axes, low, high)
    shadow = corners * [1, 1, 0] - np.multiply.outer(corners[:, :, 2], SUN[:2] / SUN[2] * 0.35) @ np.eye(2, 3)
    faces = _shaded(corners, colours)
    seams = {"linewidths": 0.3, "rasterized": True}  # edges in the faces' colours: else the background shines through
    axes.add_collection3d(Poly3DCollection(shadow, facecolors="0.88", edgecolors="0.88", zorder=2, **seams))
    axes.add_collection3d(Poly3DCollection(corners, facecolors=faces, edgecolors=faces, zorder=4, **seams))
    for path in scene.paths():
        axes.plot(*path.T, color=style.BLUE, lw=1.4, zorder=5)
    for point, force in scene.forces(time) if forces else ():
        tip = point + LONGEST_ARROW / scene.weight * force
        axes.plot(*np.transpose([point, tip]), color=style.VERMILLION, lw=2, zorder=6, solid_capstyle="butt")
        axes.plot(*tip[:, None], "^", color=style.VERMILLION, ms=6, mew=0, zorder=6)
    axes.computed_zorder = False
    for set_limits, a, b in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), low, high):
        set_limits(a, b)
    axes.set_box_aspect(high - low, zoom=1.08)
    axes.set_proj_type("persp", focal_length=0.6)
    axes.view_init(*view)
    axes.set_axis_off()
    return corners
