"""A task's motion and gains by Crocoddyl's BoxFDDP, set up as in its own examples: TASK.toml OUT.npz DURATIONS, one a phase [s].

Arrays, one row for each of N nodes: time, states (q, v), torques and gains that hold until the next; orders and tangent of Pinocchio.
"""

import argparse
import pathlib
import sys

import numpy as np

from judge.motion_task import read_task
from peers.environment import package_dirs
from peers.peer_solvers import DEFAULT_ITERATIONS, EXAMPLES_STEP, PeerSetup, make_shooting


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("task", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("durations", type=float, nargs="+")
    arguments = parser.parse_args()
    task = read_task(arguments.task, package_dirs(pathlib.Path(sys.prefix))).with_durations(arguments.durations)
    shooting, solver = make_shooting(PeerSetup("boxfddp", EXAMPLES_STEP, anchored=False, defaults=True), task)
    states, inputs = shooting.guess()
    solver.solve(states, inputs, DEFAULT_ITERATIONS, False)
    np.savez(
        arguments.out,
        time=np.cumsum([0.0, *(node.step for node in shooting.nodes[:-1])]),
        states=np.array(solver.xs),
        torques=np.array([*solver.us, solver.us[-1]]),
        gains=np.array([*solver.K, solver.K[-1]]),
        joints=task.robot.joints,
    )


if __name__ == "__main__":
    main()
