"""Samples of a motion, the input of every export."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .. import _prowl

MOST_SAMPLES = 1e6


@dataclass(frozen=True)
class Samples:
    motion: _prowl.Motion  #: in order of time; without a for a simulation
    in_contact: np.ndarray  #: (N, contacts); planned, or simulated
    gains: np.ndarray | None  #: K (N, nu, 2 nv); None without gains
    simulated: bool

    def one_a_time(self) -> list[int]:
        """Indices of samples with distinct times; at a phase transition that of the later phase."""
        return np.flatnonzero(np.append(np.diff(self.motion.t) > 0, True)).tolist()


def _check_rate(rate: float | None, duration: float) -> None:
    if rate is None or (0 < rate < math.inf and rate * duration <= MOST_SAMPLES):
        return
    most = f"{math.floor(MOST_SAMPLES / duration):g}, i.e. {MOST_SAMPLES:g} samples in {duration:g} s"
    raise _prowl.InputError(f"rate: {rate:g} is not allowed; need more than 0 Hz and at most {most}")


def _gains(tracker: _prowl.Tracker, motion: _prowl.Motion) -> np.ndarray:
    """Gains of each sample; at the end of a phase of that phase, unlike Tracker.gains()."""
    last = np.flatnonzero(np.append(np.diff(tracker.t) <= 0, True))[motion.phase]  # last sample of its segment
    inside = motion.t < tracker.t[last]
    return np.array([tracker.gains(t) if i else tracker.K[k] for t, k, i in zip(motion.t, last, inside)])


def sample_plan(plan: _prowl.Plan, rate: float | None) -> Samples:
    """Samples of the plan at its nodes, two at a phase transition; or with a rate [Hz] at multiples of its
    period and at the end, with the later phase at a phase transition. Raises InputError for an invalid
    rate."""
    _check_rate(rate, plan.duration)
    motion = plan.motion if rate is None else plan.sample(1 / rate)
    held = [[name in phase.contacts for name in plan.robot.contact_names] for phase in plan.task.phases]
    gains = None if plan.tracker is None else _gains(plan.tracker, motion)
    return Samples(motion, np.array(held)[motion.phase], gains, simulated=False)


def sample_simulation(plan: _prowl.Plan, rate: float | None) -> Samples:
    """True motion of simulate.csv: all rows, or at most `rate` per second. Raises InputError."""
    _check_rate(rate, plan.duration)
    motion = plan.simulated_motion(0.0 if rate is None else 1 / rate)
    return Samples(motion, np.any(motion.f != 0, axis=2), None, simulated=True)
