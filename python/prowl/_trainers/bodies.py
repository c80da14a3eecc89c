"""Bodies of a robot over a motion: placements and velocities, as MuJoCo has them."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np

from .. import _prowl
from .._postures import rotated

_STEP = 1e-5  #: [s] of central differences: errors of 1e-10 of the velocity


@dataclass(frozen=True)
class Order:
    """Names of links and joints in the order of a MuJoCo model."""

    bodies: list[str]
    joints: list[str]


def _named(kind: str, names: list[str], known: dict[str, str], robot: _prowl.Robot) -> list[str]:
    """A trainer counts bodies and joints, so that none may be left out."""
    if unknown := [name for name in names if name not in known]:
        raise _prowl.InputError(f"model: {kind} '{unknown[0]}' is none of {robot.name}; need those of its URDF alone")
    return [known[name] for name in names]


def order_of(robot: _prowl.Robot, mjcf: str) -> Order:
    """Of the links that are bodies of a model, and of its joints. Prowl's own models name a body after the joint that
    moves it. Raises InputError for a model that is not of this robot."""
    moved = {
        joint.get("name"): joint.find("child") for joint in ElementTree.fromstring(robot.urdf_text).findall("joint")
    }
    links = {"base": robot.links[0].name} | {link.name: link.name for link in robot.links}
    links |= {name: child.get("link", "") for name, child in moved.items() if name and child is not None}
    try:
        tree = ElementTree.fromstring(mjcf)
    except ElementTree.ParseError as error:
        raise _prowl.InputError(f"model: no XML: {error}") from None
    elements = list(tree.iter("body"))
    joints = [
        joint.get("name", "")
        for body in elements
        for joint in body.findall("joint")
        if joint.get("type", "hinge") in ("hinge", "slide")
    ]
    order = Order(
        _named("body", [body.get("name", "") for body in elements], links, robot),
        _named("joint", joints, {name: name for name in robot.joint_names}, robot),
    )
    if missing := sorted(set(robot.joint_names) - set(order.joints)):
        raise _prowl.InputError(f"model: no joint '{missing[0]}', which {robot.name} has; need its names")
    return order


@dataclass(frozen=True)
class BodyMotion:
    """World frame, axes of the world; reference points are the origins of the bodies' frames."""

    position: np.ndarray  #: (N, bodies, 3) [m]
    quaternion: np.ndarray  #: (N, bodies, 4) w x y z
    linear_velocity: np.ndarray  #: (N, bodies, 3) [m/s]
    angular_velocity: np.ndarray  #: (N, bodies, 3) [rad/s]


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of quaternions x y z w, row by row."""
    u, v = a[..., :3], b[..., :3]
    vector = a[..., 3:] * v + b[..., 3:] * u + np.cross(u, v)
    return np.concatenate([vector, a[..., 3:] * b[..., 3:] - np.sum(u * v, axis=-1, keepdims=True)], axis=-1)


def body_motion(robot: _prowl.Robot, q: np.ndarray, v: np.ndarray, bodies: list[str]) -> BodyMotion:
    """Of these bodies, for rows of q and v."""
    names = [link.name for link in robot.links]
    columns = [names.index(name) for name in bodies]
    rates = v.copy()
    rates[:, :3] = rotated(q[:, 3:7], v[:, :3])  # a tangent has it in the world
    before, now, after = (
        robot.link_placements(_prowl.integrate(q, step * rates))[:, columns] for step in (-_STEP, 0.0, _STEP)
    )
    inverse = before[..., 3:] * np.array([-1.0, -1.0, -1.0, 1.0])
    spin = _times(after[..., 3:], inverse)
    spin = spin[..., :3] * np.sign(spin[..., 3:])
    turns = now[..., 3:]
    flips = np.sum(turns[1:] * turns[:-1], axis=-1, keepdims=True) < 0
    turns[1:] *= np.cumprod(np.where(flips, -1.0, 1.0), axis=0)  # q and -q are one rotation: no jumps over time
    return BodyMotion(
        now[..., :3],
        np.roll(turns, 1, axis=-1),
        (after[..., :3] - before[..., :3]) / (2 * _STEP),
        spin / _STEP,
    )
