"""Rows of postures: their base's axes, and what lies between them."""

from __future__ import annotations

import numpy as np

from . import _prowl


def rotated(quaternions: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """R v for rows, by quaternions x y z w."""
    u, w = quaternions[:, :3], quaternions[:, 3:]
    twice = 2.0 * np.cross(u, vectors)
    return vectors + w * twice + np.cross(u, twice)


def places_between(t: np.ndarray, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For each time the sample before it and the share of the way to the next (N, 1): 0 to 1, also outside."""
    before = np.clip(np.searchsorted(t, times, side="right"), 1, len(t) - 1) - 1
    share = (times - t[before]) / (t[before + 1] - t[before])
    return before, np.clip(share, 0.0, 1.0)[:, None]


def postures_between(q: np.ndarray, before: np.ndarray, share: np.ndarray) -> np.ndarray:
    """At the places of places_between(): linear, the base along the shortest turn."""
    return _prowl.integrate(q[before], share * _prowl.difference(q[before], q[before + 1]))
