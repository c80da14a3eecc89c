"""What Python is told when something is wrong, and how it stops what runs."""

import math
import os
import signal
import threading
import time

import numpy as np
import pytest

import prowl


def test_the_hierarchy_is_that_of_the_library():
    for kind, builtin in (
        (prowl.InputError, ValueError),
        (prowl.FileError, OSError),
        (prowl.NumericalError, ArithmeticError),
    ):
        assert issubclass(kind, prowl.Error) and issubclass(kind, builtin)
    assert issubclass(prowl.Error, RuntimeError) and issubclass(prowl.Interrupted, KeyboardInterrupt)


def test_wrong_input_names_file_line_and_remedy(crouch, tmp_path):
    with pytest.raises(prowl.InputError, match=r"task\.toml:1:.*did you mean"):
        prowl.parse_task('robott = "x"', folder=tmp_path)
    for document in ({"name": None}, {1: "x"}, {"goal": [object()]}):
        with pytest.raises(prowl.InputError, match="^document: "):
            prowl.parse_task(document, folder=tmp_path)
    with pytest.raises(prowl.InputError, match="no such file"):
        prowl.read_task(tmp_path / "none.toml")
    with pytest.raises(prowl.InputError, match="riccati, fatrop, ipopt"):
        prowl.solve(crouch.task, solver="snopt")
    with pytest.raises(prowl.InputError, match="Fatrop"):
        prowl.solve(crouch.task, solver="fatrop", threads=2)
    (tmp_path / "tracker.bin").write_bytes(b"no tracker")
    with pytest.raises(prowl.InputError):
        prowl.Tracker.read(tmp_path / "tracker.bin")


def test_files_that_cannot_be_written(crouch, tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(prowl.FileError):
        crouch.write(tmp_path / "file")


def test_numbers_that_are_none(hyq):
    dynamics = prowl.Dynamics(hyq)
    with pytest.raises(prowl.NumericalError):
        dynamics.forward(hyq.nominal_configuration, np.full(hyq.nv, np.nan), np.zeros(hyq.nu))


def test_steps_and_pushes_that_make_no_sense(crouch):
    with pytest.raises(prowl.InputError, match="too fine"):
        crouch.sample(1e-9)
    for push in [(99.0, (0, 0, 1)), (-1.0, (0, 0, 1)), (math.nan, (0, 0, 1)), (0.5, (math.nan, 0, 0))]:
        with pytest.raises(prowl.InputError, match="push"):
            prowl.simulate(crouch, pushes=[push])


def test_arrays_of_no_and_of_too_many_dimensions(hyq):
    dynamics = prowl.Dynamics(hyq)
    for array in (np.array(1.0), np.zeros((2, 2, hyq.nq))):
        with pytest.raises(prowl.InputError, match="shape"):
            dynamics.mass_matrix(array)


def test_shapes_that_do_not_fit(hyq):
    dynamics, q = prowl.Dynamics(hyq), hyq.nominal_configuration
    with pytest.raises(prowl.InputError, match=r"v: shape \(17\) is not allowed; need \(18\) or \(N, 18\)"):
        dynamics.forward(q, np.zeros(17), np.zeros(12))
    with pytest.raises(prowl.InputError, match="need as many as q"):
        dynamics.forward(np.tile(q, (3, 1)), np.zeros((2, 18)), np.zeros((3, 12)))
    with pytest.raises(prowl.InputError, match="quaternion of row 0 has length 2"):
        dynamics.mass_matrix(np.concatenate([q[:3], 2 * q[3:7], q[7:]]))
    with pytest.raises(prowl.InputError, match="nearest|did you mean|lf_foot"):
        prowl.Dynamics(hyq, contacts=["lf_fot"])


def test_what_a_callback_raises_ends_the_solve(crouch):
    calls = []

    def stop(progress):
        calls.append(progress.iteration)
        if len(calls) == 2:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        prowl.solve(crouch.task, on_iteration=stop)
    assert len(calls) == 2, "no call after the one that raised"


def long_task() -> prowl.Task:
    """One that takes seconds."""
    return prowl.read_task("hyq/walk", intervals=1232, tolerance=1e-10)


def press_ctrl_c(after: float) -> list[float]:
    """Sends SIGINT after so many seconds, from another thread: which runs only if the GIL is free. Returns when it did."""
    times: list[float] = []

    def press():
        times.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    threading.Timer(after, press).start()
    return times


def test_ctrl_c_stops_a_solve_and_keeps_its_best_motion():
    task = long_task()
    press_ctrl_c(0.3)
    with pytest.raises(prowl.Interrupted) as stopped:
        prowl.solve(task)
    plan = stopped.value.plan
    assert plan.status == "interrupted" and not plan.good and plan.tracker is None
    assert stopped.value.sweep is None
    assert np.isfinite(plan.q).all() and len(plan) > 10


def test_a_plan_that_was_stopped_goes_on_to_the_mesh_that_was_asked_for():
    def stop(progress: prowl.Progress) -> None:
        if progress.iteration == 2:
            raise KeyboardInterrupt

    with pytest.raises(prowl.Interrupted) as stopped:
        prowl.solve(prowl.read_task("hyq/crouch", intervals=200), on_iteration=stop)
    plan = stopped.value.plan
    assert len(plan) < 100, "it was on a coarse mesh"
    done = prowl.solve(plan.task, start_from=plan, progress=False)
    assert done.status == "converged" and len(done) == 201


def test_ctrl_c_stops_a_simulation(crouch):
    started = time.monotonic()
    prowl.simulate(crouch, control_rate=2000.0)
    whole = time.monotonic() - started
    pressed = press_ctrl_c(0.2 * whole)
    with pytest.raises(KeyboardInterrupt):
        prowl.simulate(crouch, control_rate=2000.0)
    assert time.monotonic() - pressed[0] < 0.5 * whole, "it went on"


def test_other_threads_run_meanwhile(crouch):
    counted, done = [0], threading.Event()

    def count():
        while not done.is_set():
            counted[0] += 1
            time.sleep(1e-3)

    thread = threading.Thread(target=count)
    thread.start()
    prowl.solve(crouch.task)
    done.set()
    thread.join()
    assert counted[0] > 10, "of some hundred"
