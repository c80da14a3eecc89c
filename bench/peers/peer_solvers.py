"""The peers' solvers with the settings that they are measured with."""

import math
import time
from dataclasses import dataclass

import crocoddyl
import mim_solvers

from judge.motion import Motion
from judge.motion_task import MotionTask
from peers.shooting_problem import ShootingProblem

MAX_ITERATIONS = 300  # as many as Prowl has by default


@dataclass(frozen=True)
class Peer:
    label: str
    solver: type
    inverse: bool = False
    hard: bool = False


PEERS = {
    "fddp": Peer("Crocoddyl FDDP", crocoddyl.SolverFDDP),
    "boxfddp": Peer("Crocoddyl BoxFDDP", crocoddyl.SolverBoxFDDP),
    "intro": Peer("Crocoddyl Intro", crocoddyl.SolverIntro, inverse=True),
    "sqp": Peer("mim_solvers SQP", mim_solvers.SolverSQP),
    "csqp": Peer("mim_solvers CSQP", mim_solvers.SolverCSQP, hard=True),
}


@dataclass(frozen=True)
class PeerRun:
    motion: Motion
    seconds: list[float]  # CPU time of each repetition
    iterations: int
    converged: bool
    nodes: int


def _configure(name: str, solver) -> None:
    solver.setCallbacks([])
    if name in ("sqp", "csqp"):
        solver.termination_tolerance = 1e-3
        solver.use_filter_line_search = True
        if name == "csqp":
            solver.eps_abs, solver.eps_rel, solver.max_qp_iters = 1e-4, 1e-4, 200
    else:
        solver.th_stop = 1e-5


class OutOfTime(Exception):
    pass


def _watch(name: str, seconds: float):
    """A callback that ends the solve after the iteration in which its time is over; the solver keeps its last iterate."""

    class Watch(mim_solvers.CallbackAbstract if name in ("sqp", "csqp") else crocoddyl.CallbackAbstract):
        end = time.process_time() + seconds

        def __call__(self, *_) -> None:
            if time.process_time() > self.end:
                raise OutOfTime

    return Watch()


def solve(
    name: str,
    task: MotionTask,
    step: float,
    joint_bounds: bool,
    repetitions: int = 1,
    patience: float = 0.0,
    time_limit: float = math.inf,
    anchored: bool = False,
) -> PeerRun:
    """The motion of one peer; repeated for the clock until all took longer than `patience` [s] together. `time_limit`: of each
    solve, CPU time [s]."""
    peer = PEERS[name]
    shooting = ShootingProblem(task, step, peer.inverse, peer.hard, joint_bounds, anchored)
    shooting.problem.nthreads = 1
    states, inputs = shooting.guess()
    solver = peer.solver(shooting.problem)
    _configure(name, solver)

    def run() -> bool:
        if math.isfinite(time_limit):
            solver.setCallbacks([_watch(name, time_limit)])
        try:
            if name in ("sqp", "csqp"):
                return bool(solver.solve(states, inputs, MAX_ITERATIONS, False))
            return bool(solver.solve(states, inputs, MAX_ITERATIONS, False, 1e-7 if peer.inverse else 1e-1))
        except OutOfTime:
            return False

    seconds = []
    while not seconds or (len(seconds) < repetitions and sum(seconds) < patience):
        start = time.process_time()
        converged = run()
        seconds.append(time.process_time() - start)
    return PeerRun(shooting.motion(solver.xs, solver.us), seconds, int(solver.iter), converged, shooting.problem.T + 1)
