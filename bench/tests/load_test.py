"""Random tasks are the same for the peers as for Prowl, on any slope; and one judge takes the motions of all."""

import dataclasses
import json
import os
import pathlib
import random
import subprocess
import sys

import numpy as np
import pinocchio as pin
import pytest
from hyq import PACKAGES, ROOT

from judge.checker import judge
from judge.contact_dynamics import ContactDynamics, standing_torques
from judge.motion import Motion
from judge.motion_task import MotionTask, parse_task
from load.random_tasks import ROBOTS, draw, folder
from peers.nodes import make_nodes


def shooting_problem(task: MotionTask, step: float, rule: str = "euler", anchored: bool = False):
    """A peers.shooting_problem.ShootingProblem, where its peers are, with limits as penalties."""
    module = pytest.importorskip("peers.shooting_problem", reason="needs the environment of scripts/bench")
    return module.ShootingProblem(task, step, rule, False, False, False, anchored)


def drawn(count: int, seed: int = 3) -> list[tuple[str, dict, MotionTask]]:
    source = random.Random(seed)
    found = [draw(source) for _ in range(count)]
    return [
        (robot, document, parse_task(document, folder(robot), PACKAGES, f"task {i}"))
        for i, (robot, document) in enumerate(found)
    ]


def of_each_robot() -> list[tuple[str, dict, MotionTask]]:
    """The first task of each that is on a slope of 8 to 12 degrees."""
    found = {}
    for robot, document, task in drawn(60):
        if np.cos(np.radians(12)) < task.normal[2] < np.cos(np.radians(8)):
            found.setdefault(robot, (robot, document, task))
    assert set(found) == {robot for robot, _, _ in ROBOTS}
    return list(found.values())


def standing_still(task: MotionTask) -> Motion:
    tau = standing_torques(task.robot, task.start, task.phases[0].contacts)
    return Motion(
        np.array([0.0, 0.1]),
        np.zeros(2, dtype=int),
        np.tile(task.start, (2, 1)),
        np.zeros((2, task.robot.model.nv)),
        np.tile(tau, (2, 1)),
        "held",
    )


def test_peers_have_goal_slope_friction_time_and_start_of_the_document():
    for _, document, task in drawn(20):
        surface, phase, (there, back) = document["surface"][0], document["phase"][0], document["goal"]
        assert task.friction == surface["friction"] and np.allclose(task.normal, surface["normal"], atol=1e-12)
        start = document["start"]
        for key, rows in (("base_linear_velocity_mps", slice(0, 3)), ("base_angular_velocity_radps", slice(3, 6))):
            assert np.allclose(task.velocity[rows], start.get(key, [0, 0, 0]))
        nodes = make_nodes(task, task.duration / task.intervals)
        assert sum(node.step for node in nodes) == pytest.approx(phase["duration_s"])
        for goal, wanted, fraction in zip(task.goals, (there, back), (0.5, 1.0), strict=True):
            assert goal.fraction == pytest.approx(fraction) and any(abs(node.share - fraction) < 1e-9 for node in nodes)
            assert np.allclose(goal.position - task.start[:3], wanted["base_displacement_m"])
            assert np.allclose(pin.rpy.matrixToRpy(goal.rotation), wanted["base_rpy_rad"]) and goal.turn.all()


def test_robots_stand_on_their_slopes_as_on_the_level():
    for robot, document, task in of_each_robot():
        level = parse_task({**document, "surface": [{"name": "ground"}]}, folder(robot), PACKAGES, "level")
        on_slope, on_level = (t.robot.places(t.start) for t in (task, level))
        for contact in task.robot.contacts:
            assert task.height(on_slope[contact.name]) == pytest.approx(level.height(on_level[contact.name]), abs=1e-12)
        assert min(task.height(on_slope[c.name]) - c.radius for c in task.robot.contacts) == pytest.approx(
            0.0, abs=1e-12
        )
        assert np.allclose(task.ground_axes.T @ task.ground_axes, np.eye(3)) and np.linalg.det(task.ground_axes) > 0
        base = pin.Quaternion(task.start[3:7]).matrix()
        assert np.allclose(base[:, 2], task.normal)
        mean = np.mean([on_slope[contact.name] for contact in task.robot.contacts], axis=0)
        assert np.allclose(mean, mean @ task.normal * task.normal)  # over the surface's point


