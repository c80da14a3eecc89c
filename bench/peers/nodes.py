"""The mesh of the peers, and what has to hold at its nodes: needs none of them."""

from dataclasses import dataclass

import numpy as np

from judge.motion import Motion
from judge.motion_task import Goal, MotionTask
from judge.robot import Contact

DAMPING = 50.0  # Baumgarte gain of the contacts, as in crocoddyl.utils.quadruped [1/s]


@dataclass(frozen=True)
class Node:
    """Where node k of the shooting problem is: at a share of a phase, with the step that follows it."""

    phase: int
    share: float
    step: float  # [s]; 0 at the end of the motion
    first: bool  # of its phase
    last: bool  # of its phase: one step before the switch

    @property
    def damping(self) -> float:
        """Gain of the contacts; explicit steps bear 1 / step [1/s]."""
        return min(DAMPING, 1.0 / self.step) if self.step else DAMPING


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


def goals_at(task: MotionTask, node: Node) -> list[Goal]:
    """A goal at the end of a phase belongs to the first node of the next."""

    def is_here(goal: Goal) -> bool:
        if goal.fraction == 1.0 and goal.phase + 1 < len(task.phases):
            return node.first and node.phase == goal.phase + 1
        return node.phase == goal.phase and abs(node.share - goal.fraction) < 1e-9

    return [goal for goal in task.goals if is_here(goal)]


def anchor(task: MotionTask, phase: int, name: str) -> np.ndarray | None:
    """Centre of the ball of a contact that holds in this phase, if the task says where: it held from the start, or landed there."""
    landed = phase
    while landed > 0 and name in task.phases[landed - 1].contacts:
        landed -= 1
    if landed == 0:
        return task.robot.places(task.start)[name]
    place = landing_place(task, landed, name)
    return None if np.isnan(place).any() else place


def landing_place(task: MotionTask, phase: int, name: str) -> np.ndarray:
    """Where the centre of a contact's ball has to be at the start of this phase, NaN where it may choose."""
    place = task.phases[phase].places.get(name, np.array([np.nan, np.nan, task.floor]))
    return place + [0.0, 0.0, task.robot.contact(name).radius]


def least_height(task: MotionTask, node: Node, contact: Contact) -> float:
    """Of the centre of an open contact's ball [m]."""
    return task.floor + contact.radius + task.swing_height(contact.name, node.phase, node.share)


def held_motion(nq: int, nodes: list[Node], states: list[np.ndarray], torques: list[np.ndarray]) -> Motion:
    """Torques held over their steps, one fewer than states; two nodes at each phase switch."""
    rows, time = [], 0.0
    for k, (node, x) in enumerate(zip(nodes, states, strict=True)):
        if node.first and k > 0:
            rows.append((time, node.phase - 1, x[:nq], x[nq:], torques[k - 1]))
        rows.append((time, node.phase, x[:nq], x[nq:], torques[min(k, len(torques) - 1)]))
        time += node.step
    return Motion(*(np.array(column) for column in zip(*rows)), torque="held")
