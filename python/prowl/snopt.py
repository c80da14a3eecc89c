"""SNOPT, the solver of Pardo et al. 2016, for a Program: by the SNOPT in Drake's wheel (pip install drake).

    program = prowl.Program(prowl.read_task("hyq/crouch", intervals=6))
    result = prowl.snopt.solve(program)
    program.judge(result.z).certificate

SNOPT is commercial; Drake's wheels contain it with the permission of its authors, for use through Drake.
"""

from __future__ import annotations

import os
import re
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from . import _prowl

DRAKE = "drake==1.51.1"  # the last with wheels for Python 3.11; contains SNOPT 7.4-1.2

# SNOPT's INFO (User's Guide 7.4, section 8.6) -> status of Prowl, message.
_INFO = {
    1: ("converged", "optimality conditions satisfied"),
    2: ("solver_failed", "feasible, but not shown to be optimal"),
    3: ("solver_failed", "the requested accuracy could not be reached"),
    11: ("infeasible", "infeasible linear constraints"),
    12: ("infeasible", "infeasible linear equalities"),
    13: ("infeasible", "nonlinear infeasibilities minimised"),
    14: ("infeasible", "infeasibilities minimised"),
    21: ("solver_failed", "unbounded objective"),
    22: ("solver_failed", "constraint violation limit reached"),
    31: ("iteration_limit", "limit of minor iterations reached"),
    32: ("iteration_limit", "iteration limit reached"),
    33: ("solver_failed", "the superbasics limit is too small"),
    34: ("time_limit", "time limit reached"),
    41: ("solver_failed", "the current point cannot be improved"),
    42: ("solver_failed", "singular basis"),
    43: ("solver_failed", "cannot satisfy the general constraints"),
    44: ("solver_failed", "ill-conditioned null-space basis"),
    51: ("solver_failed", "incorrect objective derivatives"),
    52: ("solver_failed", "incorrect constraint derivatives"),
}

# A block of rows has dense derivatives in all its variables: narrow blocks keep the arrays small.
_WIDEST_BLOCK = 160

# Up to this many variables SNOPT keeps the full quasi-Newton matrix. This halves the iterations
# compared with the last ten updates, its default beyond 75, and with the paper's contact rows only
# this converges. On larger programs the n² numbers cost more than they save (docs/solvers.md).
_MOST_FOR_FULL_MEMORY = 500

# Drake opens "Print file" as this Fortran unit, with little output. The summary, which contains the
# number of iterations, goes to any chosen unit.
_PRINT_UNIT = 10


class _TimeUp(Exception):
    pass


@dataclass(frozen=True)
class Result:
    """Result of SNOPT. To certify it: program.judge(result.z)."""

    z: np.ndarray  #: the solution, or the evaluated point of smallest violation (num_variables)
    status: str  #: "converged", "infeasible", "iteration_limit", "time_limit", "evaluation_failed" or "solver_failed"
    message: str
    info: int  #: SNOPT's INFO; 0 if it did not return
    iterations: int  #: major iterations
    evaluations: int  #: of the program with derivatives
    seconds: float
    summary: str  #: output of SNOPT: one line per major iteration
    multipliers: (
        np.ndarray | None
    )  #: of the constraints, in cost + multipliers . constraints; None unless converged or infeasible


def _violation(program: _prowl.Program, z: np.ndarray, rows: np.ndarray) -> float:
    """Largest violation of rows and bounds, unscaled."""
    parts = (
        program.variable_lower - z,
        z - program.variable_upper,
        program.constraint_lower - rows,
        rows - program.constraint_upper,
    )
    return max(float(part.max(initial=0.0)) for part in parts)


@dataclass
class _Block:
    rows: range
    columns: np.ndarray  # ascending
    places: slice  # in the Jacobian's values, sorted by row
    at: tuple[np.ndarray, np.ndarray] = field(repr=False)  # row and column of these entries in the block


