"""Why there is no plan, and what would change that."""

import json
import tomllib

import pytest

import prowl


@pytest.fixture(scope="module")
def too_fast():
    """HyQ's crouch in a fiftieth of the time."""
    crouch = prowl.read_task("hyq/crouch")
    document = tomllib.loads(crouch.text)
    for phase in document["phase"]:
        phase |= {"duration_s": phase["duration_s"] / 50.0, "intervals": 8}
    for goal in document["goal"]:
        goal["time_s"] /= 50.0
    return prowl.parse_task(document, folder=crouch.path.parent)


def test_a_cause_is_named_and_what_would_change_it(too_fast):
    steps = []
    found = prowl.diagnose(too_fast, max_time=60.0, on_step=steps.append)
    assert found.solvable is False
    numbers = json.loads(found.to_json())
    assert numbers["headline"] == found.headline
    assert numbers["reasons"] == found.reasons and numbers["hints"] == found.hints
    assert numbers["cause"] is not None and numbers["changes"], found.summary()
    assert found.headline in found.summary() and found.headline in repr(found)
    assert len(steps) > 2 and all(isinstance(step, str) for step in steps)


def test_of_a_task_with_a_plan_is_that_it_has_one(crouch):
    found = prowl.diagnose(crouch.task)
    assert found.solvable
    assert found.headline == "the task has a plan, and it passes its certificate"


def test_without_time_nothing_is_known(too_fast):
    found = prowl.diagnose(too_fast, max_time=1e-3)
    assert found.solvable is None and json.loads(found.to_json())["solvable"] is None
    assert found.headline.startswith("not known whether the task has a plan")


def test_what_a_callback_raises_ends_it(too_fast):
    steps = []

    def stop(step):
        steps.append(step)
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        prowl.diagnose(too_fast, on_step=stop)
    assert len(steps) == 1


def test_there_is_no_time_below_zero(too_fast):
    with pytest.raises(prowl.InputError, match="max_time"):
        prowl.diagnose(too_fast, max_time=0.0)
