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
    run = prowl.run_online(hyq, command=(0.2, 0.0, 0.1), kicks=0.3, duration=4.5, seed=5, friction=0.7)
    command = [
        COMMAND,
        "mpc",
        "hyq",
        "--command",
        "0.2",
        "0",
        "0.1",
        "--kicks",
        "0.3",
        "--duration",
        "4.5",
        "--seed",
        "5",
        "--friction",
        "0.7",
        "--json",
    ]
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
    fell = q.copy()
    fell[2] -= 0.05  # a new plan pushes it up
    lower = [controller.step(0.001 * k, fell, v, [True] * 4) for k in range(20, 45)][-1]
    assert not np.allclose(lower, controller.torque(0.044, q, v), atol=1.0) and np.abs(lower - tau).max() > 5.0
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
    for t in (np.nan, np.inf, 0.02):
        assert np.isfinite(controller.step(t, controller.standing, np.zeros(18))).all()
    for options in ({"noise": -1.0}, {"kicks": np.nan}, {"mass": -1.0}, {"record_rate": np.nan}, {"friction": -1.0}):
        with pytest.raises(prowl.InputError, match=next(iter(options)).split("_")[0]):
            prowl.run_online(hyq, **options)
    with pytest.raises(prowl.InputError, match="need one of them at most"):
        prowl.run_online(hyq, command=(0.1, 0.0, 0.0), random_commands=0.1)
    with pytest.raises(prowl.InputError, match="push"):
        prowl.run_online(hyq, pushes=[(np.nan, (0.0, 1.0, 0.0))])


def test_a_planner_of_ones_own(hyq):
    """A planner that asks Prowl's controller: stands as that does, and is told what it was."""
    controller = prowl.Controller(hyq, "stand", delay=0.0)
    requests = []

    def plan(request):
        requests.append(request)
        q, v = np.array(request.q), np.array(request.v)
        controller.update(request.start, q, v, [True] * 4)
        t = request.start + np.array([0.0, 0.05])
        gains = np.zeros((1, hyq.nu, 2 * hyq.nv))
        gains[0, :, 6 : hyq.nv] = -400.0 * np.eye(hyq.nu)
        gains[0, :, hyq.nv + 6 :] = -15.0 * np.eye(hyq.nu)
        states = np.tile(controller.standing, (2, 1)), np.zeros((2, hyq.nv))
        tau = controller.torque(request.start, controller.standing, np.zeros(hyq.nv))
        return prowl.MotionSteps(t, *states, tau[None], gains, seconds=0.02)

    run = prowl.run_online(hyq, gait="stand", duration=1.0, planner=plan, late="wait")
    assert run.success and len(requests) == 50 and (run.plan_times == 0.02).all()
    first = requests[0]
    assert first.time == 0.0 and first.start == pytest.approx(0.012) and first.swing(0, 1.0) is None
    assert first.q.shape == (hyq.nq,) and len(first.command) == 4 and len(first.pose) == 3
    with pytest.raises(prowl.InputError, match="need 0 to 3"):
        first.swing(4, 0.0)


def test_bad_planners(hyq):
    def run(planner):
        prowl.run_online(hyq, duration=0.1, planner=planner)

    def fails(request):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        run(fails)
    with pytest.raises(prowl.InputError, match="neither"):
        run(lambda request: 3)
    wrong = prowl.MotionSteps(
        np.array([0.0, 1.0]), np.zeros((2, 8)), np.zeros((2, 7)), np.zeros((1, 1)), np.zeros((1, 1, 14))
    )
    with pytest.raises(prowl.InputError, match="7 numbers a row"):
        run(lambda request: wrong)
    with pytest.raises(prowl.InputError, match="tau is 2 x 1; need 1 x 1"):
        prowl.MotionSteps(
            np.array([0.0, 1.0]), np.zeros((2, 8)), np.zeros((2, 7)), np.zeros((2, 1)), np.zeros((1, 1, 14))
        )
    with pytest.raises(prowl.InputError, match="late"):
        prowl.run_online(hyq, duration=0.1, late="never")
    swings = []
    prowl.run_online(hyq, duration=0.05, planner=lambda request: swings.append(request.swing(0, 0.9)))
    assert swings[0] is not None and swings[0][1] > swings[0][0] > 0.5


def test_a_script(hyq, tmp_path):
    file = tmp_path / "script.toml"
    file.write_text(
        "[[command]]\ntime_s = 0.2\nvelocity_mps = [0.3, 0.0]\n\n[[command]]\ntime_s = 1.0\nvelocity_mps = [0.0, 0.1]\n"
    )
    run = prowl.run_online(hyq, script=file, duration=2.0)
    assert run.success and run.commanded[90, 0] > 0.2 and run.commanded[-1, 1] == pytest.approx(0.1)
    file.write_text("[[command]]\nwhen = 1.0\n")
    with pytest.raises(prowl.InputError, match="when"):
        prowl.run_online(hyq, script=file)


def test_a_watcher(hyq):
    times = []

    def watch(moment):
        times.append(moment.t)
        assert moment.q.shape == (hyq.nq,) and moment.f.shape == (4, 3) and moment.end == 5.0
        if moment.t == 0.0:
            moment.command(forward=0.3)
        if len(times) == 21:
            moment.push(np.array([0.0, 0.3 * hyq.mass, 0.0]))
        if moment.t > 2.0:
            assert moment.commanded[0] == pytest.approx(0.3)
            moment.stop()

    run = prowl.run_online(hyq, duration=5.0, watch=watch, record_rate=20.0)
    np.testing.assert_allclose(times, np.arange(len(times)) / 20.0, atol=1e-3)
    assert run.end_time == pytest.approx(times[-1], abs=2e-3) and 2.0 < times[-1] < 2.1
    calm = prowl.run_online(hyq, command=(0.3, 0.0, 0.0), duration=2.0, record_rate=20.0)
    assert np.abs(run.v[20:26, 1]).max() > 2.0 * np.abs(calm.v[20:26, 1]).max(), "the push"
    with pytest.raises(prowl.InputError, match="record_rate"):
        prowl.run_online(hyq, duration=0.1, watch=watch, record_rate=0.0)