def _blocks(pattern: tuple[np.ndarray, np.ndarray], num_rows: int) -> tuple[np.ndarray, list[_Block]]:
    """The order that sorts entries by row, and blocks of neighbouring rows with at most _WIDEST_BLOCK
    variables."""
    order = np.lexsort((pattern[1], pattern[0]))
    rows, columns = pattern[0][order], pattern[1][order]
    ends = np.searchsorted(rows, np.arange(num_rows + 1))
    blocks: list[_Block] = []
    first, known = 0, np.array([], dtype=columns.dtype)
    for row in range(num_rows + 1):
        union = np.union1d(known, columns[ends[row] : ends[row + 1]]) if row < num_rows else known
        if row > first and (row == num_rows or union.size > _WIDEST_BLOCK):
            places = slice(ends[first], ends[row])
            at = (rows[places] - first, np.searchsorted(known, columns[places]))
            blocks.append(_Block(range(first, row), known, places, at))
            if row == num_rows:
                break
            first, union = row, np.unique(columns[ends[row] : ends[row + 1]])
        known = union
    return order, blocks


class _Watched:
    """The program for Drake's functions: evaluated once per point, when Drake announces it."""

    def __init__(
        self,
        program: _prowl.Program,
        start: np.ndarray,
        tolerance: float,
        max_seconds: float,
        on_evaluation: Callable[[int, float, float], object] | None,
    ) -> None:
        self.program, self.tolerance, self.on_evaluation = program, tolerance, on_evaluation
        self.end = time.perf_counter() + max_seconds
        self.order, self.blocks = _blocks(program.jacobian_pattern, program.num_constraints)
        self.count = 0
        self.z = self.best = start
        self.best_rank = (np.inf, np.inf)
        self.error: BaseException | None = None

    def visit(self, z: np.ndarray) -> None:
        try:
            if time.perf_counter() > self.end:
                raise _TimeUp("time limit reached")
            self.z = z.copy()
            self.cost, self.gradient = self.program.cost(self.z), self.program.cost_gradient(self.z)
            self.rows, self.jacobian = self.program.constraints(self.z), self.program.jacobian(self.z)[self.order]
            self.count += 1
            worst = _violation(self.program, z, self.rows)
            rank = (max(worst, self.tolerance), self.cost if worst <= self.tolerance else 0.0)
            if rank < self.best_rank:
                self.best, self.best_rank = self.z, rank
            if self.on_evaluation is not None:
                self.on_evaluation(self.count, self.cost, worst)
        except BaseException as error:
            self.error = error  # Drake passes on only its message
            raise


def _add(program: Any, z: np.ndarray, watched: _Watched) -> None:
    """Adds cost and constraints to Drake's program, in blocks: Drake uses dense derivatives in all variables
    of a function."""
    from pydrake.autodiffutils import ExtractValue, InitializeAutoDiff

    def at_the_point(x: np.ndarray, columns: np.ndarray) -> bool:
        """True if derivatives are requested. Drake evaluates all functions at the announced point."""
        wants_derivatives = x.dtype == object
        assert np.array_equal(ExtractValue(x).ravel() if wants_derivatives else x, watched.z[columns])
        return wants_derivatives

    def add_cost(columns: np.ndarray, has_value: bool) -> None:
        def cost(x: np.ndarray) -> Any:
            value = watched.cost if has_value else 0.0  # Drake adds up the blocks
            if not at_the_point(x, columns):
                return value
            return InitializeAutoDiff(np.array([value]), watched.gradient[columns][np.newaxis, :])[0, 0]

        program.AddCost(cost, vars=z[columns])

    def add_rows(block: _Block) -> None:
        rows = slice(block.rows.start, block.rows.stop)
        gradient = np.zeros((len(block.rows), block.columns.size))

        def constraint(x: np.ndarray) -> np.ndarray:
            if not at_the_point(x, block.columns):
                return watched.rows[rows]
            gradient[block.at] = watched.jacobian[block.places]
            return InitializeAutoDiff(watched.rows[rows], gradient).ravel()

        lower, upper = watched.program.constraint_lower[rows], watched.program.constraint_upper[rows]
        binding = program.AddConstraint(constraint, lb=lower, ub=upper, vars=z[block.columns])
        binding.evaluator().SetGradientSparsityPattern(list(zip(*(index.tolist() for index in block.at), strict=True)))

    for first in range(0, z.size, _WIDEST_BLOCK):
        add_cost(np.arange(first, min(first + _WIDEST_BLOCK, z.size)), first == 0)
    for block in watched.blocks:
        add_rows(block)


