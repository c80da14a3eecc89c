"""The judge on motions that are known: an exact one has no error, a wrong one has the error that was put in."""

import dataclasses

import numpy as np
import pinocchio as pin
import pytest
from hyq import integrate_exactly, rocking_motion, rocking_torque, standing_task

from judge.checker import coordinate_scales, judge, largest_in_a_second
from judge.contact_dynamics import ContactDynamics, standing_torques
from judge.motion import Motion
from judge.motion_task import Goal

DURATION = 0.2


def standing_still(task, intervals: int, torque: str, factor: float = 1.0) -> Motion:
    nodes = intervals + 1
    tau = factor * standing_torques(task.robot, task.start, task.phases[0].contacts)
    return Motion(
        np.linspace(0, task.duration, nodes),
        np.zeros(nodes, dtype=int),
        np.tile(task.start, (nodes, 1)),
        np.zeros((nodes, task.robot.model.nv)),
        np.tile(tau, (nodes, 1)),
        torque,
    )


def constant_torque_motion(task, q, v, tau) -> Motion:
    """One interval, exact at both ends."""
    times = np.array([0.0, task.duration])
    qs, vs = integrate_exactly(task, q, v, lambda t: tau, times)
    return Motion(times, np.zeros(2, dtype=int), qs, vs, np.array([tau, tau]), "held")


@pytest.mark.parametrize("torque", ["held", "linear"])
def test_standing_still_has_no_error_and_breaks_nothing(torque):
    task = standing_task(DURATION)
    verdict = judge(task, standing_still(task, 4, torque))
    assert verdict.error < 1e-9
    assert verdict.worst_share < 1e-3, verdict.worst
    assert abs(verdict.cost) < 1e-9


def test_the_cost_has_that_of_the_forces():
    """Standing still, while two feet pull at each other: half of weight x force², all feet, times the duration."""
    task = standing_task(DURATION)
    robot, data = task.robot, task.robot.model.createData()
    gravity = pin.computeGeneralizedGravity(robot.model, data, task.start)
    frames = [contact.frame for contact in robot.contacts]
    jacobian = np.vstack(
        [
            pin.computeFrameJacobian(robot.model, data, task.start, frame, pin.LOCAL_WORLD_ALIGNED)[:3]
            for frame in frames
        ]
    )
    forces = np.linalg.lstsq(jacobian[:, :6].T, gravity[:6], rcond=None)[0].reshape(-1, 3)
    first, last = (robot.places(task.start)[robot.contacts[foot].name] for foot in (0, 3))
    forces[0] += 40.0 * (last - first)
    forces[3] -= 40.0 * (last - first)
    motion = standing_still(task, 4, "held")
    motion = dataclasses.replace(motion, tau=np.tile((gravity - jacobian.T @ forces.ravel())[6:], (5, 1)))
    torque_cost = judge(task, motion).cost
    for axis, weight in enumerate((1e-3, 2e-3, 3e-3)):
        costly = dataclasses.replace(task, cost=dataclasses.replace(task.cost, force=weight * np.eye(3)[axis]))
        expected = 0.5 * weight * (forces[:, axis] ** 2).sum() * DURATION
        assert expected > 1e-2, "no force, so that the test checks nothing"
        assert judge(costly, motion).cost - torque_cost == pytest.approx(expected, rel=1e-6)


def test_standing_with_wrong_torques_has_an_error():
    task = standing_task(DURATION)
    assert judge(task, standing_still(task, 4, "held", factor=0.99)).error > 1e-4


