"""Torques of a tracker at states beside its reference, by the Python package."""

import pathlib


def tracker_torques(file: pathlib.Path) -> list[list[float]]:
    import prowl

    tracker = prowl.Tracker.read(file)
    torques = []
    for time in (0.0, 0.1, 0.25, 0.41, 0.6, 1.0):
        q, v = (state.copy() for state in tracker.reference(time))
        q[:3] += (0.01, -0.005, 0.008)
        q[7:] += 0.02
        v += 0.05
        torques.append(tracker.torque(time, q, v).tolist())
    return torques
