"""A motion at a number of times: what every export is made of."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .. import _prowl

MOST_SAMPLES = 1e6


@dataclass(frozen=True)
class Samples:
    motion: _prowl.Motion  #: in order of time; of a simulation without a
    in_contact: np.ndarray  #: (N, contacts), as planned, or as it touched
    gains: np.ndarray | None  #: K (N, nu, 2 nv); None if there are none
    simulated: bool

    def one_a_time(self) -> list[int]:
        """Indices of samples: of two at one time the later phase's."""
        return np.flatnonzero(np.append(np.diff(self.motion.t) > 0, True)).tolist()


def _check_rate(rate: float | None, duration: float) -> None:
    if rate is None or (0 < rate < math.inf and rate * duration <= MOST_SAMPLES):
        return
    most = f"{math.floor(MOST_SAMPLES / duration):g}, which are {MOST_SAMPLES:g} samples in {duration:g} s"
    raise _prowl.InputError(f"rate: {rate:g} is not allowed; need more than 0 Hz and at most {most}")


def _gains(tracker: _prowl.Tracker, motion: _prowl.Motion) -> np.ndarray:
    """At the end of a phase that phase's, where Tracker.gains takes the next one's."""
    last = np.flatnonzero(np.append(np.diff(tracker.t) <= 0, True))[motion.phase]  # of the sample's segment
    inside = motion.t < tracker.t[last]
    return np.array([tracker.gains(t) if i else tracker.K[k] for t, k, i in zip(motion.t, last, inside)])


def sample_plan(plan: _prowl.Plan, rate: float | None) -> Samples:
    """The plan at its nodes, where a switch of phases has two samples at one time, or, with a rate [Hz], at multiples of its
    period and at the end, where a switch is of the later phase. Raises InputError for a rate that makes no sense."""
    _check_rate(rate, plan.duration)
    motion = plan.motion if rate is None else plan.sample(1 / rate)
    held = [[name in phase.contacts for name in plan.robot.contact_names] for phase in plan.task.phases]
    gains = None if plan.tracker is None else _gains(plan.tracker, motion)
    return Samples(motion, np.array(held)[motion.phase], gains, simulated=False)


def sample_simulation(plan: _prowl.Plan, rate: float | None) -> Samples:
    """The true motion of simulate.csv, all rows or no more than `rate` a second. Raises InputError."""
    _check_rate(rate, plan.duration)
    motion = plan.simulated_motion(0.0 if rate is None else 1 / rate)
    return Samples(motion, np.any(motion.f != 0, axis=2), None, simulated=True)
