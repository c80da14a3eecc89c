"""Tasks, plans and their files, against what the command makes of the same task."""

import csv
import gc
import json
import os
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pytest

import prowl

COMMAND = os.environ["PROWL_COMMAND"]  # the program of the same build


def columns(path: Path, start: str) -> np.ndarray:
    """Columns of a CSV file whose names start so, as rows."""
    with path.open() as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    chosen = [i for i, name in enumerate(rows[0]) if name.startswith(start)]
    assert chosen, f"no column {start}..."
    return np.array([[float(row[i]) for i in chosen] for row in rows[1:]])


def test_the_command_finds_the_same_plan_bit_for_bit(crouch, tmp_path):
    subprocess.run([COMMAND, "plan", crouch.task.path, "--out", tmp_path / "out"], check=True, capture_output=True)
    crouch.write(tmp_path / "python")
    for name in ("trajectory.csv", "tracker.bin"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "out" / name).read_bytes(), name
    found, made = (json.loads((tmp_path / folder / "plan.json").read_text()) for folder in ("out", "python"))
    for key in ("status", "good", "certificate", "problem", "versions", "task_file", "robot_file", "urdf"):
        assert found[key] == made[key], key


def test_arrays_hold_what_the_file_holds(crouch, tmp_path):
    crouch.write(tmp_path / "plan")
    file = tmp_path / "plan/trajectory.csv"
    assert crouch.t.shape == (len(crouch),) and len(crouch) == 41
    np.testing.assert_array_equal(columns(file, "time_s")[:, 0], crouch.t)
    np.testing.assert_array_equal(
        np.hstack([columns(file, "base_p"), columns(file, "base_q"), columns(file, "q_")]), crouch.q
    )
    np.testing.assert_array_equal(columns(file, "v_"), crouch.v[:, 6:])
    np.testing.assert_array_equal(columns(file, "a_"), crouch.a[:, 6:])
    np.testing.assert_array_equal(columns(file, "tau_"), crouch.tau)
    np.testing.assert_array_equal(columns(file, "f_"), crouch.f.reshape(len(crouch), -1))


def test_a_plan_that_was_read_is_the_one_that_was_written(crouch, tmp_path):
    crouch.write(tmp_path / "plan", step=0.01)
    again = prowl.read_plan(tmp_path / "plan")
    for name in ("t", "phase", "q", "v", "a", "tau", "f"):
        np.testing.assert_array_equal(getattr(again, name), getattr(crouch, name), err_msg=name)
    np.testing.assert_array_equal(again.tracker.K, crouch.tracker.K)
    assert again.good and again.certificate.grade == crouch.certificate.grade
    assert (tmp_path / "plan/trajectory_uniform.csv").exists()
    with pytest.raises(prowl.InputError, match="copy that folder"):
        again.write(tmp_path / "other")


def test_arrays_are_views_that_nobody_can_write_to_and_that_outlive_the_plan():
    plan = prowl.solve(prowl.read_task("hyq/hold"))
    for owner, names in ((plan, ("t", "phase", "q", "v", "a", "tau", "f")), (plan.tracker, ("q", "v", "tau", "K"))):
        for name in names:
            array = getattr(owner, name)
            assert np.shares_memory(array, getattr(owner, name)), f"{name} is a copy"
            assert not array.flags.writeable and not array.flags.owndata, name
    q, K = plan.q, plan.tracker.K
    values, gains = q.copy(), K.copy()
    del plan
    gc.collect()
    np.testing.assert_array_equal(q, values)
    np.testing.assert_array_equal(K, gains)


def test_a_plan_tells_itself_as_json(crouch, tmp_path):
    told = json.loads(crouch.to_json())
    assert told["good"] and "directory" not in told
    crouch.write(tmp_path / "out")
    assert json.loads(prowl.read_plan(tmp_path / "out").to_json())["directory"] == str(tmp_path / "out")


@pytest.fixture(scope="module")
def equal_steps() -> prowl.Plan:
    """HyQ's crouch on a mesh by hand."""
    return prowl.solve(prowl.read_task("hyq/crouch", intervals=80), progress=False)


def test_the_tube_of_a_plan_has_a_band_for_each_state_and_what_limits_leave(crouch):
    tube = prowl.tube(crouch)
    nv, nu = crouch.robot.nv, crouch.robot.nv - 6
    count = len(tube)
    assert tube.t.shape == tube.phase.shape == (count,) and tube.band.shape == (count, 2 * nv)
    assert tube.cone_left.shape == tube.cone_needed.shape == (count, 4)
    assert tube.torque_left.shape == tube.torque_needed.shape == (count, nu)
    assert tube.t[0] == 0.0 and tube.t[-1] == pytest.approx(crouch.duration) and np.diff(tube.t).max() < 0.0201
    assert (tube.band > 0.0).all() and (tube.torque_needed > 0.0).all()
    joint = crouch.robot.joint_names.index("lf_haa_joint")  # its limit is constant
    limit = np.abs(np.interp(tube.t, crouch.t, crouch.tau[:, joint])) + tube.torque_left[:, joint]
    np.testing.assert_allclose(limit, crouch.robot.torque_limit[joint], atol=1.0)  # less its losses
    finer = prowl.tube(crouch, step=0.005)
    np.testing.assert_allclose(np.interp(tube.t, finer.t, finer.band[:, 2]), tube.band[:, 2], rtol=0.02)
    with pytest.raises(prowl.InputError, match="step: 0 is not allowed"):
        prowl.tube(crouch, step=0.0)


