"""Whole-body motions of legged robots: plan, check, simulate, track.

    import prowl

    plan = prowl.solve("hyq/crouch")         # a shipped task, a path, or a dict; Ctrl-C stops it
    print(plan.certificate)                  # is it good?
    plan.t, plan.q, plan.tau, plan.f         # NumPy arrays, no copies
    prowl.simulate(plan).success             # in MuJoCo, with its feedback gains
    plan.show()                              # the robot in motion, in a notebook or the browser
    plan.write("out/crouch")                 # same folder as the command

Conventions are Pinocchio's: q contains the base position in the world [m], its quaternion x y z w, then the
joints [rad or m]; v contains the base twist in the base frame [m/s, rad/s], then the joint rates. SI units
throughout. More: docs/python.md.
"""

import importlib.util as _util
import sys as _sys

if _util.find_spec("prowl._prowl") is None:
    raise ImportError(
        f"{__path__[0]}: no module _prowl for Python {_sys.version_info.major}.{_sys.version_info.minor}: "
        "scripts/setup builds it, or install the wheel"
    )

from ._batch import batch, read_library
from ._exports import Export, export
from ._figures import Figures, figures
from ._foxglove import Foxglove
from ._files import parse_robot, parse_task, read_robot, read_task, shipped_robots, shipped_tasks
from ._prowl import (
    Certificate,
    Check,
    Contact,
    Controller,
    Derivatives,
    Diagnosis,
    Dynamics,
    Error,
    ErrorMeasure,
    Evaluation,
    FileError,
    InputError,
    Interrupted,
    Iterate,
    Job,
    JudgedPoint,
    Link,
    Motion,
    MotionRequest,
    MotionSteps,
    NumericalError,
    OnlineMoment,
    OnlineRun,
    Phase,
    Plan,
    Program,
    Progress,
    Robot,
    Simulation,
    Surface,
    Sweep,
    SweepCase,
    Task,
    Term,
    Tracker,
    Tube,
    __version__,
    difference,
    integrate,
    quantity_names,
    read_plan,
    run_online,
    simulate,
    solver_names,
    tube,
    versions,
)
from ._retarget import Deviation, Retargeted, retarget
from ._runs.diagnose import diagnose
from ._runs.solve import solve
from ._runs.sweep import sweep
from ._show.page import Report, report
from ._terms import own_term

__all__ = [
    "Certificate",
    "Check",
    "Contact",
    "Controller",
    "Derivatives",
    "Deviation",
    "Diagnosis",
    "Dynamics",
    "Error",
    "ErrorMeasure",
    "Evaluation",
    "Export",
    "Figures",
    "FileError",
    "Foxglove",
    "InputError",
    "Interrupted",
    "Iterate",
    "Job",
    "JudgedPoint",
    "Link",
    "Motion",
    "MotionRequest",
    "MotionSteps",
    "NumericalError",
    "OnlineMoment",
    "OnlineRun",
    "Phase",
    "Plan",
    "Program",
    "Progress",
    "Report",
    "Retargeted",
    "Robot",
    "Simulation",
    "Surface",
    "Sweep",
    "SweepCase",
    "Task",
    "Term",
    "Tracker",
    "Tube",
    "__version__",
    "batch",
    "diagnose",
    "difference",
    "export",
    "figures",
    "integrate",
    "own_term",
    "parse_robot",
    "parse_task",
    "quantity_names",
    "read_library",
    "read_plan",
    "read_robot",
    "read_task",
    "report",
    "retarget",
    "run_online",
    "shipped_robots",
    "shipped_tasks",
    "simulate",
    "solve",
    "solver_names",
    "sweep",
    "tube",
    "versions",
]
