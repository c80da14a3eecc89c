"""The cost of a plan, term by term."""

import tomllib

import numpy as np
import pytest

import prowl


def trapezoid(plan: prowl.Plan, rate: np.ndarray) -> float:
    """Over each phase: at a change of contacts there are two nodes at one time."""
    return sum(np.trapezoid(rate[plan.phase == p], plan.t[plan.phase == p]) for p in np.unique(plan.phase))


@pytest.mark.parametrize("name", ["hyq/crouch", "hyq/step", "talos/squat"])
def test_terms_add_up_to_the_cost_and_are_those_of_the_file(name):
    plan = prowl.solve(name, gains=False)
    document = tomllib.loads(plan.task.text)
    asked = set(document["cost"]) - {"reference", "torque_reference"}
    asked |= {f"terminal_cost.{key}" for key in set(document.get("terminal_cost", {})) - {"reference"}}
    assert plan.cost_terms and set(plan.cost_terms) <= asked
    assert sum(plan.cost_terms.values()) == pytest.approx(plan.cost, rel=1e-6)
    for key, rate in plan.cost_rates.items():
        assert rate.shape == (len(plan),)
        assert trapezoid(plan, rate) == pytest.approx(plan.cost_terms[key], rel=1e-9, abs=1e-12), key


def test_one_term_by_hand(crouch):
    weight = tomllib.loads(crouch.task.text)["cost"]["joint_acceleration"]
    by_hand = 0.5 * weight * (crouch.a[:, 6:] ** 2).sum(axis=1)
    np.testing.assert_allclose(crouch.cost_rates["joint_acceleration"], by_hand, rtol=1e-9)


def test_terms_of_a_plan_that_was_read_are_the_same(crouch, tmp_path):
    crouch.write(tmp_path / "plan")
    assert prowl.read_plan(tmp_path / "plan").cost_terms == pytest.approx(crouch.cost_terms, rel=1e-12)
