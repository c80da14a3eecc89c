"""Predictive control by a peer's solver, with the action models of Crocoddyl's quadruped examples: ROBOT.toml SOLVER ITERATIONS.

Reads requests from standard input and answers on standard output, both pickled: see bench/online/peer_planner.py.
"""

import pathlib
import pickle
import sys
import time
from collections.abc import Callable

import crocoddyl
import mim_solvers
import numpy as np
import pinocchio as pin
from crocoddyl.utils.quadruped import SimpleQuadrupedalGaitProblem

from judge.robot import GRAVITY, Robot, read_robot
from peers.environment import package_dirs
from peers.mpc_mesh import NODES, STEP

ANSWERED = 15  # steps of an answer: a plan acts for less than their time
STEP_HEIGHT = 0.1  # as in Crocoddyl's quadrupedal_gaits [m]
SWING = 1e6  # its weight of the places of feet in the air
LANDING, LANDING_SPEED = 1e7, 1e6  # weights of its pseudo-impulse, whose cost is not multiplied by a step
SOLVERS: dict[str, Callable] = {"boxfddp": crocoddyl.SolverBoxFDDP, "sqp": mim_solvers.SolverSQP}


class MpcNode:
    """A node of Crocoddyl's quadruped examples with all that any of them has; parts are switched on and off."""

    def __init__(self, gait: SimpleQuadrupedalGaitProblem, feet: list[int]) -> None:
        tasks = [[frame, pin.SE3.Identity()] for frame in feet]
        self.action = gait.createSwingFootModel(STEP, feet, np.zeros(3), tasks)
        self.contacts, self.costs = self.action.differential.contacts, self.action.differential.costs
        self.names = [gait.rmodel.frames[frame].name for frame in feet]
        for frame, name in zip(feet, self.names):
            speed = crocoddyl.ResidualModelFrameVelocity(
                gait.state, frame, pin.Motion.Zero(), pin.LOCAL_WORLD_ALIGNED, gait.actuation.nu
            )
            cost = crocoddyl.CostModelResidual(gait.state, speed)
            self.costs.addCost(name + "_impulseVel", cost, LANDING_SPEED / STEP)
        items = self.costs.costs.todict()
        self.com = items["comTrack"].cost.residual
        self.posture = items["stateReg"].cost.residual
        self.tracks = [items[name + "_footTrack"] for name in self.names]
        self.places = [track.cost.residual for track in self.tracks]
        self.status = [None] * len(feet)

    def set_contact(self, foot: int, stands: bool, lands: bool) -> None:
        if self.status[foot] == (stands, lands):
            return
        self.status[foot] = (stands, lands)
        name = self.names[foot]
        self.contacts.changeContactStatus(name + "_contact", stands)
        self.costs.changeCostStatus(name + "_frictionCone", stands)
        self.costs.changeCostStatus(name + "_footTrack", lands or not stands)
        self.costs.changeCostStatus(name + "_impulseVel", lands)
        self.tracks[foot].weight = LANDING / STEP if lands else SWING


