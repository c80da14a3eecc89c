"""References become plans, or a reason: those of inverse kinematics, of plans, with planted flaws, and files that are none."""

import sys
from pathlib import Path

import numpy as np
import pytest
from prowl._retarget.reference import Reference
from prowl._retarget.stances import Feet, find_feet, spans

import prowl

sys.path.insert(0, str(Path(__file__).parents[2] / "bench" / "retarget"))
from references import CASES, write

CASE = {case.name: case for case in CASES}


@pytest.fixture(scope="module")
def crouch(tmp_path_factory):
    """A plan, as a folder."""
    folder = tmp_path_factory.mktemp("crouch") / "plan"
    prowl.solve("go2/crouch", progress=False).write(folder)
    return folder


def test_a_reference_of_inverse_kinematics_is_followed(tmp_path):
    done = prowl.retarget(write(CASE["go2_bow"], tmp_path), "go2", out=tmp_path / "out")
    assert done.followed and done.plan.good and done.reasons == () and done.flaws == ()
    assert done.joint_rms < 0.01 and done.time_scale == 1.0
    assert "followed" in done.summary()
    # What it wrote is a task for prowl plan, and the plan contains the reference.
    task = prowl.read_task(tmp_path / "out/task.toml")
    assert prowl.solve(task, gains=False, progress=False).cost == pytest.approx(done.plan.cost, rel=1e-6)
    (tmp_path / "out/reference.csv").unlink()
    assert prowl.read_plan(tmp_path / "out/plan").task.reference_text.startswith("time_s,")


def test_steps_are_found_from_height_and_speed(tmp_path):
    robot, case = prowl.read_robot("go2"), CASE["go2_steps"]
    t, q = robot.read_reference(write(case, tmp_path))
    reference = Reference(t, q)
    feet = find_feet(robot, reference, "")
    found = spans(feet, t)
    assert [sum(span.stands) for span in found] == [4, 3, 4, 3, 4, 3, 4, 3, 4]
    swings = [span for span in found if sum(span.stands) == 3]
    for step, swing in zip(case.steps, swings, strict=True):
        assert [names[0] for names, stands in zip(feet.names, swing.stands) if not stands] == [step.foot]
        # A swing begins and ends at rest, where it counts as a stance.
        assert step.start <= t[swing.first] and t[swing.last] <= step.end + 0.02
        assert t[swing.last] - t[swing.first] > 0.6 * (step.end - step.start)


def test_a_walk_is_followed(tmp_path):
    done = prowl.retarget(write(CASE["go2_steps"], tmp_path), "go2")
    assert done.followed and len(done.plan.task.phases) == 9


def test_the_motion_of_a_plan_is_followed_from_any_file(crouch, tmp_path):
    by_csv = prowl.retarget(crouch / "trajectory.csv", "go2")
    assert by_csv.followed and by_csv.joint_rms < 0.01
    prowl.export(crouch, "npz", out=tmp_path)
    assert prowl.retarget(tmp_path / "motion.npz", "go2").joint_rms == pytest.approx(by_csv.joint_rms, rel=1e-6)
    plan = prowl.read_plan(crouch)
    motion = plan.sample(1 / 50)
    np.savetxt(tmp_path / "rows.csv", motion.q, delimiter=",")
    assert prowl.retarget(tmp_path / "rows.csv", "go2", fps=50).followed
    joints = list(reversed(plan.robot.joint_names))
    np.savez(
        tmp_path / "mjlab.npz",
        fps=[50],
        joint_pos=motion.q[:, :6:-1],
        body_pos_w=motion.q[:, None, :3],
        body_quat_w=np.roll(motion.q[:, None, 3:7], 1, axis=2),
        joint_names=joints,
    )
    assert prowl.retarget(tmp_path / "mjlab.npz", "go2").followed


def test_a_foot_that_slides_is_told(tmp_path):
    done = prowl.retarget(write(CASE["go2_slide"], tmp_path), "go2")
    assert done.plan.good
    assert any(flaw.startswith("RR_foot: slides 2.0 cm while it stands") for flaw in done.flaws)
    assert "RR_foot: slides" in done.summary()


