"""SNOPT, the solver of the paper, on programs of Prowl: Drake's wheel has it."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import prowl
import prowl.snopt


def test_without_drake_the_error_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pydrake.solvers", None)  # as if it could not be found
    with pytest.raises(prowl.InputError, match=r"pip install drake==[\d.]+$") as caught:
        prowl.snopt.solve(prowl.Program(prowl.read_task("hyq/stand", intervals=5)))
    assert caught.value.__cause__ is not None


def test_prowl_itself_does_not_import_drake():
    subprocess.run(
        [sys.executable, "-c", "import sys, prowl, prowl.snopt; sys.exit('pydrake' in sys.modules)"], check=True
    )


def test_what_makes_no_sense_is_refused():
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5))
    with pytest.raises(prowl.InputError, match=r"start: shape \(3,\) is not allowed"):
        prowl.snopt.solve(program, start=np.zeros(3))
    with pytest.raises(prowl.InputError, match="tolerance: 0"):
        prowl.snopt.solve(program, tolerance=0.0)


@pytest.fixture(scope="module")
def drake() -> None:
    pytest.importorskip("pydrake.solvers", reason="PROWL_WITH_SNOPT=1 scripts/setup")


@pytest.fixture(scope="module", params=[("stand", 5), ("crouch", 6)], ids=lambda param: param[0])
def task(request, drake) -> prowl.Task:
    name, intervals = request.param
    return prowl.read_task(f"hyq/{name}", intervals=intervals)


@pytest.mark.parametrize("guess", ["smooth", "straight"])
def test_it_finds_what_ipopt_finds(task, guess):
    program = prowl.Program(task, guess=guess)
    result = prowl.snopt.solve(program)
    assert (result.status, result.info) == ("converged", 1), result.message
    judged = program.judge(result.z)
    assert judged.constraint_violation < 1e-6
    # Two codes, two measures of optimality: the costs agree to what both leave over, no further.
    plan = prowl.solve(task, solver="ipopt", coarse_first=False, gains=False, progress=False)
    assert plan.status == "converged"
    np.testing.assert_allclose(judged.cost, plan.cost, rtol=1e-4)
    # An optimum, whoever says so: multipliers of the right sign that leave no gradient.
    assert program.dual_violation(result.z, result.multipliers) < 1e-3
    assert program.dual_violation(result.z, -result.multipliers) > 1e-2
    # All it tells is of one run.
    assert 10 < result.iterations < result.evaluations and result.seconds > 0.0
    assert "SNOPTA EXIT   0 -- finished successfully" in result.summary
    given = program.jacobian_pattern[0].size + program.num_variables
    assert f"{given}   out of   {given}   first  derivatives" in result.summary, "exact and sparse"


def test_a_problem_without_a_solution_is_a_status(drake):
    task = prowl.read_task("hyq/stand")
    text = task.text.replace("base_displacement_m = [0.05, 0.03, -0.05]", "base_displacement_m = [0.0, 0.0, 0.6]")
    assert text != task.text
    program = prowl.Program(prowl.parse_task(text, folder=task.path.parent, intervals=1))
    result = prowl.snopt.solve(program)
    assert result.status == "infeasible" and 11 <= result.info <= 16
    assert program.judge(result.z).constraint_violation > 0.1


def test_limits_stop_it_with_its_best_point(drake):
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5), guess="straight")
    short = prowl.snopt.solve(program, max_iterations=3)
    assert (short.status, short.iterations) == ("iteration_limit", 3)
    assert program.judge(short.z).constraint_violation <= program.judge(program.start).constraint_violation
    late = prowl.snopt.solve(program, max_seconds=0.05)
    assert late.status == "time_limit" and late.info == 0


def test_what_an_evaluation_raises_ends_the_solve(drake):
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5))

    class Enough(Exception):
        pass

    seen = []

    def watch(count: int, cost: float, violation: float) -> None:
        seen.append((count, cost, violation))
        if count == 5:
            raise Enough

    with pytest.raises(Enough):
        prowl.snopt.solve(program, on_evaluation=watch)
    assert [count for count, _, _ in seen] == [1, 2, 3, 4, 5]
    np.testing.assert_allclose(seen[0][1], program.cost(program.start))
    with pytest.raises(KeyboardInterrupt):
        prowl.snopt.solve(program, on_evaluation=lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))


class Failing:
    """A program whose third evaluation fails."""

    def __init__(self, program: prowl.Program) -> None:
        self.program, self.calls = program, 0

    def __getattr__(self, name: str):
        return getattr(self.program, name)

    def constraints(self, z: np.ndarray) -> np.ndarray:
        self.calls += 1
        if self.calls == 3:
            raise prowl.NumericalError("constraint is nan at constraint 1")
        return self.program.constraints(z)


def test_an_evaluation_that_fails_is_a_status(drake):
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5), guess="straight")
    result = prowl.snopt.solve(Failing(program))
    assert (result.status, result.evaluations) == ("evaluation_failed", 2)
    assert result.message == "constraint is nan at constraint 1"
    assert program.judge(result.z).constraint_violation <= program.judge(program.start).constraint_violation


def test_options_of_snopt_are_passed_on(drake):
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5))
    result = prowl.snopt.solve(program, options={"Major iterations limit": 4})
    assert (result.status, result.info, result.iterations) == ("iteration_limit", 32, 4)


PAPER = {"dynamics": "forward", "transcription": "trapezoid", "orientation": "euler", "guess": "straight"}


def heights_of_feet(program: prowl.Program, z: np.ndarray) -> np.ndarray:
    """At the nodes, above where they are at the start (nodes, feet)."""
    heights = prowl.Dynamics(program.task.robot).contact_positions(program.judge(z).motion.q)[..., 2]
    return heights - heights[0]


def solve_from_nearby_starts(program: prowl.Program) -> prowl.snopt.Result:
    """The first run that converges. In the paper's formulation rounding decides whether SNOPT reaches its accuracy: from
    starts that differ by 1e-13, a third to two thirds of the runs end with INFO 3 at a point that is feasible to 1e-11."""
    rng = np.random.default_rng(1)
    for size in [0.0] + 9 * [1e-13]:
        result = prowl.snopt.solve(program, start=program.start + size * rng.standard_normal(program.num_variables))
        assert (result.status, result.info) in (("converged", 1), ("solver_failed", 3)), result.message
        if result.status == "converged":
            break
    return result


def test_it_solves_the_papers_formulation_with_feet_within_5_mm(task):
    """Pardo et al. 2016: forward dynamics, trapezoid, Euler angles, distance of the feet from the ground; six nodes, 2 s."""
    program = prowl.Program(task, contact="distance-5mm", **PAPER)
    result = solve_from_nearby_starts(program)
    assert result.status == "converged", result.message
    assert program.dual_violation(result.z, result.multipliers) < 1e-4
    judged = program.judge(result.z)
    assert judged.constraint_violation < 1e-6
    default = prowl.Program(task)
    optimum = prowl.snopt.solve(default)
    np.testing.assert_allclose(judged.cost, default.judge(optimum.z).cost, rtol=5e-3)
    off = np.abs(heights_of_feet(program, result.z)).max()
    assert 1e-4 < off < 5e-3 + 1e-6, "more than a rounding error, so that to forbid it is to ask for something else"


def test_it_solves_hold_in_the_papers_formulation(drake):
    """The straight guess is the optimum of hold, which costs nothing: SNOPT begins beside it."""
    program = prowl.Program(prowl.read_task("hyq/hold", intervals=5), contact="distance-5mm", **PAPER)
    assert program.cost(program.start) < 1e-9
    beside = program.start + 1e-2 * np.random.default_rng(1).standard_normal(program.num_variables)
    assert program.cost(beside) > 1e-2 and program.judge(beside).constraint_violation > 0.1
    result = prowl.snopt.solve(program, start=beside)
    assert (result.status, result.info) == ("converged", 1), result.message
    assert result.iterations > 10
    assert program.dual_violation(result.z, result.multipliers) < 1e-4
    judged = program.judge(result.z)
    assert judged.constraint_violation < 1e-6 and judged.cost < 1e-6
    assert np.abs(heights_of_feet(program, result.z)).max() < 5e-3 + 1e-6


def test_exact_distances_and_velocities_are_more_than_there_is_to_choose(task):
    program = prowl.Program(task, contact="distance-velocity", **PAPER)
    result = prowl.snopt.solve(program)
    assert result.status in ("infeasible", "solver_failed"), result.message
    assert result.info in (13, 41), "nonlinear infeasibilities minimised, or no better point to be found"
    assert program.judge(result.z).constraint_violation > 1e-4


def test_exact_distances_alone_are_dear(drake):
    program = prowl.Program(prowl.read_task("hyq/stand", intervals=5), contact="distance", **PAPER)
    result = prowl.snopt.solve(program)
    judged = program.judge(result.z)
    assert judged.constraint_violation < 1e-6
    assert np.abs(heights_of_feet(program, result.z)).max() < 1e-6
    assert judged.cost > 2 * 0.056, "at three times the cost that 5 mm make possible"


def test_the_version_to_install_is_the_one_that_is_tested():
    root = Path(__file__).resolve().parents[2]
    pinned = (root / "python/snopt-requirements.txt").read_text().split()
    assert prowl.snopt.DRAKE in pinned
    for name in ("docs/solvers.md", "docs/python.md"):
        assert prowl.snopt.DRAKE in (root / name).read_text(), name
