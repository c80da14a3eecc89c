"""Terms of one's own: functions of what the robot does at one moment, for costs and limits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from . import _prowl
from ._documents import Document

Read = str | tuple[str, str]  #: "center_of_mass", or ("position", "lf_foot")
Evaluator = tuple[Callable[[], object], list[np.ndarray], np.ndarray]  # a call, its arguments, its result


def own_term(
    function: Any,
    *,
    reads: Sequence[Read],
    unit: str,
    rows: Sequence[str] | None = None,
    jacobian: Callable[[np.ndarray], Any] | None = None,
    hessian: Callable[[np.ndarray, np.ndarray], Any] | None = None,
    entries: int | None = None,
    size: float = 0.0,
) -> _prowl.Term:
    """A term of one's own from a casadi.Function of one vector, or from functions with derivatives.

    function: f(y); y has the entries of all that is read, one after the other. reads: pairs of a kind and the name of
    a link (or "base") or contact, or kinds alone, of quantity_names(): "position" (3), "velocity" (3), "orientation"
    and "orientation_rate" (9: the axes x, y, z of the link), of links; "force" (3), of a contact; "center_of_mass" (3)
    and "center_of_mass_velocity" (3); "angular_momentum" (3) about it; "joints",
    "joint_rates" and "torques", one for each joint; "time" (1), with fixed durations. World frame, SI.
    rows: names of the entries of f; default: "0", "1", ... unit: of all entries, "-" if none. size: scale of f, of which
    the certificate tolerates a thousandth; default: by the unit.

    A function that is no casadi.Function needs rows, entries, and jacobian(y), with a row for each entry of f; hessian(y, multipliers):
    second derivatives of multipliers . f. entries: the length of y. One thread at a time calls it. Prowl compares all derivatives with differences,
    and names one that is wrong.
    """
    pairs = [(read, "") if isinstance(read, str) else (read[0], read[1]) for read in reads]
    if hasattr(function, "sparsity_in"):
        value, slope, curvature = _of_casadi(function)
    else:
        value, slope, curvature = _of_functions(function, jacobian, hessian, entries, rows)
    count = value[2].shape[0]
    names = [str(row) for row in (range(count) if rows is None else rows)]
    if len(names) != count:
        raise _prowl.InputError(f"rows: {len(names)} names are not allowed; need {count}")
    return _prowl.make_term(pairs, names, unit, size, value, slope, curvature)


def _of_casadi(function: Any) -> tuple[Evaluator, Evaluator, Evaluator]:
    import casadi

    if function.n_in() != 1 or function.n_out() != 1 or function.size2_in(0) != 1 or function.size2_out(0) != 1:
        raise _prowl.InputError(f"function: {function} is not allowed; need one vector in and one out")
    y = casadi.MX.sym("y", function.size1_in(0))
    f = function(y)
    multipliers = casadi.MX.sym("multipliers", f.size1())
    slope, curvature = casadi.jacobian(f, y), casadi.hessian(casadi.dot(multipliers, f), y)[0]
    return (
        _buffered(casadi.Function("value", [y], [casadi.densify(f)])),
        _buffered(casadi.Function("jacobian", [y], [casadi.densify(slope)])),
        _buffered(casadi.Function("hessian", [y, multipliers], [casadi.densify(curvature)])),
    )


def _buffered(function: Any) -> Evaluator:
    """CasADi writes into arrays of ours, without objects of its own for each call."""
    arguments = [np.zeros(function.size1_in(i)) for i in range(function.n_in())]
    result = np.zeros(function.size_out(0), order="F")
    if function.size2_out(0) == 1:
        result = result.reshape(-1)
    buffer, call = function.buffer()
    for i, argument in enumerate(arguments):
        buffer.set_arg(i, memoryview(argument))
    buffer.set_res(0, memoryview(result.reshape(-1, order="F")))

    def run() -> None:
        call()
        if buffer.ret() != 0:  # the result is not what it should be
            result.fill(np.nan)

    return run, arguments, result


def _of_functions(
    function: Any,
    jacobian: Callable[[np.ndarray], Any] | None,
    hessian: Callable[[np.ndarray, np.ndarray], Any] | None,
    entries: int | None,
    rows: Sequence[str] | None,
) -> tuple[Evaluator, Evaluator, Evaluator]:
    if not callable(function) or jacobian is None or hessian is None or entries is None or rows is None:
        raise _prowl.InputError(
            "function: need a casadi.Function, or functions with jacobian, hessian, entries and rows"
        )
    count = len(rows)
    return (
        _filled("function", function, [entries], (count,)),
        _filled("jacobian", jacobian, [entries], (count, entries)),
        _filled("hessian", hessian, [entries, count], (entries, entries)),
    )


def _filled(name: str, function: Callable[..., Any], lengths: list[int], shape: tuple[int, ...]) -> Evaluator:
    arguments = [np.zeros(length) for length in lengths]
    result = np.zeros(shape, order="F")

    def call() -> None:
        given = np.asarray(function(*(argument.copy() for argument in arguments)), dtype=float)
        if given.shape != shape:
            raise _prowl.InputError(f"{name}: shape {given.shape} is not allowed; need {shape}")
        result[...] = given

    return call, arguments, result


def without_terms(document: Document) -> tuple[Document, dict[str, _prowl.Term]]:
    """The dict of a task with names in place of its terms, which the file cannot contain, and these."""
    own: dict[str, _prowl.Term] = {}
    if isinstance(document, str) or not isinstance(document.get("term"), Sequence):
        return document, own
    uses = []
    for i, use in enumerate(document["term"]):
        if isinstance(use, Mapping) and isinstance(use.get("own"), _prowl.Term):
            name = str(use.get("name", f"term {i + 1}"))
            own[name] = use["own"]
            use = {**use, "own": name}
        uses.append(use)
    return {**document, "term": uses}, own
