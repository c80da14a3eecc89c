"""A peer's solver in the place of Prowl's controller, in a process and an environment of its own."""

import pathlib
import pickle
import subprocess

import numpy as np

import prowl
from peers.environment import ENVIRONMENT, ROOT, variables
from peers.mpc_mesh import NODES, STEP


class PeerPlanner:
    """For prowl.run_online(planner=...). `solver`: "boxfddp" or "sqp"; `iterations`: at most, of a plan."""

    def __init__(self, robot: prowl.Robot, robot_file: pathlib.Path, solver: str, iterations: int) -> None:
        module = [ENVIRONMENT / "bin/python", "-m", "peers.shooting_mpc", robot_file, solver, str(iterations)]
        self.process = subprocess.Popen(
            module, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=variables(), cwd=ROOT / "bench"
        )
        self.stance = 0.0  # time that a foot stands between two swings, once it is known [s]
        standing = prowl.Controller(robot, "stand").standing
        self._send({"joints": robot.joint_names, "standing": np.array(standing)})

    def _send(self, message: dict) -> None:
        pickle.dump(message, self.process.stdin)
        self.process.stdin.flush()

    def __call__(self, request: prowl.MotionRequest) -> prowl.MotionSteps:
        times = request.start + STEP * np.arange(NODES + 1)
        swings = [[request.swing(foot, t) for t in times] for foot in range(4)]
        self.stance = self.stance or self._stance(request)
        self._send(
            {
                "start": request.start,
                "q": np.array(request.q),
                "v": np.array(request.v),
                "command": np.array(request.command),
                "pose": np.array(request.pose),
                "swings": swings,
                "stance": self.stance,
            }
        )
        return prowl.MotionSteps(**pickle.load(self.process.stdout))

    @staticmethod
    def _stance(request: prowl.MotionRequest) -> float:
        """That time; 0 if no foot swings twice in what is known."""
        for foot in range(4):
            times = request.start + np.arange(0.0, 1.5, STEP)
            known = sorted({swing for t in times if (swing := request.swing(foot, t)) is not None})
            if len(known) > 1:
                return known[1][0] - known[0][1]
        return 0.0

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
