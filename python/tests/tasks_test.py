"""What solve() takes for a task: names, paths, dicts with robots and arrays; and what it says of a mistake in them."""

import tomllib

import numpy as np
import pytest

import prowl


@pytest.fixture(scope="module")
def document() -> dict:
    """HyQ's crouch as a dict, on a coarse mesh."""
    document = tomllib.loads(prowl.read_task("hyq/crouch").text)
    for phase in document["phase"]:
        phase["intervals"] = 20
    return document


def test_solve_takes_names_paths_tasks_and_dicts(document):
    task = prowl.read_task("hyq/stand")
    expected = prowl.solve(task, gains=False)
    for same in ("hyq/stand", task.path, str(task.path)):
        plan = prowl.solve(same, gains=False)
        np.testing.assert_array_equal(plan.q, expected.q)
        assert plan.task.path == task.path
    plan = prowl.solve({**document, "robot": "hyq"}, gains=False)
    np.testing.assert_array_equal(plan.q, prowl.solve(prowl.read_task("hyq/crouch", intervals=20), gains=False).q)


@pytest.mark.parametrize("wrong", [None, 3, ["hyq/crouch"], b"hyq/crouch"])
def test_what_is_no_task_is_told_what_one_is(wrong):
    with pytest.raises(prowl.InputError, match="^task: .* is not allowed; need a Task, the name of a shipped one"):
        prowl.solve(wrong)


def test_names_that_do_not_exist_get_the_nearest_one(document):
    with pytest.raises(prowl.InputError, match="^hyq/crouh: .*did you mean 'hyq/crouch'\\?"):
        prowl.solve("hyq/crouh")
    with pytest.raises(prowl.InputError, match="did you mean 'hyq/trot'\\?"):
        prowl.read_task("hyq/trott")
    with pytest.raises(prowl.InputError, match="did you mean 'talos'\\?"):
        prowl.read_robot("talo")
    with pytest.raises(prowl.InputError, match="^robot: hyqq: .*did you mean 'hyq'\\?"):
        prowl.parse_task({**document, "robot": "hyqq"})


def test_a_name_is_the_shipped_one_also_beside_a_folder_of_that_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hyq/crouch").mkdir(parents=True)
    assert prowl.read_task("hyq/crouch").name == "crouch"
    assert prowl.read_robot("hyq").name == "HyQ"


def test_a_dict_has_a_robot_object(document, hyq):
    expected = prowl.parse_task({**document, "robot": "hyq"})
    for robot in (hyq, expected.robot, prowl.solve("hyq/hold", gains=False).robot):
        task = prowl.parse_task({**document, "robot": robot})
        assert task.robot.joint_names == hyq.joint_names and task.robot_text == hyq.text
        np.testing.assert_array_equal(task.start, expected.start)


def test_a_robot_that_is_in_no_file_goes_into_a_plan_and_its_folder(document, hyq, tmp_path):
    changed = tomllib.loads(hyq.text)
    changed["name"] = "my robot"
    robot = prowl.parse_robot(changed, folder=hyq.path.parent)
    plan = prowl.solve({**document, "robot": robot}, gains=False)
    assert plan.robot.name == "my robot"
    plan.write(tmp_path / "plan")
    again = prowl.read_plan(tmp_path / "plan")
    assert again.robot.name == "my robot" and again.robot.text == robot.text


def test_a_robot_knows_its_file(hyq):
    assert hyq.path.name == "hyq.toml" and hyq.text == hyq.path.read_text()
    parsed = prowl.parse_robot(hyq.text, folder=hyq.path.parent)
    assert parsed.text == hyq.text and parsed.path == hyq.path.parent / "robot.toml"


def test_arrays_and_numbers_of_numpy_are_as_good_as_lists(document):
    plain = prowl.parse_task({**document, "robot": "hyq"})
    arrays = {**document, "robot": "hyq", "goal": [dict(goal) for goal in document["goal"]]}
    for goal in arrays["goal"]:
        goal["time_s"] = np.float64(goal["time_s"])
        goal["base_displacement_m"] = np.array(goal["base_displacement_m"])
    arrays["phase"] = [{**phase, "intervals": np.int64(phase["intervals"])} for phase in document["phase"]]
    task = prowl.parse_task(arrays)
    assert tomllib.loads(task.text) == tomllib.loads(plain.text)
    with pytest.raises(prowl.InputError, match="base_displacement_m"):
        prowl.parse_task({**arrays, "goal": [{**arrays["goal"][0], "base_displacement_m": np.zeros(2)}]})


def test_diagnose_takes_them_too():
    assert prowl.diagnose("hyq/hold").solvable
    with pytest.raises(prowl.InputError, match="did you mean 'hyq/hold'"):
        prowl.diagnose("hyq/hol")
