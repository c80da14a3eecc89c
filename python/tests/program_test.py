"""A task as a nonlinear program: sizes, bounds, exact derivatives, and what a point of it is worth."""

import numpy as np
import pytest

import prowl

G = np.random.default_rng(3)


@pytest.fixture(scope="module")
def program() -> prowl.Program:
    return prowl.Program(prowl.read_task("hyq/stand", intervals=5))


def dense(pattern, values: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    matrix = np.zeros(shape)
    np.add.at(matrix, pattern, values)
    return matrix


def near(program: prowl.Program) -> np.ndarray:
    return program.start + 1e-2 * G.standard_normal(program.num_variables)


def directional(function, z: np.ndarray, direction: np.ndarray) -> np.ndarray:
    step = 1e-5
    return (function(z + step * direction) - function(z - step * direction)) / (2 * step)


def test_sizes_and_bounds_belong_together(program):
    assert (program.dynamics, program.transcription, program.contact, program.orientation) == (
        "inverse",
        "trapezoid",
        "stabilised",
        "se3",
    )
    assert program.nodes == 6
    assert (
        program.start.shape == program.variable_lower.shape == program.variable_upper.shape == (program.num_variables,)
    )
    assert program.constraint_lower.shape == program.constraint_upper.shape == (program.num_constraints,)
    assert np.all(program.variable_lower <= program.variable_upper) and np.all(
        program.constraint_lower <= program.constraint_upper
    )
    assert np.all(program.start >= program.variable_lower - 1e-9) and np.all(
        program.start <= program.variable_upper + 1e-9
    )
    for (rows, columns), shape in (
        (program.jacobian_pattern, (program.num_constraints, program.num_variables)),
        (program.hessian_pattern, (program.num_variables, program.num_variables)),
    ):
        assert rows.shape == columns.shape and rows.min() >= 0 and columns.min() >= 0
        assert rows.max() < shape[0] and columns.max() < shape[1]
        assert len(set(zip(rows.tolist(), columns.tolist(), strict=True))) == rows.size
    rows, columns = program.hessian_pattern
    assert np.all(rows >= columns)
    for array in (program.start, program.variable_lower, rows):
        assert not array.flags.writeable


def test_first_derivatives_are_those_of_differences(program):
    z = near(program)
    jacobian = dense(program.jacobian_pattern, program.jacobian(z), (program.num_constraints, program.num_variables))
    assert np.abs(jacobian).max() > 0.1
    for _ in range(5):
        direction = G.standard_normal(z.size)
        np.testing.assert_allclose(
            program.cost_gradient(z) @ direction, directional(program.cost, z, direction), rtol=1e-6
        )
        found, numeric = jacobian @ direction, directional(program.constraints, z, direction)
        np.testing.assert_allclose(found, numeric, atol=1e-6 * np.abs(numeric).max())


def test_the_hessian_is_that_of_differences_of_the_gradient(program):
    z, multipliers, factor = near(program), G.standard_normal(program.num_constraints), 0.7
    shape = (program.num_variables,) * 2
    lower = dense(program.hessian_pattern, program.hessian(z, factor, multipliers), shape)
    hessian = lower + np.tril(lower, -1).T

    def gradient(at: np.ndarray) -> np.ndarray:
        jacobian = dense(
            program.jacobian_pattern, program.jacobian(at), (program.num_constraints, program.num_variables)
        )
        return factor * program.cost_gradient(at) + multipliers @ jacobian

    for _ in range(3):
        direction = G.standard_normal(z.size)
        numeric = directional(gradient, z, direction)
        np.testing.assert_allclose(hessian @ direction, numeric, atol=1e-5 * np.abs(numeric).max())


def test_rows_and_variables_are_told_in_the_words_of_the_task(program):
    rows = [program.describe_constraint(i) for i in range(program.num_constraints)]
    variables = [program.describe_variable(i) for i in range(program.num_variables)]
    assert len(set(rows)) == len(rows) and len(set(variables)) == len(variables)
    assert any("lf_foot" in row and "friction cone" in row for row in rows)
    with pytest.raises(prowl.InputError, match=f"need 0 to {len(rows) - 1}"):
        program.describe_constraint(len(rows))


def test_a_point_is_judged(crouch):
    program = prowl.Program(crouch.task)
    z = np.clip(program.start, program.variable_lower, program.variable_upper)
    guess = program.judge(z)
    assert not guess.certificate.passed and guess.constraint_violation > 1e-3
    assert isinstance(guess.worst_check, prowl.Check)
    assert guess.check("contact drift").unit == "m" and guess.check("nothing") is None
    assert guess.motion.q.shape == (sum(phase.intervals for phase in crouch.task.phases) + 1, 19)
    np.testing.assert_allclose(guess.cost, program.cost(z))
    rows = program.constraints(z)
    outside = max((program.constraint_lower - rows).max(), (rows - program.constraint_upper).max())
    np.testing.assert_allclose(guess.constraint_violation, outside)


def test_a_straight_guess_is_straight_and_stands(program):
    straight = prowl.Program(program.task, guess="straight")
    motion = straight.judge(straight.start).motion
    robot = program.task.robot
    np.testing.assert_array_equal(motion.v, 0.0)
    np.testing.assert_array_equal(motion.a, 0.0)
    steps = [prowl.difference(motion.q[0], q) for q in motion.q]
    for k, step in enumerate(steps):
        np.testing.assert_allclose(step, k / 5 * steps[-1], atol=1e-9)
    np.testing.assert_allclose(steps[-1][:3], [0.05, 0.03, -0.05], atol=1e-9)
    feet = prowl.Dynamics(robot).contact_positions(motion.q)
    np.testing.assert_allclose(feet[-1], feet[0], atol=1e-7)
    held = prowl.Dynamics(robot).forward(motion.q[0], motion.v[0], motion.tau[0])
    assert np.abs(held.value).max() < 1e-6 and np.all(motion.tau == motion.tau[0])


def test_what_makes_no_sense_is_refused(program):
    for choice in (
        {"dynamics": "backward"},
        {"transcription": "euler"},
        {"contact": "magnetic"},
        {"orientation": "north"},
        {"guess": "wild"},
    ):
        ((name, value),) = choice.items()
        with pytest.raises(prowl.InputError, match=f'{name}: "{value}" is not allowed; need one of'):
            prowl.Program(program.task, **choice)
    with pytest.raises(prowl.InputError, match=rf"z: shape \(3\) is not allowed; need \({program.num_variables}\)"):
        program.cost(np.zeros(3))
    with pytest.raises(prowl.InputError, match="multipliers: shape"):
        program.hessian(program.start, 1.0, np.zeros(2))
