"""SNOPT, the solver of Pardo et al. 2016, for a Program: by the SNOPT in Drake's wheel (pip install drake).

    program = prowl.Program(prowl.read_task("hyq/crouch", intervals=6))
    result = prowl.snopt.solve(program)
    program.judge(result.z).certificate

SNOPT is commercial; Drake's wheels have it with the permission of its authors, for use through Drake.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from . import _drake_snopt, _prowl


@dataclass(frozen=True)
class Result:
    """Where SNOPT stopped, and why. Whether that is any good: program.judge(result.z)."""

    z: np.ndarray  #: the solution, or the point of least violation that was seen (num_variables)
    status: str  #: "converged", "infeasible", "iteration_limit", "time_limit", "evaluation_failed" or "solver_failed"
    message: str
    info: int  #: SNOPT's own code; 0 if it did not return
    iterations: int  #: major ones
    evaluations: int  #: of the program with its derivatives
    seconds: float
    summary: str  #: what SNOPT prints: one line a major iteration
    multipliers: (
        np.ndarray | None
    )  #: of the constraints, in cost + multipliers . constraints; None unless SNOPT finished


def solve(
    program: _prowl.Program,
    *,
    start: np.ndarray | None = None,
    tolerance: float = 1e-6,
    max_iterations: int = 1000,
    max_seconds: float = 300.0,
    options: Mapping[str, int | float | str] | None = None,
    on_evaluation: Callable[[int, float, float], object] | None = None,
) -> Result:
    """Solves a program with exact, sparse first derivatives.

    start: program.start if None. tolerance: on optimality, as SNOPT measures it, and on constraint violation. max_iterations:
    major ones. options: SNOPT's own by name, such as {"Scale option": 2}, before those that this function sets.
    on_evaluation: called with number, cost and constraint violation of each evaluation; what it raises ends the solve and is
    raised here.

    Raises InputError if pydrake is not installed. A program that is too hard is a status. An evaluation that fails ends the
    solve: Drake has no way to tell SNOPT to take a shorter step.
    """
    z = np.array(program.start if start is None else start, dtype=float)
    if z.shape != (program.num_variables,):
        raise _prowl.InputError(f"start: shape {z.shape} is not allowed; need ({program.num_variables},)")
    if not 0.0 < tolerance < 1.0:
        raise _prowl.InputError(f"tolerance: {tolerance} is not allowed; need a number between 0 and 1")

    def evaluate(z: np.ndarray) -> _drake_snopt.Evaluation:
        return _drake_snopt.Evaluation(
            program.cost(z), program.cost_gradient(z), program.constraints(z), program.jacobian(z)
        )

    problem = _drake_snopt.Program(
        z,
        program.variable_lower,
        program.variable_upper,
        program.constraint_lower,
        program.constraint_upper,
        program.jacobian_pattern,
        evaluate,
    )
    try:
        found = _drake_snopt.minimise(
            problem,
            tolerance=tolerance,
            max_iterations=max_iterations,
            max_seconds=max_seconds,
            options=options,
            on_evaluation=on_evaluation,
        )
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("pydrake"):
            raise
        raise _prowl.InputError(
            f"SNOPT comes with Drake, which is not installed: pip install {_drake_snopt.DRAKE}"
        ) from error
    if found.status == "converged" and not program.judge(found.z).constraint_violation <= tolerance:
        found.status, found.message = "solver_failed", f"{found.message}, but a constraint is not within tolerance"
    return Result(
        found.z,
        found.status,
        found.message,
        found.info,
        found.iterations,
        found.evaluations,
        found.seconds,
        found.summary,
        found.multipliers,
    )
