"""SNOPT by Drake's wheel, for any program with exact first derivatives.

Needs numpy and pydrake, and nothing of Prowl: `prowl compare` runs this file in a process of its own (cli/snopt), and
prowl.snopt imports it.
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

DRAKE = "drake==1.51.1"  # the last with wheels for Python 3.11; SNOPT 7.4-1.2 is in it

# What SNOPT's INFO means (User's Guide 7.4, section 8.6), as a status of Prowl's and in words.
_INFO = {
    1: ("converged", "optimality conditions satisfied"),
    2: ("solver_failed", "feasible, but not shown to be optimal"),
    3: ("solver_failed", "the accuracy that was asked for could not be reached"),
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

# A block of rows is evaluated with derivatives in all variables of the block: narrow ones keep those arrays small.
_WIDEST_BLOCK = 160

# Up to so many variables SNOPT keeps the whole quasi-Newton matrix. It takes half the iterations or fewer than with the last ten updates,
# its default beyond 75, and where the paper's contact rows slow it down it is what makes it end; on larger programs the n² numbers
# take more time than that saves (docs/solvers.md).
_MOST_FOR_FULL_MEMORY = 500

# Drake opens "Print file" as this Fortran unit and lets SNOPT write no more than its name there; the summary, which has the
# number of iterations, goes to any unit that one names.
_PRINT_UNIT = 10


class Stop(Exception):
    """Raised by an evaluation: ends the solve with this status."""

    def __init__(self, status: str, message: str) -> None:
        super().__init__(message)
        self.status = status


@dataclass
class Evaluation:
    """A program at one point z."""

    cost: float
    gradient: np.ndarray  # (num_variables)
    rows: np.ndarray  # constraints (num_constraints)
    jacobian: np.ndarray  # values at the places of the pattern


@dataclass
class Program:
    """Minimise the cost, lower <= z <= upper, row_lower <= rows <= row_upper; evaluate(z) gives values and derivatives."""

    start: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    row_lower: np.ndarray
    row_upper: np.ndarray
    pattern: tuple[np.ndarray, np.ndarray]  # rows and columns of the Jacobian's places
    evaluate: Callable[[np.ndarray], Evaluation]


@dataclass
class Outcome:
    status: str  # of prowl's, such as "converged" or "infeasible"
    message: str
    z: np.ndarray  # the solution, or the iterate of least violation
    info: int = 0  # SNOPT's own code; 0 if it did not return
    iterations: int = 0  # major ones
    evaluations: int = 0
    seconds: float = 0.0
    summary: str = ""  # what SNOPT prints
    multipliers: np.ndarray | None = None  # of the rows, in f + multipliers . rows; None unless SNOPT finished


def violation(program: Program, z: np.ndarray, rows: np.ndarray) -> float:
    """Largest of rows and bounds, unscaled."""
    parts = (program.lower - z, z - program.upper, program.row_lower - rows, rows - program.row_upper)
    return max(float(part.max(initial=0.0)) for part in parts)


@dataclass
class _Block:
    rows: range
    columns: np.ndarray  # in order
    places: slice  # in the Jacobian's values, once they are sorted by row
    at: tuple[np.ndarray, np.ndarray] = field(repr=False)  # of those places in the block


def _blocks(pattern: tuple[np.ndarray, np.ndarray], num_rows: int) -> tuple[np.ndarray, list[_Block]]:
    """The order that sorts the places by row, and neighbouring rows together as long as they share most of their variables."""
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
    """The program as Drake's functions see it: evaluated once a point, when Drake tells of the whole of it."""

    def __init__(
        self,
        program: Program,
        tolerance: float,
        max_seconds: float,
        on_evaluation: Callable[[int, float, float], None] | None,
    ) -> None:
        self.program, self.tolerance, self.on_evaluation = program, tolerance, on_evaluation
        self.end = time.perf_counter() + max_seconds
        self.order, self.blocks = _blocks(program.pattern, program.row_lower.size)
        self.count = 0
        self.z = self.best = program.start
        self.best_rank = (np.inf, np.inf)
        self.error: BaseException | None = None

    def visit(self, z: np.ndarray) -> None:
        try:
            if time.perf_counter() > self.end:
                raise Stop("time_limit", "time limit reached")
            self.z = z.copy()
            now = self.program.evaluate(self.z)
            self.cost, self.gradient, self.rows, self.jacobian = (
                now.cost,
                now.gradient,
                now.rows,
                now.jacobian[self.order],
            )
            self.count += 1
            worst = violation(self.program, z, now.rows)
            rank = (max(worst, self.tolerance), now.cost if worst <= self.tolerance else 0.0)
            if rank < self.best_rank:
                self.best, self.best_rank = self.z, rank
            if self.on_evaluation is not None:
                self.on_evaluation(self.count, now.cost, worst)
        except BaseException as error:
            self.error = error  # Drake passes on no more than its words
            raise