def test_contact_dynamics_balance_and_hold_the_contacts():
    task = standing_task(DURATION)
    model, data = task.robot.model, task.robot.model.createData()
    dynamics = ContactDynamics(task.robot, frozenset({"lf_foot", "rh_foot", "lh_foot"}))
    random = np.random.default_rng(3)
    q, v = pin.integrate(model, task.start, 0.2 * random.normal(size=model.nv)), random.normal(size=model.nv)
    tau = 50 * random.normal(size=12)
    a, forces, speeds = dynamics(q, v, tau)
    jacobian = dynamics.jacobian(q)
    left = pin.rnea(model, data, q, v, a) - jacobian.T @ forces.ravel()
    assert np.abs(left - np.append(np.zeros(6), tau)).max() < 1e-8

    # Velocity of the contacts a moment later, along q ⊕ (v dt + a dt²/2), v + a dt: it does not change.
    def contact_velocity(dt):
        return dynamics(pin.integrate(model, q, v * dt + a * dt**2 / 2), v + a * dt, tau)[2].ravel()

    dt = 1e-5
    assert np.abs(contact_velocity(dt) - contact_velocity(-dt)).max() / (2 * dt) < 1e-4
    assert np.abs(speeds).max() > 0.1, "the contacts stand still, so that there was nothing to hold"


def test_error_of_exact_nodes_is_that_of_the_torque_between_them():
    task = standing_task(DURATION)
    errors = {
        torque: [judge(task, rocking_motion(task, n, torque)).error for n in (5, 10, 20)]
        for torque in ("held", "linear")
    }
    for coarse, fine in zip(errors["held"], errors["held"][1:]):
        assert 3.3 < coarse / fine < 4.7  # τ off by h, for a time h
    for coarse, fine in zip(errors["linear"], errors["linear"][1:]):
        assert 6.5 < coarse / fine < 9.5  # τ off by h², for a time h
    assert errors["linear"][-1] < errors["held"][-1] / 20


def test_linear_torque_is_followed_exactly():
    task = standing_task(DURATION)
    times = np.linspace(0, DURATION, 3)
    first, second = rocking_torque(task, 0.0), rocking_torque(task, 0.1)

    def torque(t):
        return first + (second - first) * t / DURATION

    q, v = integrate_exactly(task, task.start, np.zeros(18), torque, times)
    tau = np.array([torque(t) for t in times])
    linear, held = (
        judge(task, Motion(times, np.zeros(3, dtype=int), q, v, tau, kind)).error for kind in ("linear", "held")
    )
    assert linear < 1e-8
    assert held > 1e-3


def test_euler_steps_err_by_the_square_of_the_step():
    task = standing_task(DURATION)
    dynamics = ContactDynamics(task.robot, task.phases[0].contacts)
    verdicts = []
    for n in (10, 20, 40):
        h, q, v = DURATION / n, [task.start], [np.zeros(18)]
        tau = [rocking_torque(task, k * h) for k in range(n + 1)]
        for k in range(n):
            v.append(v[-1] + h * dynamics(q[-1], v[-1], tau[k])[0])
            q.append(pin.integrate(task.robot.model, q[-1], h * v[-1]))
        verdicts.append(
            judge(
                task,
                Motion(
                    np.arange(n + 1) * h, np.zeros(n + 1, dtype=int), np.array(q), np.array(v), np.array(tau), "held"
                ),
            )
        )
    for coarse, fine in zip(verdicts, verdicts[1:]):
        assert 3.3 < coarse.error / fine.error < 4.7
        assert 1.7 < coarse.error_per_second / fine.error_per_second < 2.3


@pytest.mark.parametrize("coordinate", [1, 4, 10])
def test_what_is_put_into_velocity_and_position_is_found(coordinate):
    task = standing_task(DURATION)
    motion = standing_still(task, 4, "linear")
    v = motion.v.copy()
    v[-1, coordinate] += 1e-3
    wrong = dataclasses.replace(motion, v=v)
    assert judge(task, wrong).error == pytest.approx(1e-3 / (1 + 1e-3), rel=1e-3)
    q = motion.q.copy()
    tangent = np.zeros(18)
    tangent[coordinate] = 1e-3
    q[-1] = pin.integrate(task.robot.model, q[-1], tangent)
    assert judge(task, dataclasses.replace(motion, q=q)).error == pytest.approx(1e-3 / (1 + 1e-3), rel=1e-3)


