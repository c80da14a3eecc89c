"""What the figures show, computed again in another way; figures() as a function."""

import importlib.machinery
import importlib.util
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

import prowl
from prowl._figures import tables

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def step() -> prowl.Plan:
    """HyQ swings a leg and puts it down: contacts that change."""
    return prowl.solve(prowl.read_task("hyq/step"), progress=False)


def rate(q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """v as a tangent of integrate(): the velocity of the base turned into the world; rows."""
    u, w = q[:, 3:6], q[:, 6:7]
    cross = np.cross(u, v[:, :3])
    return np.hstack([v[:, :3] + 2 * (w * cross + np.cross(u, cross)), v[:, 3:]])


def test_contact_accelerations_are_those_of_the_contacts(step):
    table = tables.contact_acceleration(step)
    t, h = table["time_s"], 1e-5
    assert np.all(np.diff(t) <= 0.005 + 1e-9) and t[-1] == step.duration
    point = step.at(t)
    later = point.phase == table["phase"]  # not the earlier of two at a switch
    q, v, a = point.q, point.v, point.a
    dynamics = prowl.Dynamics(step.robot)

    def positions(sign: int) -> np.ndarray:
        return dynamics.contact_positions(prowl.integrate(q, sign * h * rate(q, a)))

    def velocities(sign: int) -> np.ndarray:
        J = dynamics.contact_jacobian(prowl.integrate(q, sign * h * rate(q, v)))
        return np.einsum("ncij,nj->nci", J, v)

    from_a, from_v = (positions(1) - positions(-1)) / (2 * h), -(velocities(1) - velocities(-1)) / (2 * h)
    compared = 0
    for c, name in enumerate(step.robot.contact_names):
        held = np.array([name in step.task.phases[phase].contacts for phase in table["phase"]])
        assert held.any() and (name != "lf_foot" or not held.all())
        for i, axis in enumerate("xyz"):
            columns = table[f"Ja_{name}_{axis}_mps2"], table[f"minus_Jdotv_{name}_{axis}_mps2"]
            assert np.isnan(columns[0][~held]).all(), "a swinging foot has nothing to be held against"
            rows = held & later
            np.testing.assert_allclose(columns[0][rows], from_a[rows, c, i], atol=1e-8)
            np.testing.assert_allclose(columns[1][rows], from_v[rows, c, i], atol=1e-6)
            compared += rows.sum()
    assert compared > 3000
    assert np.abs(from_v).max() > 0.01, "nothing moves"


def test_gains_are_those_of_the_tracker(step):
    table, joint = tables.gains(step, "lh_kfe_joint"), step.robot.joint_names.index("lh_kfe_joint")
    names = list(table)
    assert len(names) == 2 + 36
    assert [names[i] for i in (2, 7, 8, 20, 37)] == [
        "base_px_Npm",
        "base_rz_Nmprad",
        "q_lf_haa_joint_Nmprad",
        "base_vx_Nspm",
        "v_rh_kfe_joint_Nmsprad",
    ]
    t, K = table["time_s"], np.column_stack([table[name] for name in names[2:]])
    assert len(t) == len(step.tracker)
    assert set(table["segment"]) == set(range(len(step.task.phases) + 1)), "one a phase, and one to stand on with"
    inside = np.append(np.diff(t) > 0, False)  # at the end of a phase the tracker gives the later one
    expected = np.array([step.tracker.gains(time)[joint] for time in t[inside]])
    np.testing.assert_allclose(K[inside], expected, rtol=1e-8, atol=1e-8)


def test_the_gains_of_another_robot_are_refused(crouch, tmp_path):
    crouch.write(tmp_path / "hyq")
    prowl.solve(prowl.read_task("go2/stand"), progress=False).write(tmp_path / "go2")
    shutil.copy(tmp_path / "go2/tracker.bin", tmp_path / "hyq/tracker.bin")
    with pytest.raises(prowl.InputError):
        prowl.read_plan(tmp_path / "hyq")


def test_limits_are_those_of_the_posture(step):
    loader = importlib.machinery.SourceFileLoader("plot_knee", str(ROOT / "scripts/plot_knee"))
    plot_knee = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot_knee", loader))
    loader.exec_module(plot_knee)
    robot = step.robot
    limits = tomllib.loads(step.task.robot_text)["limits"]
    points = {
        joint: (keys["torque_over_position"], keys.get("negative_torque_over_position", keys["torque_over_position"]))
        for joint, keys in limits.items()
        if "torque_over_position" in keys
    }
    assert len(points) == 4 and list(robot.torque_over_position) == list(points)
    lower, upper = robot.torque_limits(step.q, step.v)
    for j, name in enumerate(robot.joint_names):
        for side, limit in enumerate((upper, -lower)):
            expected = np.full(len(step), robot.torque_limit[j])
            if name in points:
                expected = np.minimum(expected, plot_knee.limit_curve(points[name][side])(step.q[:, 7 + j]))
            np.testing.assert_allclose(limit[:, j], expected, rtol=1e-12)
    curves = tables.limit_curves(robot)
    assert list(curves) == list(points)
    for joint, (positions, upper, lower) in curves.items():
        np.testing.assert_allclose((positions[0], positions[-1]), robot.torque_over_position[joint], rtol=1e-12)
        for table, limit in zip(points[joint], (upper, -lower)):
            expected = np.minimum(plot_knee.limit_curve(table)(positions), robot.torque_limit.max())
            np.testing.assert_allclose(limit, expected, rtol=1e-9)


def test_legs_are_what_moves_contacts():
    legs = tables.legs(prowl.read_robot("talos"))
    assert len(legs) == 3, "two legs, and the rest"
    assert len(legs[0]) == 6 and all(joint.startswith("leg_left") for joint in legs[0])
    assert all(joint.startswith("leg_right") for joint in legs[1])
    assert "torso_1_joint" in legs[2]


def test_finds_joints(hyq):
    assert tables.gains_joint(hyq, None) == "lf_kfe_joint"
    go2 = prowl.read_robot("go2")
    assert not go2.torque_over_position
    assert tables.gains_joint(go2, None) == go2.joint_names[2]
    assert tables.gains_joint(hyq, "lh_kfe_joint") == "lh_kfe_joint"
    with pytest.raises(prowl.InputError, match="joint: HyQ has no joint 'lh_knee_joint'; did you mean 'lh_"):
        tables.gains_joint(hyq, "lh_knee_joint")


def test_figures_of_a_folder(crouch, tmp_path):
    crouch.write(tmp_path / "plan")
    seen = []
    with pytest.warns(UserWarning, match="^no simulation in .*: planned motion only"):
        drawn = prowl.figures(tmp_path / "plan", on_progress=lambda done, total: seen.append((done, total)))
    assert drawn.names == ["contact_acceleration", "gains", "torque_over_position", "torques"]
    assert seen == [(number, 4) for number in range(5)]
    assert drawn.folder == str(tmp_path / "plan/figures")
    assert drawn.files == sorted(path.name for path in (tmp_path / "plan/figures").iterdir())
    np.testing.assert_array_equal(drawn.plan.q, crouch.q)
    (tmp_path / "plan/figures/notes.txt").write_text("mine")
    with pytest.raises(prowl.FileError, match="notes.txt"):
        prowl.figures(tmp_path / "plan")