def _options(
    start: np.ndarray, tolerance: float, max_iterations: int, print_file: str, others: Mapping[str, int | float | str]
) -> dict[str, int | float | str]:
    return {
        # SNOPT accepts a row within this times |z|; Prowl's tolerance applies to the row itself.
        "Major feasibility tolerance": tolerance / max(1.0, float(np.linalg.norm(start))),
        "Major optimality tolerance": tolerance,
        "Major iterations limit": max_iterations,
        "Iterations limit": 1_000_000,  # minor iterations; max_iterations limits the major ones
        "Superbasics limit": start.size + 1,  # the default ends programs with more than 500 degrees of freedom
        "Hessian full memory" if start.size <= _MOST_FOR_FULL_MEMORY else "Hessian limited memory": "",
        "Derivative option": 1,  # all derivatives are given
        "Verify level": -1,  # do not check them by differences
        "Print file": print_file,
        "Summary file": _PRINT_UNIT,
    } | dict(others)


def _iterations(summary: str) -> int:
    found = re.search(r"No\. of major iterations\s+(\d+)", summary)
    return int(found[1]) if found else 0


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

    start: program.start if None. tolerance: on optimality, as SNOPT measures it, and on constraint violation.
    max_iterations: major ones. options: of SNOPT by name, such as {"Scale option": 2}; they override those
    set here. on_evaluation: called with number, cost and constraint violation of each evaluation; its
    exceptions end the solve and are raised here.

    Raises InputError if pydrake is not installed. A hard program gives a status. A failed evaluation ends the
    solve: Drake cannot ask SNOPT for a shorter step.
    """
    z = np.array(program.start if start is None else start, dtype=float)
    if z.shape != (program.num_variables,):
        raise _prowl.InputError(f"start: shape {z.shape} is not allowed; need ({program.num_variables},)")
    if not 0.0 < tolerance < 1.0:
        raise _prowl.InputError(f"tolerance: {tolerance} is not allowed; need a number between 0 and 1")
    try:
        from pydrake.solvers import MathematicalProgram, SnoptSolver, SolverOptions
    except ModuleNotFoundError as error:
        if error.name is None or not error.name.startswith("pydrake"):
            raise
        raise _prowl.InputError(f"SNOPT is part of Drake, which is not installed: pip install {DRAKE}") from error

    begin = time.perf_counter()
    watched = _Watched(program, z, tolerance, max_seconds, on_evaluation)
    drake = MathematicalProgram()
    variables = drake.NewContinuousVariables(z.size)
    drake.AddBoundingBoxConstraint(program.variable_lower, program.variable_upper, variables)
    _add(drake, variables, watched)
    # Called with each point before evaluations there.
    drake.AddVisualizationCallback(watched.visit, variables)
    summary = ""

    def outcome(
        status: str, message: str, z: np.ndarray, info: int = 0, multipliers: np.ndarray | None = None
    ) -> Result:
        seconds = time.perf_counter() - begin
        return Result(z, status, message, info, _iterations(summary), watched.count, seconds, summary, multipliers)

    with tempfile.TemporaryDirectory() as folder:
        print_file = os.path.join(folder, "snopt.txt")
        settings = SolverOptions()
        for name, value in _options(z, tolerance, max_iterations, print_file, options or {}).items():
            settings.SetOption(SnoptSolver.id(), name, value)
        try:
            found = SnoptSolver().Solve(drake, z, settings)
        except RuntimeError:
            # Drake's program holds our functions outside the garbage collector: avoid reference
            # cycles through it.
            error, watched.error = watched.error, None
            if isinstance(error, _TimeUp):
                return outcome("time_limit", str(error), watched.best)
            if isinstance(error, ArithmeticError):
                return outcome("evaluation_failed", str(error), watched.best)
            if error is None:
                raise
            try:
                raise error from None
            finally:
                del error
        with open(print_file, encoding="utf-8", errors="replace") as file:
            summary = file.read()
    details = found.get_solver_details()
    status, message = _INFO.get(details.info, ("solver_failed", "stopped"))
    message = f"{message} (SNOPT INFO {details.info})"
    if status not in ("converged", "infeasible"):
        return outcome(status, message, watched.best, details.info)
    solution = found.GetSolution(variables)
    if status == "converged" and not program.judge(solution).constraint_violation <= tolerance:
        status, message = "solver_failed", f"{message}, but a constraint is not within tolerance"
    # SNOPT's multipliers are those of f - pi . rows.
    return outcome(status, message, solution, details.info, -details.Fmul[1:])