def test_times_of_nodes_may_be_uneven():
    task = standing_task(DURATION)
    times = np.array([0.0, 0.01, 0.07, 0.1, 0.2])
    q, v = integrate_exactly(task, task.start, np.zeros(18), lambda t: rocking_torque(task, 0.1), times)
    motion = Motion(times, np.zeros(5, dtype=int), q, v, np.tile(rocking_torque(task, 0.1), (5, 1)), "held")
    assert judge(task, motion).error < 1e-8
    assert judge(task, dataclasses.replace(motion, time=np.linspace(0, DURATION, 5))).error > 1e-3


def swinging_foot(task, descent: float, push: float) -> Motion:
    """The left fore foot goes down from 10 mm at `descent` [m/s] and is pushed up again, to 10 mm at the end."""
    robot, model = task.robot, task.robot.model
    foot = ContactDynamics(robot, frozenset({"lf_foot"}))
    q, leg = task.start.copy(), slice(6, 9)

    def leg_jacobian(q):
        foot(q, np.zeros(18), np.zeros(12))
        return foot.jacobian(q)[:, leg]

    for _ in range(20):
        away = np.array([*robot.places(task.start)["lf_foot"][:2], task.floor + robot.contact("lf_foot").radius + 0.01])
        q[7:10] += np.linalg.solve(leg_jacobian(q), away - robot.places(q)["lf_foot"])
    v, a = np.zeros(18), np.zeros(18)
    v[leg] = np.linalg.solve(leg_jacobian(q), [0, 0, -descent])
    a[leg] = np.linalg.solve(leg_jacobian(q), [0, 0, push])
    stance = ContactDynamics(robot, task.phases[0].contacts)
    need = pin.rnea(model, model.createData(), q, v, a)
    stance(q, v, np.zeros(12))
    jacobian = stance.jacobian(q)
    forces = np.linalg.lstsq(jacobian[:, :6].T, need[:6], rcond=None)[0]
    return constant_torque_motion(task, q, v, (need - jacobian.T @ forces)[6:])


def test_penetration_between_nodes_is_found():
    duration = 0.04
    task = standing_task(duration, frozenset({"lh_foot", "rf_foot", "rh_foot"}))
    motion = swinging_foot(task, descent=0.8, push=40.0)
    radius = task.robot.contact("lf_foot").radius
    heights = [task.robot.places(q)["lf_foot"][2] - radius for q in motion.q]
    assert min(heights) > 2e-3, "a node is in the ground, so that the test is of nodes only"
    verdict = judge(task, motion)
    assert verdict.error < 1e-8
    assert verdict.findings["penetration"].value < 1e-6
    deep = judge(task, swinging_foot(task, descent=1.3, push=65.0)).findings["penetration"]
    assert deep.where == "lf_foot"
    assert 1e-3 < deep.value < 5e-3  # 10 mm - 1.3² / (2 x 65) = -3 mm
    assert 0.2 * duration < deep.time < 0.8 * duration


def test_torque_beyond_the_knee_curve_and_the_limit():
    task = standing_task(DURATION)
    motion = standing_still(task, 1, "linear")
    tau = motion.tau.copy()
    tau[:, 2] = 1.1 * task.robot.torque_bound(task.start, np.ones(12))[2]
    finding = judge(task, dataclasses.replace(motion, tau=tau)).findings["torque"]
    assert finding.where == "lf_kfe_joint" and finding.value >= 0.0999
    assert (
        task.robot.torque_bound(task.start, np.ones(12))[2] == pytest.approx(144.3, abs=0.5)
        and task.robot.torque_limit[2] == 150.0
    )