@pytest.mark.parametrize("friction", [0.1, 1.0])
def test_the_judge_and_the_peers_see_friction_along_the_slope(friction: float):
    """Forces that stand straight up are inside the cone of a level floor; on a slope of 8 to 12 degrees 0.1 does not hold them."""
    for _, _, task in of_each_robot():
        task = dataclasses.replace(
            task, friction=friction, goals=(), phases=(dataclasses.replace(task.phases[0], duration=0.1),)
        )
        shooting = shooting_problem(task, 0.1)
        data = shooting.problem.runningDatas[0]
        tau = standing_torques(task.robot, task.start, task.phases[0].contacts)
        shooting.problem.runningModels[0].calc(data, shooting.start, tau)
        _, forces, _ = ContactDynamics(task.robot, task.phases[0].contacts)(
            task.start, np.zeros(task.robot.model.nv), tau
        )
        costs = data.differential.costs.costs
        missing = 0.0
        for contact, force in zip(task.robot.contacts, forces, strict=True):
            along = task.ground_axes.T @ force
            missing = max(missing, np.linalg.norm(along[:2]) - friction * along[2])
            inside = np.abs(along[:2]).max() <= friction / np.sqrt(2) * along[2]  # at the least what four planes leave
            outside = np.linalg.norm(along[:2]) > friction * along[2]
            assert inside != outside, "the force is between the planes and the cone, so that nothing is known"
            assert (costs.todict()[f"cone {contact.name}"].cost > 0) == outside
        assert judge(task, standing_still(task)).findings["friction"].value == pytest.approx(missing, rel=1e-4)
        assert (missing > 0) == (friction == 0.1)


def test_feet_are_pulled_back_to_where_they_stood():
    step = 0.01  # fine enough for all of the damping, 50 1/s
    for _, _, task in of_each_robot():
        lifted = np.concatenate([task.start, np.zeros(task.robot.model.nv)])
        lifted[2] += 1e-3
        for anchored in (False, True):
            shooting = shooting_problem(task, step, anchored=anchored)
            data = shooting.problem.runningDatas[0]
            shooting.problem.runningModels[0].calc(data, lifted, np.zeros(12))
            dynamics = ContactDynamics(task.robot, task.phases[0].contacts)
            dynamics(lifted[: task.robot.model.nq], np.zeros(task.robot.model.nv), np.zeros(12))
            feet = (dynamics.jacobian(lifted[: task.robot.model.nq]) @ data.differential.xout).reshape(-1, 3)
            assert np.allclose(feet, [0.0, 0.0, -(50.0**2) / 4 * 1e-3 if anchored else 0.0], atol=1e-9)


def test_penetration_is_along_the_normal():
    for _, _, task in of_each_robot():
        task = dataclasses.replace(task, goals=())
        motion = standing_still(task)
        assert judge(task, motion).findings["penetration"].value < 1e-9
        sunk = motion.q.copy()
        sunk[:, :3] -= 3e-3 * task.normal
        assert judge(task, dataclasses.replace(motion, q=sunk)).findings["penetration"].value == pytest.approx(
            3e-3, abs=1e-6
        )


def test_ball_of_a_contact_may_be_beside_its_frame():
    task = next(task for robot, _, task in of_each_robot() if robot == "anymal_c")
    model, data = task.robot.model, task.robot.model.createData()
    pin.framesForwardKinematics(model, data, task.start)
    for contact in task.robot.contacts:
        frame = data.oMf[model.getFrameId(contact.name)]
        assert np.allclose(frame.actInv(task.robot.places(task.start)[contact.name]), [0, 0, 0.0225])


def test_limits_of_the_robot_file_replace_those_of_the_urdf():
    tasks = {robot: task.robot for robot, _, task in of_each_robot()}
    solo, anymal = tasks["solo12"], tasks["anymal_c"]
    assert (solo.torque_limit == 2.7).all() and (solo.model.velocityLimit[6:] == 30.0).all()
    assert solo.model.upperPositionLimit[7:].tolist() == [1.0, 2.0, -0.1, 1.0, 2.0, -0.1, 1.0, 2.0, 2.8, 1.0, 2.0, 2.8]
    assert (anymal.torque_limit == 80.0).all()
    assert anymal.model.lowerPositionLimit[7 + anymal.joints.index("LH_KFE")] == 0.1


PYTHON, MODULE = ROOT / ".venv/bin/python", ROOT / "build/python"


@pytest.mark.skipif(not any(MODULE.glob("prowl/_prowl*.so")), reason="needs a built Prowl")
def test_plans_that_prowl_certifies_pass_the_judge(tmp_path: pathlib.Path):
    pytest.importorskip("mim_solvers", reason="needs the environment of scripts/bench")
    records = tmp_path / "records.jsonl"
    subprocess.run(
        [
            PYTHON,
            ROOT / "scripts/load",
            "--tasks",
            "6",
            "--peers",
            "6",
            "--solvers",
            "sqp",
            "--records",
            records,
            "--environment",
            sys.prefix,
        ],
        check=True,
        stdout=subprocess.DEVNULL,
        env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
    )
    found = [json.loads(line)["solvers"] for line in records.read_text().splitlines()]
    good = [solvers["prowl"] for solvers in found if solvers["prowl"]["good"]]
    assert len(found) == 6 and len(good) >= 2
    for record in good:
        assert record["keeps_task"] and record["error"] <= 5e-4
        assert record["findings"]["start"] < 1e-9 and record["findings"]["goal position"] < 1e-5
    assert all("failed" not in solvers["sqp"] for solvers in found)