def _add(program: Any, z: np.ndarray, watched: _Watched) -> None:
    """Cost and constraints to Drake's program, in blocks: Drake gives each function derivatives in all of its variables."""
    from pydrake.autodiffutils import ExtractValue, InitializeAutoDiff

    def at_the_point(x: np.ndarray, columns: np.ndarray) -> bool:
        """Whether derivatives are asked for. Drake evaluates all functions at the point that it has just told of."""
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

        bounds = watched.program
        binding = program.AddConstraint(
            constraint, lb=bounds.row_lower[rows], ub=bounds.row_upper[rows], vars=z[block.columns]
        )
        binding.evaluator().SetGradientSparsityPattern(list(zip(*(index.tolist() for index in block.at), strict=True)))

    for first in range(0, z.size, _WIDEST_BLOCK):
        add_cost(np.arange(first, min(first + _WIDEST_BLOCK, z.size)), first == 0)
    for block in watched.blocks:
        add_rows(block)


def _options(
    program: Program, tolerance: float, max_iterations: int, print_file: str, others: Mapping[str, int | float | str]
) -> dict[str, int | float | str]:
    return {
        # SNOPT takes a row for met within this times |z|, and Prowl's tolerance is on the row itself.
        "Major feasibility tolerance": tolerance / max(1.0, float(np.linalg.norm(program.start))),
        "Major optimality tolerance": tolerance,
        "Major iterations limit": max_iterations,
        "Iterations limit": 1_000_000,  # minor ones: the limit is on the major ones
        "Superbasics limit": program.start.size + 1,  # the default ends programs with more than 500 degrees of freedom
        "Hessian full memory" if program.start.size <= _MOST_FOR_FULL_MEMORY else "Hessian limited memory": "",
        "Derivative option": 1,  # all are given
        "Verify level": -1,  # and not to be checked by differences
        "Print file": print_file,
        "Summary file": _PRINT_UNIT,
    } | dict(others)


def _iterations(summary: str) -> int:
    found = re.search(r"No\. of major iterations\s+(\d+)", summary)
    return int(found[1]) if found else 0


def minimise(
    program: Program,
    *,
    tolerance: float,
    max_iterations: int,
    max_seconds: float,
    options: Mapping[str, int | float | str] | None = None,
    on_evaluation: Callable[[int, float, float], None] | None = None,
) -> Outcome:
    """Raises ImportError if there is no pydrake, and what an evaluation raises, but for Stop and ArithmeticError."""
    from pydrake.solvers import MathematicalProgram, SnoptSolver, SolverOptions

    begin = time.perf_counter()
    watched = _Watched(program, tolerance, max_seconds, on_evaluation)
    drake = MathematicalProgram()
    z = drake.NewContinuousVariables(program.start.size)
    drake.AddBoundingBoxConstraint(program.lower, program.upper, z)
    _add(drake, z, watched)
    drake.AddVisualizationCallback(watched.visit, z)  # called with each point before all else is evaluated there

    def outcome(
        status: str, message: str, z: np.ndarray, info: int = 0, multipliers: np.ndarray | None = None
    ) -> Outcome:
        return Outcome(
            status,
            message,
            z,
            info,
            _iterations(summary),
            watched.count,
            time.perf_counter() - begin,
            summary,
            multipliers,
        )

    summary = ""
    with tempfile.TemporaryDirectory() as folder:
        print_file = os.path.join(folder, "snopt.txt")
        settings = SolverOptions()
        for name, value in _options(program, tolerance, max_iterations, print_file, options or {}).items():
            settings.SetOption(SnoptSolver.id(), name, value)
        try:
            result = SnoptSolver().Solve(drake, program.start, settings)
        except RuntimeError:
            # Drake's program keeps our functions where the garbage collector does not look: no cycle must go through it.
            error, watched.error = watched.error, None
            if isinstance(error, Stop):
                return outcome(error.status, str(error), watched.best)
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
    details = result.get_solver_details()
    status, message = _INFO.get(details.info, ("solver_failed", "stopped"))
    message = f"{message} (SNOPT INFO {details.info})"
    if status not in ("converged", "infeasible"):
        return outcome(status, message, watched.best, details.info)
    return outcome(
        status, message, result.GetSolution(z), details.info, -details.Fmul[1:]
    )  # SNOPT's are those of f - pi . rows
