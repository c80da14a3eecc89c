"""How long and how often a solver is measured."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Clock:
    """Solves are repeated until all took longer than `patience` [s] together. `time_limit`: of each, CPU time [s]."""

    repetitions: int = 1
    patience: float = 0.0
    time_limit: float = math.inf