def test_what_is_too_fast_is_told_and_followed_in_longer_time(tmp_path):
    case = CASE["go2_quick"]
    path = write(case, tmp_path)
    at_once = prowl.retarget(path, "go2")
    assert not at_once.followed and at_once.reasons
    assert any(word in " ".join([*at_once.reasons, *at_once.flaws]) for word in case.told)
    slower = prowl.retarget(path, "go2", slowest=4.0)
    assert slower.followed and 1.0 < slower.time_scale <= 4.0
    assert slower.plan.duration == pytest.approx(at_once.plan.duration * slower.time_scale, rel=1e-9)


def change(path: Path, out: Path, row: int, column: int, value: str) -> Path:
    lines = path.read_text().splitlines()
    cells = lines[row].split(",")
    cells[column] = value
    lines[row] = ",".join(cells)
    out.write_text("\n".join(lines) + "\n")
    return out


def test_files_that_are_no_motion_are_refused_with_row_and_column(tmp_path):
    good, bad = write(CASE["go2_bow"], tmp_path), tmp_path / "bad.csv"
    for row, column, value, message in (
        (3, 0, "0.001", r"bad.csv:4: time_s: 0.001 is not allowed"),
        (5, 9, "nan", r"bad.csv:6: q_FL_thigh_joint_rad: nan is not allowed"),
        (5, 7, "0.3", r"bad.csv:6: length of base_qx ... base_qw: 0.3"),
        (7, 3, "0.1", r"bad.csv: row 7, F._foot: .* cm below the ground is not allowed; need at most 5 cm"),
        (2, 4, "abc", r"bad.csv:3: base_qx"),
    ):
        with pytest.raises(prowl.InputError, match=message):
            prowl.retarget(change(good, bad, row, column, value), "go2")
    with pytest.raises(prowl.InputError, match="no column q_lf_haa_joint_rad"):
        prowl.retarget(good, "hyq")
    rows = np.loadtxt(good, delimiter=",", skiprows=1)[:, 1:]
    np.savetxt(tmp_path / "rows.csv", rows, delimiter=",")
    with pytest.raises(prowl.InputError, match="need --fps"):
        prowl.retarget(tmp_path / "rows.csv", "go2")
    np.savetxt(tmp_path / "rows.csv", rows[:, :-1], delimiter=",")
    with pytest.raises(prowl.InputError, match="18 columns; Go2 needs 19"):
        prowl.retarget(tmp_path / "rows.csv", "go2", fps=50)
    with pytest.raises(prowl.InputError, match="no such file"):
        prowl.retarget(tmp_path / "none.csv", "go2")
    q = np.tile(prowl.read_robot("go2").nominal_configuration, (4, 1))
    whole = {"fps": [50], "joint_pos": q[:, 7:], "body_pos_w": q[:, None, :3], "body_quat_w": q[:, None, [6, 3, 4, 5]]}
    for arrays, message in (
        ({"fps": 50}, "no arrays joint_pos"),
        ({"t": [0.0, 1.0, 0.5, 2.0], "q": q}, "row 3, time: 0.5 is not allowed"),
        ({"t": [0.0, np.nan, 0.5, 2.0], "q": q}, "row 2, time: nan is not allowed"),
        ({"t": [0.0, 1.0], "q": q}, r"q of shape \(4, 19\) is not allowed; need numbers, 2 x 19"),
        ({"t": np.zeros(0), "q": q[:0]}, "0 samples; need two"),
        (whole | {"fps": [0]}, "fps"),
        (whole | {"body_quat_w": q[:, 3:7]}, "body_quat_w of shape"),
        (whole | {"joint_pos": q[:, 8:]}, "joint_pos of shape"),
        (whole | {"joint_names": ["a"] * 12}, "joints are not those of Go2"),
    ):
        np.savez(tmp_path / "bad.npz", **arrays)
        with pytest.raises(prowl.InputError, match=message):
            prowl.retarget(tmp_path / "bad.npz", "go2")
    content = (tmp_path / "bad.npz").read_bytes()
    for broken in (b"no zip", content[:200], b""):
        (tmp_path / "bad.npz").write_bytes(broken)
        with pytest.raises(prowl.InputError, match="no npz file"):
            prowl.retarget(tmp_path / "bad.npz", "go2")
    with pytest.raises(prowl.InputError, match="slowest: 0.5 is not allowed"):
        prowl.retarget(good, "go2", slowest=0.5)


