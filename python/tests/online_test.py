"""Online control, against what the command makes of the same run."""

import json
import os
import subprocess

import numpy as np
import pytest

import prowl

COMMAND = os.environ["PROWL_COMMAND"]


@pytest.fixture(scope="module")
def hyq():
    return prowl.read_robot("hyq")


def test_the_command_runs_the_same(hyq):
    run = prowl.run_online(hyq, gait="trot", kicks=0.3, duration=3.0, seed=5, friction=0.7)
    command = [COMMAND, "mpc", "hyq", "--kicks", "0.3", "--duration", "3", "--seed", "5", "--friction", "0.7", "--json"]
    answer = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    mine = json.loads(run.to_json())
    for key in ("end_time_s", "velocity_error_mps", "turn_error_radps", "plans", "failed_plans", "forces", "failures"):
        assert mine[key] == answer[key], key
    assert run.success and not run.failures and not run.notes


def test_samples(hyq):
    run = prowl.run_online(hyq, command=(0.3, 0.0, 0.0), duration=3.0, record_rate=500.0)
    assert run.q.shape == (1501, hyq.nq) and run.v.shape == (1501, hyq.nv) and run.f.shape == (1501, 4, 3)
    np.testing.assert_allclose(run.t, np.arange(1501) * 0.002, atol=1e-9)
    assert run.commanded[-1, 0] == pytest.approx(0.3) and abs(run.moves[-500:, 0].mean() - 0.3) < 0.05
    weight = 9.81 * hyq.mass
    assert run.f[500:, :, 2].sum(axis=1).mean() == pytest.approx(weight, rel=0.05)
    assert len(run.plan_times) == 300 and (run.plan_times > 0).all()


def test_a_controller_steps_as_it_plans(hyq):
    controller = prowl.Controller(hyq, "stand")
    q, v = controller.standing, np.zeros(hyq.nv)
    assert controller.command(forward=100.0)[0] < 3.0
    assert controller.feet == [[0], [1], [2], [3]]
    for k in range(20):
        tau = controller.step(0.001 * k, q, v, [True] * 4)
    np.testing.assert_array_equal(tau, controller.torque(0.019, q, v))
    assert controller.failed == 0 and tau.shape == (12,)
    # The torques of standing still: those that MuJoCo needs to hold it are in the tests of the library.
    still = prowl.Controller(hyq, "stand", period=0.02).step(0.0, q, v)
    np.testing.assert_allclose(still, tau, atol=5.0)


def test_bad_input(hyq):
    with pytest.raises(prowl.InputError, match="canter"):
        prowl.run_online(hyq, gait="canter")
    with pytest.raises(prowl.InputError, match="period"):
        prowl.Controller(hyq, period=0.0)
    controller = prowl.Controller(hyq)
    with pytest.raises(prowl.InputError, match="need 19 and 18"):
        controller.update(0.0, np.zeros(3), np.zeros(3))
    with pytest.raises(prowl.InputError, match="4 feet"):
        controller.update(0.0, controller.standing, np.zeros(18), [True])
    assert not controller.update(0.0, np.full(19, np.nan), np.zeros(18))
    assert np.isfinite(controller.torque(0.0, np.full(19, np.nan), np.zeros(18))).all()
