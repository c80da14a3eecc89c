"""Whether a task that has no plan has a motion at all: three solvers on a finer mesh, each from several starts."""

import copy

import prowl

from load.random_tasks import folder

SOLVERS = ("riccati", "fatrop", "ipopt")
FINER = 4  # times the intervals of the first mesh


def eased(document: dict, share: float) -> dict:
    """The task with goals so near: 0 asks for the start pose, 1 for all."""
    easy = copy.deepcopy(document)
    for goal in easy["goal"]:
        goal["base_displacement_m"] = [share * x for x in goal["base_displacement_m"]]
        goal["base_rpy_rad"] = [share * x for x in goal["base_rpy_rad"]]
    return easy


def starts(robot: str, document: dict, count: int, max_time: float):
    """The plan's own guess, then plans of the task with goals ever nearer to what it asks for."""
    yield None
    for i in range(1, count):
        task = prowl.parse_task(eased(document, i / count), folder=folder(robot), max_time=max_time)
        plan = prowl.solve(task, gains=False, progress=False)
        if plan.status == "converged":
            yield plan


def who_solves(robot: str, document: dict, count: int, max_time: float) -> str:
    """Solver and start that converged on the finer mesh; "" if none did. Its motion need not pass: on a mesh that is
    still coarse a solver may find steps between postures that no motion connects."""
    fine = copy.deepcopy(document)
    for phase, own in zip(fine["phase"], prowl.parse_task(document, folder=folder(robot)).phases):
        phase["intervals"] = FINER * own.intervals
    task = prowl.parse_task(fine, folder=folder(robot), max_time=max_time)
    for number, start in enumerate(starts(robot, document, count, max_time)):
        for solver in SOLVERS:
            plan = prowl.solve(task, solver=solver, start_from=start, gains=False, progress=False)
            if plan.status == "converged":
                return f"{solver} from start {number}"
    return ""
