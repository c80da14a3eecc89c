"""The peers' solvers with the settings that they are measured with."""

import dataclasses
import math
import pathlib
import time
from dataclasses import dataclass

import crocoddyl
import mim_solvers

from judge.motion import Motion
from judge.motion_task import MotionTask
from peers import aligator_solver
from peers.clock import Clock
from peers.environment import ALIGATOR_PROGRAM
from peers.nodes import make_nodes
from peers.shooting_problem import ShootingProblem

MAX_ITERATIONS = 300  # as many as Prowl has by default
DEFAULT_ITERATIONS = 100  # Crocoddyl's and mim_solvers'
EXAMPLES_STEP = 0.01  # as in Crocoddyl's quadrupedal_gaits [s]


@dataclass(frozen=True)
class Peer:
    label: str
    rules: tuple[str, ...]  # of integration; the first is that of its own examples
    solver: type | None = None
    inverse: bool = False
    hard: bool = False


PEERS = {
    "boxfddp": Peer("Crocoddyl BoxFDDP", ("euler", "rk4"), crocoddyl.SolverBoxFDDP),
    "intro": Peer("Crocoddyl Intro", ("euler",), crocoddyl.SolverIntro, inverse=True),
    "sqp": Peer("mim_solvers SQP", ("euler", "rk4"), mim_solvers.SolverSQP),
    "csqp": Peer("mim_solvers CSQP", ("euler", "rk4"), mim_solvers.SolverCSQP, hard=True),
    "aligator": Peer("aligator", ("semi-implicit", "rk2"), hard=True),
}
# Of aligator: with its filter 4 iterations on `stand`, without 25; smaller or larger penalties take more on `balance` and `step`.
ALIGATOR = {"tolerance": 1e-4, "penalty": 1e-6, "filter": True, "max_iterations": MAX_ITERATIONS}
ALIGATOR_DEFAULTS = {"tolerance": 1e-6, "penalty": 1e-2, "filter": False, "max_iterations": 1000}


@dataclass(frozen=True)
class PeerSetup:
    """`step`: nearly that of the mesh [s]. `defaults`: settings of the solver itself, else those of this file."""

    solver: str
    step: float
    rule: str = "euler"
    joint_bounds: bool = False
    anchored: bool = True
    defaults: bool = False

    @property
    def peer(self) -> Peer:
        return PEERS[self.solver]

    def with_joint_bounds(self) -> "PeerSetup":
        return dataclasses.replace(self, joint_bounds=True)


@dataclass(frozen=True)
class PeerRun:
    motion: Motion
    seconds: list[float]  # CPU time of each repetition
    guess_seconds: float
    setup_seconds: float
    iterations: int
    converged: bool
    nodes: int


class OutOfTime(Exception):
    pass


def _watch(base: type, seconds: float):
    """A callback that ends the solve after the iteration in which its time is over; the solver keeps its last iterate."""

    class Watch(base):
        end = time.process_time() + seconds

        def __call__(self, *_) -> None:
            if time.process_time() > self.end:
                raise OutOfTime

    return Watch()


def _configure(setup: PeerSetup, solver, is_sqp: bool) -> None:
    solver.setCallbacks([])
    if setup.defaults:
        return
    if is_sqp:
        solver.termination_tolerance = 1e-3
        solver.use_filter_line_search = True
        if setup.solver == "csqp":
            solver.eps_abs, solver.eps_rel, solver.max_qp_iters = 1e-4, 1e-4, 200
    else:
        solver.th_stop = 1e-5


def make_shooting(setup: PeerSetup, task: MotionTask):
    """The problem, and the solver that is set up for it."""
    peer = setup.peer
    shooting = ShootingProblem(
        task, setup.step, setup.rule, peer.inverse, peer.hard, setup.joint_bounds, setup.anchored
    )
    shooting.problem.nthreads = 1
    solver = peer.solver(shooting.problem)
    _configure(setup, solver, setup.solver in ("sqp", "csqp"))
    return shooting, solver


def _solve_shooting(setup: PeerSetup, task: MotionTask, clock: Clock) -> PeerRun:
    peer, is_sqp = setup.peer, setup.solver in ("sqp", "csqp")
    times = [time.process_time()]
    shooting, solver = make_shooting(setup, task)
    times.append(time.process_time())
    states, inputs = shooting.guess()
    times.append(time.process_time())
    iterations = DEFAULT_ITERATIONS if setup.defaults else MAX_ITERATIONS

    def run() -> bool:
        if math.isfinite(clock.time_limit):
            base = mim_solvers.CallbackAbstract if is_sqp else crocoddyl.CallbackAbstract
            solver.setCallbacks([_watch(base, clock.time_limit)])
        try:
            if is_sqp or setup.defaults:
                return bool(solver.solve(states, inputs, iterations, False))
            return bool(solver.solve(states, inputs, iterations, False, 1e-7 if peer.inverse else 1e-1))
        except OutOfTime:
            return False

    seconds = []
    while not seconds or (len(seconds) < clock.repetitions and sum(seconds) < clock.patience):
        start = time.process_time()
        converged = run()
        seconds.append(time.process_time() - start)
    return PeerRun(
        shooting.motion(solver.xs, solver.us),
        seconds,
        times[2] - times[1],
        times[1] - times[0],
        int(solver.iter),
        converged,
        len(shooting.nodes),
    )


def _solve_aligator(setup: PeerSetup, task: MotionTask, clock: Clock, program: pathlib.Path) -> PeerRun:
    nodes = make_nodes(task, setup.step)
    settings = {
        **(ALIGATOR_DEFAULTS if setup.defaults else ALIGATOR),
        "time_limit": min(clock.time_limit, 1e6),
        "repetitions": clock.repetitions,
        "patience": clock.patience,
    }
    start = time.process_time()
    holding = aligator_solver.holding_torques(task)
    guess_seconds = time.process_time() - start
    request = aligator_solver.document(task, nodes, setup.rule, setup.joint_bounds, holding, settings)
    motion, answer = aligator_solver.run(program, task, nodes, request)
    return PeerRun(
        motion,
        answer["seconds"],
        guess_seconds,
        answer["setup_seconds"],
        answer["iterations"],
        answer["converged"],
        len(nodes),
    )


def solve(setup: PeerSetup, task: MotionTask, clock: Clock = Clock()) -> PeerRun:
    if setup.solver == "aligator":
        return _solve_aligator(setup, task, clock, ALIGATOR_PROGRAM)
    return _solve_shooting(setup, task, clock)