class ShootingMpc:
    """Nodes have the contacts that the request tells. Feet land below their hips, moved by the capture point."""

    def __init__(self, robot: Robot, standing: np.ndarray, solver: str, iterations: int) -> None:
        self.robot, self.model = robot, robot.model
        self.data = self.model.createData()
        self.model.effortLimit = np.concatenate([np.zeros(6), robot.torque_limit])
        self.model.referenceConfigurations["standing"] = standing
        self.feet = [contact.frame for contact in robot.contacts]
        gait = SimpleQuadrupedalGaitProblem(self.model, *(self.model.frames[frame].name for frame in self.feet))
        gait.mu = 0.6  # as Prowl counts on
        self.height = standing[2]
        self.com = pin.centerOfMass(self.model, self.data, standing) - standing[:3]
        self.hips = [self._place(frame, standing) - standing[:3] for frame in self.feet]
        self.radii = [contact.radius for contact in robot.contacts]
        self.nodes = [MpcNode(gait, self.feet) for _ in range(NODES + 1)]
        actions = [node.action for node in self.nodes]
        self.rest = rest = np.concatenate([standing, np.zeros(self.model.nv)])
        self.problem = crocoddyl.ShootingProblem(rest, actions[:-1], actions[-1])
        self.problem.nthreads = 1
        self.solver = SOLVERS[solver](self.problem)
        self.solver.setCallbacks([])
        self.iterations = iterations
        self.states = [rest] * (NODES + 1)
        self.inputs = list(self.problem.quasiStatic([rest] * NODES))
        self.start = None

    def _place(self, frame: int, q: np.ndarray) -> np.ndarray:
        pin.framesForwardKinematics(self.model, self.data, q)
        return self.data.oMf[frame].translation.copy()

    def _set_node(self, node: "MpcNode", request: dict, landings: dict, k: int) -> None:
        ahead = k * STEP
        heading, velocity = self._led(request, ahead)
        node.com.reference = np.append(request["pose"][:2] + ahead * velocity, self.height) + heading @ self.com
        rest = self.rest.copy()
        rest[3:7] = pin.Quaternion(heading).coeffs()
        node.posture.reference = rest
        for foot in range(len(self.feet)):
            swing = request["swings"][foot][k]
            lands = swing is None and k > 0 and request["swings"][foot][k - 1] is not None
            node.set_contact(foot, swing is None, lands)
            if swing is not None or lands:
                node.places[foot].reference = self._swing_place(foot, request, landings, k, lands)

    def _led(self, request: dict, ahead: float) -> tuple[np.ndarray, np.ndarray]:
        forward, left, turn, _ = request["command"]
        heading = pin.utils.rotate("z", request["pose"][2] + ahead * turn)
        return heading, (heading @ np.array([forward, left, 0.0]))[:2]

    def _swing_place(self, foot: int, request: dict, landings: dict, k: int, lands: bool) -> np.ndarray:
        lift, land = request["swings"][foot][k - 1 if lands else k]
        begin, end = landings[foot, land]
        if lands:
            return end
        now = request["start"] + k * STEP
        since = max(lift, request["start"])
        share = (now - lift) / (land - lift)
        place = begin + (end - begin) * np.clip((now - since) / max(land - since, STEP), 0.0, 1.0)
        place[2] = end[2] + STEP_HEIGHT * (1.0 - abs(2.0 * share - 1.0))
        return place

    def _landings(self, request: dict, q: np.ndarray, v: np.ndarray) -> dict:
        """Of each swing in the horizon: where it begins and ends."""
        rotation = pin.XYZQUATToSE3(q[:7]).rotation
        speed = (rotation @ v[:3])[:2]
        pin.framesForwardKinematics(self.model, self.data, q)
        found = {}
        for foot, frame in enumerate(self.feet):
            begin = self.data.oMf[frame].translation.copy()
            for swing in request["swings"][foot]:
                if swing is None or (foot, swing[1]) in found:
                    continue
                heading, velocity = self._led(request, swing[1] - request["start"])
                stance = 0.5 * request["stance"] * velocity
                capture = np.sqrt(self.height / GRAVITY) * (speed - velocity)
                hip = q[:2] + (swing[1] - request["start"]) * velocity + (heading @ self.hips[foot])[:2]
                end = np.append(hip + stance + capture, self.radii[foot])
                found[foot, swing[1]] = (begin, end)
                begin = end
        return found

    def answer(self, request: dict) -> dict:
        q, v = request["q"], request["v"]
        landings = self._landings(request, q, v)
        for k, node in enumerate(self.nodes):
            self._set_node(node, request, landings, k)
        if self.start is not None:
            shift = min(NODES, round((request["start"] - self.start) / STEP))
            self.states = self.states[shift:] + [self.states[-1]] * shift
            self.inputs = self.inputs[shift:] + [self.inputs[-1]] * shift
        self.start = request["start"]
        begin = time.process_time()
        self.problem.x0 = self.states[0] = np.concatenate([q, v])
        self.solver.solve(self.states, self.inputs, self.iterations, False)
        seconds = time.process_time() - begin
        self.states, self.inputs = [np.array(x) for x in self.solver.xs], [np.array(u) for u in self.solver.us]
        gains = -np.array(self.solver.K[:ANSWERED])
        for gain, state in zip(gains, self.states):
            # Pinocchio displaces the base along its own axes.
            gain[:, :3] = gain[:, :3] @ pin.XYZQUATToSE3(state[:7]).rotation.T
        nq = self.model.nq
        states = np.array(self.states[: ANSWERED + 1])
        return {
            "t": request["start"] + STEP * np.arange(ANSWERED + 1),
            "q": states[:, :nq],
            "v": states[:, nq:],
            "tau": np.array(self.inputs[:ANSWERED]),
            "gains": gains,
            "seconds": seconds,
        }


def main() -> None:
    answers, sys.stdout = sys.stdout.buffer, sys.stderr
    robot = read_robot(pathlib.Path(sys.argv[1]), package_dirs(pathlib.Path(sys.prefix)))
    hello = pickle.load(sys.stdin.buffer)
    if hello["joints"] != robot.joints:
        sys.exit("shooting_mpc: the joints are in another order")
    mpc = ShootingMpc(robot, hello["standing"], sys.argv[2], int(sys.argv[3]))
    while True:
        try:
            request = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        pickle.dump(mpc.answer(request), answers)
        answers.flush()


if __name__ == "__main__":
    main()
