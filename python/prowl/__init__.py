"""Whole-body motions of legged robots: plan, check, simulate, track.

    import prowl

    task = prowl.read_task("hyq/crouch")     # one that comes with Prowl, or a path
    plan = prowl.solve(task)                 # Ctrl-C stops it
    print(plan.certificate)                  # whether it is any good
    plan.t, plan.q, plan.tau, plan.f         # NumPy arrays, no copies
    prowl.simulate(plan).success             # in MuJoCo, with its feedback gains
    plan.write("out/crouch")                 # what the command writes

Conventions are Pinocchio's: q has the base position in the world [m], its quaternion x y z w, then the joints [rad or m];
v has the base twist in the base frame [m/s, rad/s], then the joint rates. SI units throughout. docs/python.md has more.
"""

import importlib.util as _util
import sys as _sys

if _util.find_spec("prowl._prowl") is None:
    raise ImportError(
        f"{__path__[0]}: no module _prowl for Python {_sys.version_info.major}.{_sys.version_info.minor}: "
        "scripts/setup builds it, or install the wheel"
    )

from . import _notebook
from ._exports import Export, export
from ._figures import Figures, figures
from ._files import parse_robot, parse_task, read_robot, read_task, shipped_robots, shipped_tasks
from ._prowl import (
    Certificate,
    Check,
    Contact,
    Derivatives,
    Diagnosis,
    Dynamics,
    Error,
    ErrorMeasure,
    Evaluation,
    FileError,
    InputError,
    Interrupted,
    JudgedPoint,
    Link,
    Motion,
    NumericalError,
    Phase,
    Plan,
    Program,
    Progress,
    Robot,
    Simulation,
    Surface,
    Task,
    Tracker,
    __version__,
    diagnose,
    difference,
    integrate,
    read_plan,
    simulate,
    solver_names,
    versions,
)
from ._solve import solve

_notebook.show_as_tables()
del _notebook

__all__ = [
    "Certificate",
    "Check",
    "Contact",
    "Derivatives",
    "Diagnosis",
    "Dynamics",
    "Error",
    "ErrorMeasure",
    "Evaluation",
    "Export",
    "Figures",
    "FileError",
    "InputError",
    "Interrupted",
    "JudgedPoint",
    "Link",
    "Motion",
    "NumericalError",
    "Phase",
    "Plan",
    "Program",
    "Progress",
    "Robot",
    "Simulation",
    "Surface",
    "Task",
    "Tracker",
    "__version__",
    "diagnose",
    "difference",
    "export",
    "figures",
    "integrate",
    "parse_robot",
    "parse_task",
    "read_plan",
    "read_robot",
    "read_task",
    "shipped_robots",
    "shipped_tasks",
    "simulate",
    "solve",
    "solver_names",
    "versions",
]
