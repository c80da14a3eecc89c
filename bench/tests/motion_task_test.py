"""Task files become what they say, and what is not understood is an error."""

import pathlib

import numpy as np
import pytest
from hyq import PACKAGES, ROOT, shipped

from judge.motion import Motion
from judge.motion_task import read_task
from peers.mesh_search import coarsest_step
from peers.nodes import make_nodes


def test_start_stands_on_the_floor():
    task = shipped("stand")
    lowest = min(task.robot.places(task.start)[c.name][2] - c.radius for c in task.robot.contacts)
    assert abs(lowest) < 1e-12 and abs(task.start[2] - 0.59926) < 1e-5


def test_step_has_its_landing_place_and_its_swing():
    task = shipped("step")
    assert task.free_durations() and not shipped("crouch").free_durations()
    assert task.opens(0) == task.lands(2) == {"lf_foot"}
    assert np.allclose(task.phases[2].places["lf_foot"], [0.5708, 0.3241, 0.0])
    assert task.swing_height("lf_foot", 1, 0.5) == pytest.approx(0.05 * task.start[2])
    assert task.swing_height("lf_foot", 1, 0.0) == task.swing_height("lf_foot", 1, 1.0) == 0.0
    assert task.cost.time == 0.2


def test_goal_times_become_fractions_of_phases():
    goals = shipped("crouch").goals
    assert [(goal.phase, goal.fraction) for goal in goals] == [(0, 0.5), (0, 1.0)]
    assert np.isnan(goals[0].velocity).all() and (goals[1].velocity == 0).all()


@pytest.mark.parametrize("name", ["stand", "crouch", "balance", "rear", "step"])
def test_nodes_of_the_peers_meet_goals_and_the_duration(name):
    task = shipped(name)
    for step in (0.04, 0.02, 0.007):
        nodes = make_nodes(task, step)
        assert sum(node.step for node in nodes) == pytest.approx(task.duration)
        assert sum(node.first for node in nodes) == sum(node.last for node in nodes) == len(task.phases)
        for goal in task.goals:
            if goal.fraction < 1:
                assert any(node.phase == goal.phase and abs(node.share - goal.fraction) < 1e-9 for node in nodes)


def test_weights_on_forces_are_of_each_axis(tmp_path: pathlib.Path):
    text = (ROOT / "tasks/hyq/crouch.toml").read_text().replace("../../robots", str(ROOT / "robots"))
    for value, expected in (("1e-4", [1e-4, 1e-4, 1e-4]), ("[1e-4, 2e-4, 0]", [1e-4, 2e-4, 0.0])):
        task_file = tmp_path / "task.toml"
        task_file.write_text(text.replace("torque = 1e-5", f"torque = 1e-5\nforce = {value}", 1))
        assert read_task(task_file, PACKAGES).cost.force.tolist() == expected
    assert not read_task(ROOT / "tasks/hyq/crouch.toml", PACKAGES).cost.force.any()


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("duration_s = 2.0", 'duration_s = 2.0\nsteps = "free"', "steps"),
        ("friction = 0.5", "friction = 0.5\nnormal = [0, 1, 1]", "level floor"),
        ("torque = 1e-5", "effort = 1e-5", "effort"),
        ("base_rpy_rad = [0, 0, 0]", "joints = { lf_haa_joint = 0 }", "joints"),
    ],
)
def test_what_is_not_translated_is_an_error(tmp_path: pathlib.Path, old: str, new: str, word: str):
    text = (ROOT / "tasks/hyq/crouch.toml").read_text()
    assert old in text
    task_file = tmp_path / "task.toml"
    task_file.write_text(text.replace(old, new, 1).replace("../../robots", str(ROOT / "robots")))
    with pytest.raises(SystemExit, match=word):
        read_task(task_file, PACKAGES)


def test_motion_refuses_times_that_go_back():
    with pytest.raises(ValueError, match="time"):
        Motion(
            np.array([0.0, 0.2, 0.1]),
            np.zeros(3, dtype=int),
            np.zeros((3, 19)),
            np.zeros((3, 18)),
            np.zeros((3, 12)),
            "held",
        )


STEPS = [0.08, 0.056, 0.04, 0.028, 0.02, 0.014, 0.01, 0.007, 0.005, 0.0035, 0.0025]


@pytest.mark.parametrize("order", [1, 2, 4])
@pytest.mark.parametrize("needed", [0.1, 0.056, 0.013, 0.0025])
def test_coarsest_step_is_exact_and_the_one_before_is_not(order: int, needed: float):
    tried = []

    def ratio(step: float) -> float:
        tried.append(step)
        return (step / needed) ** order

    found = coarsest_step(STEPS, order, ratio)
    assert found == max(step for step in STEPS if step <= needed)
    assert len(tried) <= 4 and len(set(tried)) == len(tried)


def test_a_step_that_was_left_out_is_tried_if_the_error_falls_faster_than_expected():
    tried = []

    def ratio(step: float) -> float:
        tried.append(step)
        return (step / 0.03) ** 2

    assert coarsest_step(STEPS, 1, ratio) == 0.028
    assert tried == [0.08, 0.014, 0.02, 0.028, 0.04]


def test_no_step_at_all():
    assert coarsest_step(STEPS, 1, lambda step: float("inf")) is None
