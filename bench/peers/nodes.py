"""The mesh of the peers: needs none of them."""

from dataclasses import dataclass

from judge.motion_task import MotionTask


@dataclass(frozen=True)
class Node:
    """Where node k of the shooting problem is: at a share of a phase, with the step that follows it."""

    phase: int
    share: float
    step: float  # [s]; 0 at the end of the motion
    first: bool  # of its phase
    last: bool  # of its phase: one step before the switch


def make_nodes(task: MotionTask, step: float) -> list[Node]:
    """Every phase in steps as near to `step` as its duration lets them be, and so that its goals are at nodes."""
    nodes = []
    for index, phase in enumerate(task.phases):
        count = max(1, round(phase.duration / step))
        fractions = [goal.fraction for goal in task.goals if goal.phase == index]
        while any(abs(count * fraction - round(count * fraction)) > 1e-9 for fraction in fractions):
            count += 1
        nodes += [Node(index, k / count, phase.duration / count, k == 0, k == count - 1) for k in range(count)]
    return nodes + [Node(len(task.phases) - 1, 1.0, 0.0, False, False)]
