"""Simulations, against what the command makes of the same plan, and the tracker."""

import json
import os
import subprocess

import numpy as np
import pytest

import prowl
from plan_test import columns

COMMAND = os.environ["PROWL_COMMAND"]


def test_the_command_simulates_the_same(crouch, tmp_path):
    for folder in ("command", "python"):
        crouch.write(tmp_path / folder)
    subprocess.run(
        [COMMAND, "simulate", tmp_path / "command", "--push", "0.5", "0", "10", "0", "--delay", "3", "--seed", "4"],
        check=True,
        capture_output=True,
    )
    simulation = prowl.simulate(crouch, pushes=[(0.5, (0.0, 10.0, 0.0))], delay=3e-3, seed=4)
    simulation.write(tmp_path / "python")
    for name in ("simulate.json", "simulate.csv"):
        assert (tmp_path / "python" / name).read_bytes() == (tmp_path / "command" / name).read_bytes(), name
    assert simulation.success and json.loads((tmp_path / "python/simulate.json").read_text())["success"]
    np.testing.assert_allclose(columns(tmp_path / "python/simulate.csv", "time_s")[:, 0], simulation.t, rtol=1e-15)


def test_without_feedback_it_falls(crouch):
    simulation = prowl.simulate(crouch, open_loop=True)
    assert not simulation.success and simulation.end == "fell"
    assert "fell" in simulation.failures[0] and np.abs(simulation.feedback).max() == 0.0
    assert simulation.end_time < prowl.simulate(crouch).end_time


def test_samples_are_those_of_the_robot(crouch):
    simulation = prowl.simulate(crouch, perfect_state=True, record_rate=100.0)
    assert simulation.q.shape == (len(simulation), 19) and not simulation.q.flags.writeable
    assert np.diff(simulation.t) == pytest.approx(0.01)
    np.testing.assert_array_equal(simulation.q_seen, simulation.q)
    load = simulation.f[-1].sum(axis=0)
    assert load[2] == pytest.approx(9.81 * crouch.robot.mass, rel=0.02), "it stands on its feet at the end"
    distance = np.linalg.norm((simulation.q - simulation.q_ref)[:, :3], axis=1).max()
    assert distance == pytest.approx(simulation.base_position_error.largest, rel=0.2)


def test_a_plan_that_is_not_good_has_no_gains_to_simulate(crouch):
    with pytest.raises(prowl.InputError, match="no gains"):
        prowl.simulate(prowl.solve(crouch.task, gains=False))


def test_the_tracker_is_its_formula(crouch, tmp_path):
    tracker, robot = crouch.tracker, crouch.robot
    k = 300
    t, K = tracker.t[k], tracker.K[k]
    np.testing.assert_allclose(tracker.gains(t), K, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(tracker.feedforward(t), tracker.tau[k], rtol=1e-9)
    q_ref, v_ref = tracker.reference(t)
    np.testing.assert_allclose(q_ref, tracker.q[k], atol=1e-12)
    tangent = 1e-3 * np.random.default_rng(3).standard_normal(robot.nv)
    v = v_ref + 1e-2
    q = prowl.integrate(q_ref, tangent)
    by_hand = K @ np.concatenate([prowl.difference(q, q_ref), v_ref - v])
    np.testing.assert_allclose(tracker.feedback(t, q, v), by_hand, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(tracker.torque(t, q, v), tracker.tau[k] + by_hand, rtol=1e-6)
    assert np.abs(tracker.torque(t, q, v + 100.0)).max() <= robot.torque_limit.max(), "within the limits"
    assert tracker.contacts(t) == robot.contact_names
    crouch.write(tmp_path / "plan")
    np.testing.assert_array_equal(prowl.Tracker.read(tmp_path / "plan/tracker.bin").K, tracker.K)
