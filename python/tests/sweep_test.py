"""Sweeps, against what the command makes of the same plan."""

import pytest

import prowl


@pytest.fixture(scope="module")
def sweep(crouch) -> prowl.Sweep:
    return prowl.sweep(crouch, 4, progress=False)


def test_the_command_sweeps_the_same(crouch, sweep, tmp_path, command):
    crouch.write(tmp_path / "plan")
    command("sweep", tmp_path / "plan", "--n", "4", "--breakdown", "0")
    assert (tmp_path / "plan/sweep.json").read_text() == sweep.to_json()


def test_what_a_sweep_tells(sweep):
    assert len(sweep) == 4 and [case.seed for case in sweep.cases] == [1, 2, 3, 4]
    assert sweep.successes == sum(case.success for case in sweep.cases)
    assert sweep.success_rate == sweep.successes / 4
    low, high = sweep.interval_95
    assert 0 <= low <= sweep.success_rate <= high <= 1 and high - low > 0.1
    assert f"{sweep.successes} of 4 succeed" in sweep.summary() and f"{sweep.successes} of 4" in repr(sweep)
    assert len({case.mass for case in sweep.cases}) == 4 and all(0.9 <= case.mass <= 1.1 for case in sweep.cases)


def test_it_runs_as_many_simulations_as_it_is_asked_for(crouch, capsys):
    seen = []
    swept = prowl.sweep(crouch, 3, seed=7, progress=True, on_progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (3, 3) and {total for _, total in seen} == {3}
    assert seen == sorted(seen)
    assert [case.seed for case in swept.cases] == [7, 8, 9]
    assert "3/3" in capsys.readouterr().err


def test_it_draws_only_what_is_asked_for(crouch):
    swept = prowl.sweep(crouch, 2, only=["friction"])
    assert [case.mass for case in swept.cases] == [1.0, 1.0]
    assert all(case.friction != 1.0 for case in swept.cases)


def test_it_takes_a_folder(crouch, sweep, tmp_path):
    crouch.write(tmp_path / "plan")
    assert prowl.sweep(tmp_path / "plan", 1).cases[0].success == sweep.cases[0].success


def test_what_a_callback_raises_ends_it(crouch):
    def stop(done: int, total: int) -> None:
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        prowl.sweep(crouch, 100_000, on_progress=stop)


def test_ctrl_c_keeps_the_simulations_that_have_finished(crouch, sweep):
    def press(done: int, total: int) -> None:
        if done >= 3:
            raise KeyboardInterrupt

    with pytest.raises(prowl.Interrupted, match="in .sweep$") as stopped:
        prowl.sweep(crouch, 1000, on_progress=press, progress=False)
    kept = stopped.value.sweep
    assert 3 <= len(kept) < 1000 and [case.seed for case in kept.cases] == list(range(1, len(kept) + 1))
    assert [case.mass for case in kept.cases[:3]] == [case.mass for case in sweep.cases[:3]]
    assert f"interrupted: {len(kept)} of 1000 simulations" in kept.summary()
    assert stopped.value.plan is None


def test_arguments_that_make_no_sense(crouch):
    for argument in ({"n": 0}, {"mass_spread": 1.0}, {"push_impulse": -1.0}, {"breakdown": -1}, {"only": ["pushes"]}):
        with pytest.raises(prowl.InputError, match=f"^{next(iter(argument))}: "):
            prowl.sweep(crouch, **argument)
    with pytest.raises(prowl.InputError, match="no gains"):
        prowl.sweep(prowl.solve("hyq/hold", gains=False), 1)