def test_samples_between_nodes_lie_on_the_motion(equal_steps):
    crouch = equal_steps
    motion = crouch.sample(0.01)
    assert len(motion) == 201 and motion.t[-1] == crouch.duration
    np.testing.assert_allclose(crouch.at(crouch.t[:-1]).q, crouch.q[:-1], atol=1e-12)
    middle = crouch.at(0.5 * (crouch.t[:-1] + crouch.t[1:]))
    between = 0.5 * (crouch.q[:-1] + crouch.q[1:])
    assert 0 < np.abs(middle.q - between).max() < 1e-3
    with pytest.raises(prowl.InputError, match="need 0 <= t"):
        crouch.at([crouch.duration + 1.0])


def test_the_certificate_tells_good_from_bad(crouch):
    certificate = crouch.certificate
    assert crouch.good and certificate.passed and certificate.grade == "draft"
    names = [check.name for check in certificate.checks]
    assert {"contact drift", "friction cone", "joint torque"} <= set(names)
    assert all(check.worst <= check.limit for check in certificate.checks)
    assert "contact drift" in str(certificate) and "contact drift" in certificate._repr_html_()
    coarse = prowl.solve(prowl.read_task("hyq/crouch", intervals=20))
    assert coarse.status == "converged" and not coarse.good and coarse.tracker is None
    failed = [check.name for check in coarse.certificate.checks if not check.passed]
    assert "local integration error" in failed and all("integration" in name for name in failed), (
        "the mesh is too coarse"
    )
    assert "FAIL" in coarse.certificate._repr_html_()


def test_another_goal_from_python(crouch):
    document = tomllib.loads(crouch.task.text)
    document["goal"][0]["base_displacement_m"][2] = -0.10
    task = prowl.parse_task(document, folder=crouch.task.path.parent)
    plan = prowl.solve(task, start_from=crouch)
    assert plan.good
    lowest = plan.at([1.0]).q[0, 2] - plan.q[0, 2]
    assert lowest == pytest.approx(-0.10, abs=1e-3)
    assert crouch.at([1.0]).q[0, 2] - crouch.q[0, 2] == pytest.approx(-0.17, abs=1e-3)


def test_all_solvers_find_the_motion(crouch):
    assert prowl.solver_names() == ["riccati", "fatrop", "ipopt", "ipopt-spral", "uno"]
    for name in prowl.solver_names()[:-1]:
        plan = prowl.solve(crouch.task, solver=name, gains=False)
        assert plan.good and plan.solver.lower() == name and plan.tracker is None
        np.testing.assert_allclose(plan.q, crouch.q, atol=1e-4)


def test_uno_finds_the_motion_on_a_coarse_mesh():
    task = prowl.read_task("hyq/crouch", intervals=8)
    plan = prowl.solve(task, solver="uno", gains=False)
    assert plan.status == "converged" and plan.solver == "Uno"
    np.testing.assert_allclose(plan.q, prowl.solve(task, gains=False).q, atol=1e-4)


def test_what_comes_with_prowl(tmp_path):
    assert "hyq/crouch" in prowl.shipped_tasks() and "hyq" in prowl.shipped_robots()
    with pytest.raises(prowl.InputError, match="hyq/crouch"):
        prowl.read_task("hyq/crouhc")
    robot = prowl.read_robot("hyq")
    assert robot.joint_names == prowl.read_task("hyq/crouch").robot.joint_names
    assert (robot.nq, robot.nv, robot.nu) == (19, 18, 12) and robot.torque_limit[0] == 150.0


def test_progress_tells_every_iteration(capsys):
    seen = []
    task = prowl.read_task("hyq/crouch", intervals=80, tolerance=1e-8)  # the last iterate is a step before the end
    plan = prowl.solve(task, progress=True, on_iteration=lambda p: seen.append((p.intervals, p.iteration, p.cost)))
    assert {intervals for intervals, _, _ in seen} == {20, 80}
    assert len(seen) == plan.iterations
    assert seen[-1][2] == pytest.approx(plan.cost, rel=1e-6)
    assert f"{len(seen)} iterations" in capsys.readouterr().err


def test_iterates_have_their_motion():
    task = prowl.read_task("hyq/crouch", intervals=80, tolerance=1e-8)  # for the same reason
    crouch = prowl.solve(task, progress=False)
    progress, iterates = [], []
    plan = prowl.solve(task, on_iteration=progress.append, on_iterate=iterates.append)
    np.testing.assert_array_equal(plan.q, crouch.q, err_msg="who watches changes nothing")
    assert [(at.intervals, at.iteration) for at in iterates] == [(p.intervals, p.iteration) for p in progress]
    assert all(isinstance(at, prowl.Progress) and len(at.motion) == at.intervals + 1 for at in iterates)
    np.testing.assert_allclose(iterates[-1].motion.q, plan.q, atol=1e-6)
    assert np.abs(iterates[0].motion.tau - iterates[3].motion.tau).max() > 1e-3, "they differ on the way"
    motion = iterates[0].motion
    first = motion.q.copy()
    del iterates[:]
    gc.collect()
    np.testing.assert_array_equal(motion.q, first)


def test_what_on_iterate_raises_ends_the_solve(crouch):
    calls = []

    def stop(at: prowl.Iterate) -> None:
        calls.append(at)
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        prowl.solve(crouch.task, on_iterate=stop)
    assert len(calls) == 1