def test_velocities_are_those_of_a_steady_motion():
    robot = prowl.read_robot("go2")
    rng, start = np.random.default_rng(1), robot.nominal_configuration
    v = np.concatenate([rng.standard_normal(6), rng.standard_normal(robot.nu)])
    t = np.arange(5) * 0.01
    q = [prowl.integrate(start, np.zeros(robot.nv))]
    for _ in t[1:]:  # the twist is in the base's frame, a tangent has its linear part in the world
        x, y, z, w = q[-1][3:7]
        u = np.array([x, y, z])
        linear = v[:3] + 2 * w * np.cross(u, v[:3]) + 2 * np.cross(u, np.cross(u, v[:3]))
        q.append(prowl.integrate(q[-1], 0.01 * np.concatenate([linear, v[3:]])))
    assert np.allclose(Reference(t, np.array(q)).velocities()[2], v, atol=0.01)


def test_ground_that_is_centimetres_off_is_put_right_and_more_refused(tmp_path):
    path = write(CASE["go2_bow"], tmp_path)
    rows = np.loadtxt(path, delimiter=",", skiprows=1)[:, 1:]
    for height, message in ((0.03, None), (-0.03, None), (0.3, "the lowest feet are at 30.0 cm")):
        moved = rows.copy()
        moved[:, 2] += height
        np.savetxt(tmp_path / "moved.csv", moved, delimiter=",")
        if message is None:
            done = prowl.retarget(tmp_path / "moved.csv", "go2", fps=50)
            assert done.followed and done.joint_rms < 0.01
            continue
        with pytest.raises(prowl.InputError, match=message):
            prowl.retarget(tmp_path / "moved.csv", "go2", fps=50)


def test_a_first_posture_beyond_the_joints_is_told_as_a_flaw(tmp_path):
    robot = prowl.read_robot("go2")
    q = np.array(robot.nominal_configuration)
    knee = robot.joint_names.index("FL_calf_joint")
    height = prowl.Dynamics(robot).contact_positions(q)[0, 2]
    for joint in ("FL", "FR", "RL", "RR"):
        q[7 + robot.joint_names.index(f"{joint}_calf_joint")] = robot.position_upper[knee] + 0.04
        q[7 + robot.joint_names.index(f"{joint}_thigh_joint")] = 0.45
    q[2] += height - prowl.Dynamics(robot).contact_positions(q)[:, 2].min()
    np.savetxt(tmp_path / "straight.csv", np.tile(q, (40, 1)), delimiter=",")
    done = prowl.retarget(tmp_path / "straight.csv", "go2", fps=50)
    assert done.plan.good and any(flaw.startswith("FL_calf_joint: up to 0.04 rad beyond") for flaw in done.flaws)


def test_feet_that_land_one_after_the_other_begin_one_phase():
    t = np.arange(40) / 50
    stands = np.ones((40, 4), dtype=bool)
    for foot, landing in enumerate((10, 11, 12, 13)):
        stands[:landing, foot] = False
    stands[0] = True
    found = spans(Feet([[str(i)] for i in range(4)], 0.0, np.zeros((40, 4, 3)), stands), t)
    assert [(span.first, span.last, sum(span.stands)) for span in found] == [(0, 10, 0), (10, 39, 4)]


def test_nothing_is_left_of_a_try_that_fails(tmp_path):
    good = write(CASE["go2_bow"], tmp_path)
    with pytest.raises(prowl.InputError):
        prowl.retarget(change(good, tmp_path / "bad.csv", 5, 9, "nan"), "go2", out=tmp_path / "out")
    assert not (tmp_path / "out").exists()
