"""Terms of one's own: from CasADi or functions with derivatives, in plans and folders, and what is said of mistakes."""

import gc
import subprocess
import sys
import tomllib

import casadi
import numpy as np
import pytest

import prowl

HEIGHT = 0.222  # of the knee at 0.6 s [m]; the crouch is 6 mm lower there
HIGH = """
def high(y):
    return [y[2]]
"""


def crouch(own, **use) -> dict:
    """HyQ's crouch, with a limit on the height of a knee that it does not keep by itself."""
    task = prowl.read_task("hyq/crouch")
    document = tomllib.loads(task.text) | {"robot": "hyq"}
    document["term"] = [{"name": "knee high", "own": own, "value": [[HEIGHT, "free"]], "time_s": [0.4, 0.6]} | use]
    return document


def of_casadi(expression=lambda y: y[2], **more) -> prowl.Term:
    y = casadi.SX.sym("y", 3)
    function = casadi.Function("high", [y], [expression(y)])
    return prowl.own_term(function, **{"reads": [("position", "lf_lowerleg")], "rows": ["z"], "unit": "m"} | more)


def of_functions(value=lambda y: [y[2]], jacobian=lambda y: [[0, 0, 1]], hessian=lambda y, m: np.zeros((3, 3))):
    return prowl.own_term(
        value,
        jacobian=jacobian,
        hessian=hessian,
        entries=3,
        reads=[("position", "lf_lowerleg")],
        rows=["z"],
        unit="m",
    )


def knee_height(plan: prowl.Plan) -> float:
    link = [link.name for link in plan.robot.links].index("lf_lowerleg")
    return float(plan.robot.link_placements(plan.at([0.6]).q)[0, link, 2])


@pytest.fixture(scope="module")
def held() -> prowl.Plan:
    return prowl.solve(crouch(of_casadi()), gains=False)


def test_a_limit_from_casadi_is_kept(held):
    free = prowl.solve("hyq/crouch", gains=False)
    assert held.good
    check = next(check for check in held.certificate.checks if check.name == "term 'knee high'")
    assert (check.unit, check.where, check.passed) == ("m", "z", True)
    assert knee_height(free) < HEIGHT - 0.004
    assert knee_height(held) > HEIGHT - 1e-6


def test_functions_with_derivatives_give_the_same_plan(held):
    same = prowl.solve(crouch(of_functions()), gains=False)
    np.testing.assert_allclose(same.q, held.q, atol=1e-9)


def test_several_threads_call_it(held):
    np.testing.assert_array_equal(prowl.solve(crouch(of_casadi()), gains=False, threads=2).q, held.q)


def test_a_cost_pulls_to_its_values():
    own = of_casadi(lambda y: casadi.vertcat(y[2], y[0] * y[2]), rows=["z", "mixed"])
    plan = prowl.solve(crouch(own, value=[HEIGHT + 0.1, "free"], weight=1e3), gains=False)
    assert plan.good and plan.cost_terms["term.knee high"] > 0
    assert not any(check.name == "term 'knee high'" for check in plan.certificate.checks)


def test_a_folder_needs_the_term_again(held, tmp_path):
    held.write(tmp_path / "plan")
    with pytest.raises(prowl.InputError, match="no term 'knee high' is known"):
        prowl.read_plan(tmp_path / "plan")
    again = prowl.read_plan(tmp_path / "plan", own_terms={"knee high": of_casadi()})
    np.testing.assert_allclose(again.q, held.q, atol=1e-12)
    assert list(again.task.own_terms) == ["knee high"]


def test_a_wrong_derivative_is_named():
    with pytest.raises(
        prowl.InputError, match="derivative of 'z' with respect to the position of 'lf_lowerleg', x is 2"
    ):
        prowl.solve(crouch(of_functions(jacobian=lambda y: [[2, 0, 1]])))
    with pytest.raises(prowl.InputError, match="second derivative of all rows"):
        prowl.solve(crouch(of_functions(hessian=lambda y, m: np.eye(3))))


def test_wrong_shapes_say_what_is_needed():
    with pytest.raises(prowl.InputError, match=r"jacobian: shape \(3,\) is not allowed; need \(1, 3\)"):
        prowl.solve(crouch(of_functions(jacobian=lambda y: [0, 0, 1])))
    with pytest.raises(prowl.InputError, match="value: 2 entries are not allowed; need 1: z"):
        prowl.solve(crouch(of_casadi(), value=[0, 1]))
    with pytest.raises(prowl.InputError, match="the quantities have 9 entries, and the function 3"):
        prowl.solve(crouch(of_casadi(reads=[("orientation", "trunk")])))
    with pytest.raises(prowl.InputError, match="rows: 2 names are not allowed; need 1"):
        of_casadi(rows=["y", "z"])
    with pytest.raises(prowl.InputError, match="need a casadi.Function, or functions with jacobian"):
        prowl.own_term(lambda y: y, reads=["center_of_mass"], unit="m")


def test_unknown_names_are_answered_with_the_nearest():
    with pytest.raises(prowl.InputError, match="did you mean 'position'"):
        of_casadi(reads=[("positon", "lf_lowerleg")])
    with pytest.raises(prowl.InputError, match="did you mean 'lf_lowerleg'"):
        prowl.solve(crouch(of_casadi(reads=[("position", "lf_lowerlg")])))


def test_an_exception_ends_the_solve():
    calls = []

    def fails_later(y):
        calls.append(None)
        if len(calls) > 300:
            raise KeyError("mine")
        return [y[2]]

    with pytest.raises(KeyError, match="mine"):
        prowl.solve(crouch(of_functions(value=fails_later)))


def test_what_is_not_finite_is_named():
    with pytest.raises(
        prowl.NumericalError, match=r"phase 1', node \d+, t = 0\.\d+ s: term 'knee high': its value is not finite"
    ):
        prowl.solve(
            crouch(of_casadi(lambda y: casadi.sqrt(y[2] - HEIGHT)), value=[[0.0, "free"]], time_s=[0.4, 1.0]),
            gains=False,
        )


def test_a_script_leaves_nothing_behind():
    """The interpreter and a function refer to each other through the term."""
    script = (
        HIGH
        + """
import prowl, numpy as np
term = prowl.own_term(high, jacobian=lambda y: [[0, 0, 1]], hessian=lambda y, m: np.zeros((3, 3)), entries=3,
                      reads=["center_of_mass"], rows=["z"], unit="m")
"""
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stderr == ""


def test_terms_die_with_their_tasks():
    import weakref

    class Owner:
        def __call__(self, y):
            return [y[2]]

    owner = Owner()
    alive = weakref.ref(owner)
    task = prowl.parse_task(crouch(of_functions(value=owner)))
    del owner
    assert alive() is not None
    del task
    gc.collect()
    assert alive() is None
