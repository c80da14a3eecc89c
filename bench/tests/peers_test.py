"""The peers solve the task that Prowl solves, by each of their rules, and a mesh has what the task says at its nodes."""

import numpy as np
import pytest
from hyq import shipped

from judge.checker import judge
from peers.environment import ALIGATOR_PROGRAM
from peers.nodes import anchor, goals_at, held_motion, make_nodes


def test_contacts_are_anchored_where_they_stood_or_had_to_land():
    task = shipped("step")
    places = task.robot.places(task.start)
    radius = np.array([0.0, 0.0, task.robot.contact("lf_foot").radius])
    assert np.allclose(anchor(task, 0, "lf_foot"), places["lf_foot"])
    assert np.allclose(anchor(task, 2, "lf_foot"), task.phases[2].places["lf_foot"] + radius)
    assert np.allclose(anchor(task, 2, "rh_foot"), places["rh_foot"])


def test_each_goal_is_at_one_node():
    for name in ("stand", "crouch", "balance", "rear", "step"):
        task = shipped(name)
        nodes = make_nodes(task, 0.03)
        assert sum(len(goals_at(task, node)) for node in nodes) == len(task.goals)


def test_torques_are_held_over_their_steps():
    task = shipped("balance")
    nodes = make_nodes(task, 0.2)
    model = task.robot.model
    states = [np.concatenate([task.start, np.full(model.nv, k)]) for k in range(len(nodes))]
    motion = held_motion(model.nq, nodes, states, [np.full(12, k) for k in range(len(nodes) - 1)])
    assert motion.duration == pytest.approx(task.duration)
    assert len(motion.switches) == len(task.phases) - 1
    for k in motion.switches:  # the same state, with the torque before and after it
        assert (motion.v[k] == motion.v[k + 1]).all() and (motion.tau[k] == motion.tau[k + 1] - 1).all()


@pytest.mark.parametrize(
    ("peer", "rule", "name"),
    [
        ("boxfddp", "euler", "balance"),  # a foot opens and lands
        ("boxfddp", "rk4", "balance"),
        ("intro", "euler", "balance"),
        ("sqp", "euler", "balance"),
        ("sqp", "rk4", "balance"),
        ("csqp", "euler", "stand"),
        ("csqp", "rk4", "stand"),
        ("aligator", "semi-implicit", "stand"),
        ("aligator", "rk2", "balance"),
    ],
)
def test_peers_keep_the_task(peer: str, rule: str, name: str):
    solvers = pytest.importorskip("peers.peer_solvers", reason="needs the environment of scripts/bench")
    if peer == "aligator" and not ALIGATOR_PROGRAM.exists():
        pytest.skip("needs the aligator_peer of scripts/bench")
    task = shipped(name)
    run = solvers.solve(solvers.PeerSetup(peer, 0.02, rule), task)
    verdict = judge(task, run.motion)
    assert run.converged and verdict.worst_share <= 1.0, verdict.worst
    assert verdict.error < (5e-3 if rule in ("euler", "semi-implicit") else 5e-4)
