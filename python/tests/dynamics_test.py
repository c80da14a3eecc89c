"""Dynamics against Pinocchio's own Python package in the same process, and against differences."""

import numpy as np
import pinocchio as pin
import pytest

import prowl

G = np.random.default_rng(7)


@pytest.fixture(scope="module", params=["hyq", "solo12", "talos"])
def robot(request) -> prowl.Robot:
    return prowl.read_robot(request.param)


@pytest.fixture(scope="module")
def model(robot) -> pin.Model:
    model = pin.buildModelFromUrdf(str(robot.urdf), pin.JointModelFreeFlyer())
    assert list(model.names[2:]) == robot.joint_names
    return model


def states(robot: prowl.Robot, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """About the nominal posture: q (count, nq), v (count, nv), tau (count, nu)."""
    q = prowl.integrate(np.tile(robot.nominal_configuration, (count, 1)), 0.3 * G.standard_normal((count, robot.nv)))
    return q, G.standard_normal((count, robot.nv)), 20 * G.standard_normal((count, robot.nu))


def contact_kinematics(robot: prowl.Robot, model: pin.Model, q: np.ndarray, v: np.ndarray):
    """Positions, Jacobian and drift (acceleration at a = 0) of all contact points, from Pinocchio's frames."""
    data, world = model.createData(), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
    pin.computeJointJacobians(model, data, q)
    pin.updateFramePlacements(model, data)
    positions, jacobians, drifts = [], [], []
    for contact in robot.contacts:
        frame = model.getFrameId(contact.frame)
        arm = data.oMf[frame].rotation @ contact.offset
        positions.append(data.oMf[frame].translation + arm)
        J = pin.getFrameJacobian(model, data, frame, world)
        jacobians.append(J[:3] - pin.skew(arm) @ J[3:])
        turn = pin.getFrameVelocity(model, data, frame, world).angular
        acceleration = pin.getFrameClassicalAcceleration(model, data, frame, world)
        drifts.append(acceleration.linear + np.cross(acceleration.angular, arm) + np.cross(turn, np.cross(turn, arm)))
    return np.array(positions), np.array(jacobians), np.array(drifts)


def relative(difference: np.ndarray, to: np.ndarray) -> float:
    return np.abs(difference).max() / np.abs(to).max()


def test_mass_matrix_and_bias_are_pinocchios(robot, model):
    q, v, _ = states(robot, 5)
    dynamics, data = prowl.Dynamics(robot, contacts=[]), model.createData()
    M, h = dynamics.mass_matrix(q), dynamics.bias(q, v)
    assert M.shape == (5, robot.nv, robot.nv)
    for i in range(5):
        pin.crba(model, data, q[i], pin.Convention.WORLD)
        upper = np.triu(data.M)
        assert relative(M[i] - (upper + np.triu(data.M, 1).T), upper) < 1e-12
        assert relative(h[i] - pin.nle(model, data, q[i], v[i]), h[i]) < 1e-12


def test_in_the_air_accelerations_are_pinocchios(robot, model):
    q, v, tau = states(robot, 5)
    found = prowl.Dynamics(robot, contacts=[]).forward(q, v, tau)
    assert found.force.shape == (5, 0, 3)
    for i in range(5):
        a = pin.aba(model, model.createData(), q[i], v[i], np.concatenate([np.zeros(6), tau[i]]))
        assert relative(found.value[i] - a, a) < 1e-9


def test_in_contact_accelerations_and_forces_solve_pinocchios_equations(robot, model):
    """Also Talos' flat feet, 24 forces of rank 12: the least-squares solution of least norm has the same forces."""
    q, v, tau = states(robot, 5)
    dynamics = prowl.Dynamics(robot)
    found, positions, jacobians = (
        dynamics.forward(q, v, tau),
        dynamics.contact_positions(q),
        dynamics.contact_jacobian(q),
    )
    for i in range(5):
        p, J, drift = contact_kinematics(robot, model, q[i], v[i])
        np.testing.assert_allclose(positions[i], p, atol=1e-12)
        np.testing.assert_allclose(jacobians[i], J, atol=1e-12)
        J = J.reshape(-1, robot.nv)
        M = pin.crba(model, model.createData(), q[i], pin.Convention.WORLD)
        M = np.triu(M) + np.triu(M, 1).T
        kkt = np.block([[M, -J.T], [J, np.zeros((J.shape[0],) * 2)]])
        forces = np.concatenate([np.zeros(6), tau[i]]) - pin.nle(model, model.createData(), q[i], v[i])
        solution = np.linalg.lstsq(kkt, np.concatenate([forces, -drift.ravel()]), rcond=1e-12)[0]
        assert relative(found.value[i] - solution[: robot.nv], solution[: robot.nv]) < 1e-8
        assert relative(found.force[i].ravel() - solution[robot.nv :], solution[robot.nv :]) < 1e-8


def test_the_residual_vanishes_on_the_dynamics_and_only_there(robot):
    q, v, tau = states(robot, 4)
    dynamics = prowl.Dynamics(robot)
    forward = dynamics.forward(q, v, tau)
    inverse = dynamics.residual(q, v, forward.value, tau)
    weight = 9.81 * robot.mass
    assert np.abs(inverse.value).max() < 1e-7 * weight
    np.testing.assert_allclose(inverse.force, forward.force, atol=1e-6 * np.abs(forward.force).max())
    elsewhere = dynamics.residual(q, v, forward.value + 0.1, tau)
    assert np.abs(elsewhere.value).max(axis=1).min() > 1e-4 * weight


def central_difference(function, argument: np.ndarray, move) -> np.ndarray:
    """Derivative of function(argument) in directions of move(argument, direction), as a further axis at the end."""
    step = 1e-6
    size = argument.size - (1 if move is prowl.integrate else 0)
    columns = [
        (function(move(argument, step * e)) - function(move(argument, -step * e))) / (2 * step) for e in np.eye(size)
    ]
    return np.stack(columns, axis=-1)


@pytest.mark.parametrize("quantity", ["value", "force"])
def test_derivatives_are_those_of_differences(hyq, quantity):
    q, v, tau = (rows[0] for rows in states(hyq, 1))
    a = G.standard_normal(hyq.nv)
    dynamics = prowl.Dynamics(hyq, contacts=["lf_foot", "rh_foot", "lh_foot"])
    add = np.add
    for name, exact, arguments in (
        ("forward", dynamics.forward(q, v, tau, derivatives=True), [q, v, tau]),
        ("residual", dynamics.residual(q, v, a, tau, derivatives=True), [q, v, a, tau]),
    ):
        derivatives = getattr(exact, f"{quantity}_derivatives")
        for i, key in enumerate(["q", "v", "tau"] if name == "forward" else ["q", "v", "a", "tau"]):

            def function(x, i=i, name=name, arguments=arguments):
                return getattr(getattr(dynamics, name)(*arguments[:i], x, *arguments[i + 1 :]), quantity)

            numeric = central_difference(function, arguments[i], prowl.integrate if key == "q" else add)
            found = getattr(derivatives, key)
            assert found.shape == numeric.shape
            assert relative(found - numeric, numeric) < 1e-6, (name, key)


def test_many_states_are_one_by_one_and_threads_change_nothing(hyq):
    q, v, tau = states(hyq, 50)
    one, two = prowl.Dynamics(hyq), prowl.Dynamics(hyq, threads=2)
    many, shared = one.forward(q, v, tau, derivatives=True), two.forward(q, v, tau, derivatives=True)
    assert many.value_derivatives.q.shape == (50, 18, 18) and many.force_derivatives.tau.shape == (50, 4, 3, 12)
    for i in (0, 17, 49):
        single = one.forward(q[i], v[i], tau[i], derivatives=True)
        np.testing.assert_array_equal(single.value, many.value[i])
        np.testing.assert_array_equal(single.force_derivatives.v, many.force_derivatives.v[i])
    np.testing.assert_array_equal(many.value, shared.value)
    np.testing.assert_array_equal(many.value_derivatives.q, shared.value_derivatives.q)
    assert many.value_derivatives.a is None and one.forward(q, v, tau).value_derivatives is None


def test_integrate_and_difference_undo_each_other(hyq):
    q, v, _ = states(hyq, 20)
    moved = prowl.integrate(q, v)
    np.testing.assert_allclose(prowl.difference(q, moved), v, atol=1e-12)
    model = pin.buildModelFromUrdf(str(hyq.urdf), pin.JointModelFreeFlyer())
    for i in range(20):  # Pinocchio's tangent has the displacement in the base frame, and moves along a screw
        rotation = pin.Quaternion(q[i, 3:7]).matrix()
        turn = v[i].copy()
        turn[:3] = 0
        np.testing.assert_allclose(prowl.integrate(q[i], turn), pin.integrate(model, q[i], turn), atol=1e-12)
        small = 1e-7 * v[i]
        local = np.concatenate([rotation.T @ small[:3], small[3:]])
        np.testing.assert_allclose(prowl.integrate(q[i], small), pin.integrate(model, q[i], local), atol=1e-13)


def test_a_plan_obeys_the_dynamics_that_pinocchio_has(crouch):
    robot = crouch.robot
    model = pin.buildModelFromUrdf(str(robot.urdf), pin.JointModelFreeFlyer())
    data = model.createData()
    for k in range(0, len(crouch), 8):
        wrench = pin.rnea(model, data, crouch.q[k], crouch.v[k], crouch.a[k]) - np.concatenate(
            [np.zeros(6), crouch.tau[k]]
        )
        pin.computeJointJacobians(model, data, crouch.q[k])
        pin.updateFramePlacements(model, data)
        for name, force in zip(robot.contact_names, crouch.f[k], strict=True):
            J = pin.getFrameJacobian(model, data, model.getFrameId(name), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)[:3]
            wrench -= J.T @ force
        assert np.abs(wrench).max() < 1e-5 * 9.81 * robot.mass
