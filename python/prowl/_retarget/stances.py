"""Contacts of a reference, from height and speed of the feet."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .. import _prowl
from .reference import Reference

GRAVITY = 9.81  #: [m/s²]
DEEPEST = 0.05  #: [m] a foot further below the ground is a mistake in the file, not noise
# Shares of the standing height h, of sqrt(g h) and of sqrt(h / g), so that they suit small and large robots.
_LOW, _SLOW, _SHORT = 0.03, 0.1, 0.25


@dataclass(frozen=True)
class Feet:
    """Contacts of a reference that move together: those of one frame."""

    names: list[list[str]]  #: contacts of each foot
    ground: float  #: height on which the feet stand in the file [m]
    place: np.ndarray  #: (N, feet, 3) mean of its contact points, less their radius, over that ground [m]
    stands: np.ndarray  #: (N, feet)


@dataclass(frozen=True)
class Span:
    """Samples first ... last with the same feet on the ground."""

    first: int
    last: int
    stands: tuple[bool, ...]


def runs(flags: np.ndarray) -> list[tuple[int, int]]:
    """Samples first ... after - 1 with one value of the flags, in order."""
    return list(pairwise([0, *(np.flatnonzero(np.diff(flags)) + 1).tolist(), len(flags)]))


def _filled(flags: np.ndarray, t: np.ndarray, shortest: float) -> np.ndarray:
    """Without gaps, then without stances, that are too short; those at the ends are as long as they like."""
    flags = flags.copy()
    for value in (False, True):
        for first, after in runs(flags)[1:-1]:
            if flags[first] == value and t[after] - t[first] < shortest:
                flags[first:after] = not value
    return flags


def find_feet(robot: _prowl.Robot, reference: Reference, source: object) -> Feet:
    """Raises InputError for feet far below the ground, z = 0, with row and column."""
    frames: dict[str, list[int]] = {}
    for index, contact in enumerate(robot.contacts):
        frames.setdefault(contact.frame, []).append(index)
    if not frames:
        raise _prowl.InputError(f"{robot.name}: no [[contact]], so no feet")
    points = _prowl.Dynamics(robot).contact_positions(reference.q)
    points = points - np.array([[0.0, 0.0, contact.radius] for contact in robot.contacts])
    for row, index in np.argwhere(points[..., 2] < -DEEPEST)[:1]:
        depth = -100.0 * points[row, index, 2]
        raise _prowl.InputError(
            f"{source}: row {row + 1}, {robot.contact_names[index]}: {depth:.1f} cm below the ground is not allowed; "
            f"need at most {100 * DEEPEST:g} cm"
        )
    place = np.stack([points[:, indices].mean(axis=1) for indices in frames.values()], axis=1)
    ground = float(np.quantile(place[..., 2].min(axis=1), 0.1))
    if abs(ground) > DEEPEST:
        raise _prowl.InputError(
            f"{source}: the lowest feet are at {100 * ground:.1f} cm; need ground at z = 0, within {100 * DEEPEST:g} cm"
        )
    place[..., 2] -= ground
    height = float(robot.nominal_configuration[2])
    speed = np.linalg.norm(np.gradient(place, reference.t, axis=0), axis=2)
    stands = (place[..., 2] < _LOW * height) & (speed < _SLOW * np.sqrt(GRAVITY * height))
    shortest = _SHORT * np.sqrt(height / GRAVITY)
    for foot in range(stands.shape[1]):
        stands[:, foot] = _filled(stands[:, foot], reference.t, shortest)
    return Feet([[robot.contact_names[i] for i in indices] for indices in frames.values()], ground, place, stands)


def _edges(flags: np.ndarray) -> np.ndarray:
    return np.flatnonzero(np.any(np.diff(flags, axis=0), axis=1)) + 1


def spans(feet: Feet, t: np.ndarray) -> list[Span]:
    """Ends of a span are samples, at which the next begins. Edges that are near each other become one, and those at the
    ends of the file none."""
    flags, last = feet.stands.copy(), len(feet.stands) - 1
    near = max(1, round(0.02 / float(np.median(np.diff(t)))))  # [s]: feet that land together, at 50 Hz a sample apart
    group: list[int] = []
    for edge in [*_edges(flags).tolist(), last + 2 * near]:
        if group and (edge - group[-1] > near or edge - group[0] > 3 * near):
            flags[group[0] : group[-1]] = flags[group[-1]]
            group = []
        group.append(edge)
    for edge in _edges(flags):
        if edge <= near:
            flags[:edge] = flags[edge]
        elif edge > last - near:
            flags[edge:] = flags[edge - 1]
    bounds = [0, *_edges(flags).tolist(), last]
    return [
        Span(first, after, tuple(bool(flag) for flag in flags[first]))
        for first, after in pairwise(bounds)
        if after > first
    ]
