"""A task as the document of bench/peers/aligator, which solves it in an environment of its own: it needs another Pinocchio."""

import json
import pathlib
import subprocess

import numpy as np

from judge.contact_dynamics import standing_torques
from judge.motion import Motion
from judge.motion_task import MotionTask
from peers.nodes import Node, anchor, goals_at, held_motion, landing_place, least_height


def _numbers(values) -> list:
    """With null for NaN: free."""
    return [None if np.isnan(value) else float(value) for value in values]


def _contact(task: MotionTask, node: Node, name: str) -> dict:
    place = anchor(task, node.phase, name)
    return {
        "name": name,
        "anchor": None if place is None else place.tolist(),
        "opens": node.last and name in task.opens(node.phase),
    }


def holding_torques(task: MotionTask) -> list[np.ndarray]:
    """That hold the start on the contacts of each phase."""
    return [standing_torques(task.robot, task.start, phase.contacts) for phase in task.phases]


def _node(task: MotionTask, node: Node, joint_bounds: bool, holding: list[np.ndarray]) -> dict:
    phase = task.phases[node.phase]
    held = [contact.name for contact in task.robot.contacts if contact.name in phase.contacts]
    return {
        "step": node.step,
        "damping": node.damping,
        "holding_torque": holding[node.phase].tolist(),
        "joints_bounded": joint_bounds and node.phase + node.share > 0,
        "held": [_contact(task, node, name) for name in held],
        "open": [
            {"name": contact.name, "height": least_height(task, node, contact)}
            for contact in task.robot.contacts
            if contact.name not in held
        ],
        "lands": [
            {"name": name, "place": _numbers(landing_place(task, node.phase, name))}
            for name in (task.lands(node.phase) if node.first else ())
        ],
        "goals": [
            {
                "position": _numbers(goal.position),
                "rotation": None if goal.rotation is None else goal.rotation.tolist(),
                "turn": np.flatnonzero(goal.turn).tolist(),
                "velocity": _numbers(goal.velocity),
            }
            for goal in goals_at(task, node)
        ],
    }


def document(
    task: MotionTask, nodes: list[Node], rule: str, joint_bounds: bool, holding: list[np.ndarray], settings: dict
) -> dict:
    model, cost = task.robot.model, task.cost
    return {
        "urdf": str(task.robot.urdf),
        "integrator": rule,
        "contacts": [{"name": c.name, "frame": c.parent, "offset": c.offset} for c in task.robot.contacts],
        "limits": {
            "torque": task.robot.torque_limit.tolist(),
            "lower": model.lowerPositionLimit[7:].tolist(),
            "upper": model.upperPositionLimit[7:].tolist(),
            "velocity": model.velocityLimit[6:].tolist(),
        },
        "friction": task.friction,
        "ground_axes": task.ground_axes.T.tolist(),
        "start": task.start.tolist(),
        "start_velocity": task.velocity.tolist(),
        "cost": {
            "configuration": cost.configuration.tolist(),
            "velocity": cost.velocity.tolist(),
            "acceleration": cost.acceleration.tolist(),
            "torque": cost.torque.tolist(),
            "torque_reference": cost.torque_reference.tolist(),
            "force": cost.force.tolist(),
        },
        "nodes": [_node(task, node, joint_bounds, holding) for node in nodes],
        "settings": settings,
    }


class AligatorError(RuntimeError):
    pass


def run(program: pathlib.Path, task: MotionTask, nodes: list[Node], request: dict) -> tuple[Motion, dict]:
    """The motion, and what the program says of its solve of this document."""
    found = subprocess.run([program], input=json.dumps(request), capture_output=True, text=True, check=False)
    if found.returncode != 0:
        raise AligatorError(found.stderr.strip() or f"exit status {found.returncode}")
    answer = json.loads(found.stdout)
    motion = held_motion(
        task.robot.model.nq, nodes, [np.array(x) for x in answer["states"]], [np.array(u) for u in answer["inputs"]]
    )
    return motion, answer