def test_friction_and_slip():
    task = dataclasses.replace(standing_task(DURATION), friction=1e-6)
    motion = standing_still(task, 1, "held")
    _, forces, _ = ContactDynamics(task.robot, task.phases[0].contacts)(task.start, np.zeros(18), motion.tau[0])
    tangential = np.hypot(forces[:, 0], forces[:, 1]).max()
    assert judge(task, motion).findings["friction"].value == pytest.approx(tangential, abs=1e-2)
    slid = motion.q.copy()
    slid[1, 0] += 3e-3  # the whole robot, feet too
    slid = dataclasses.replace(
        motion,
        time=np.array([0, 0.1, 0.2]),
        phase=np.zeros(3, dtype=int),
        q=np.vstack([slid, slid[1]]),
        v=np.zeros((3, 18)),
        tau=np.vstack([motion.tau, motion.tau[:1]]),
    )
    assert judge(task, slid).findings["slip"].value == pytest.approx(3e-3, abs=1e-5)


def test_goals_are_measured_in_their_own_units():
    goal = Goal(
        phase=0,
        fraction=1.0,
        position=np.array([0.02, np.nan, np.nan]),
        rotation=pin.rpy.rpyToMatrix(0.0, 0.03, 0.0),
        turn=np.array([True, True, True]),
        velocity=np.array([np.nan, 0.04, 0, 0, 0, 0]),
    )
    task = dataclasses.replace(standing_task(DURATION), goals=(goal,))
    findings = judge(task, standing_still(task, 2, "linear")).findings
    assert findings["goal position"].value == pytest.approx(0.02)
    assert findings["goal angle"].value == pytest.approx(0.03)
    assert findings["goal velocity"].value == pytest.approx(0.04)


def test_a_foot_has_to_open_without_force_and_to_land_on_its_place():
    task = standing_task(DURATION)
    every, three = task.phases[0].contacts, task.phases[0].contacts - {"lf_foot"}
    foot = task.robot.places(task.start)["lf_foot"]
    aside = {"lf_foot": np.array([foot[0] + 4e-3, foot[1], -3e-3])}
    phases = [
        dataclasses.replace(task.phases[0], contacts=contacts, duration=0.1, places=places)
        for contacts, places in ((every, {}), (three, {}), (every, aside))
    ]
    task = dataclasses.replace(task, phases=tuple(phases))
    still = standing_still(task, 5, "held")
    motion = dataclasses.replace(still, time=np.array([0, 0.1, 0.1, 0.2, 0.2, 0.3]), phase=np.array([0, 0, 1, 1, 2, 2]))
    findings = judge(task, motion).findings
    dynamics = ContactDynamics(task.robot, every)
    force = dynamics(task.start, np.zeros(18), still.tau[0])[1][[c.name for c in dynamics.contacts].index("lf_foot")]
    assert findings["force before opening"].value == pytest.approx(np.linalg.norm(force), rel=1e-6)
    assert findings["force before opening"].value > 100.0
    assert findings["landing"].value == pytest.approx(5e-3, abs=1e-9)


def test_nan_is_the_worst_there_is():
    task = standing_task(DURATION)
    motion = standing_still(task, 2, "held")
    v = motion.v.copy()
    v[1, 8] = np.nan
    verdict = judge(task, dataclasses.replace(motion, v=v))
    assert verdict.error == np.inf and verdict.worst_share != verdict.worst_share


def test_largest_in_a_second_does_not_depend_on_the_mesh():
    for n in (10, 40):
        times = np.linspace(0, 3, 3 * n + 1)[1:]
        errors = np.full((3 * n, 2), [1.0 / n, 0.5 / n])
        assert largest_in_a_second(times, errors) == pytest.approx(1.0)


def test_scales_count_positions_from_the_first_node():
    task = standing_task(DURATION)
    motion = standing_still(task, 1, "held")
    far = motion.q.copy()
    far[:, 0] += 100.0
    assert np.allclose(coordinate_scales(dataclasses.replace(motion, q=far)), 1.0)
