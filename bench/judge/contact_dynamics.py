"""Accelerations and contact forces that torques cause, for the judge: rigid contacts, no stabilisation, no damping.

    [ M  -J' ] [ a ]   [ S'τ - h ]
    [ J   0  ] [ f ] = [ -J̇v     ]

by one dense factorisation. Neither the planner's projection nor Crocoddyl's solver: a third way to the same numbers.
"""

import numpy as np
import pinocchio as pin

from judge.robot import Robot

WORLD = pin.LOCAL_WORLD_ALIGNED


class ContactDynamics:
    """Forward dynamics of a robot on some of its contacts."""

    def __init__(self, robot: Robot, contacts: frozenset[str]):
        self.robot, self.model, self.data = robot, robot.model, robot.model.createData()
        self.contacts = [contact for contact in robot.contacts if contact.name in contacts]

    def jacobian(self, q: np.ndarray) -> np.ndarray:
        """J, 3 rows a contact, world axes; the model's kinematics have to be at q already."""
        if not self.contacts:
            return np.zeros((0, self.model.nv))
        return np.vstack(
            [pin.getFrameJacobian(self.model, self.data, contact.frame, WORLD)[:3] for contact in self.contacts]
        )

    def __call__(self, q: np.ndarray, v: np.ndarray, tau: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """(a, forces, velocities of the contacts), the last two with one row a contact, in the world."""
        model, data = self.model, self.data
        pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
        pin.computeJointJacobians(model, data)
        pin.updateFramePlacements(model, data)
        mass = pin.crba(model, data, q)
        mass = np.triu(mass) + np.triu(mass, 1).T
        bias = pin.nonLinearEffects(model, data, q, v)
        # After the bias: crba and nonLinearEffects leave accelerations of their own behind.
        pin.forwardKinematics(model, data, q, v, np.zeros(model.nv))
        jacobian = self.jacobian(q)
        drift = np.array(
            [pin.getFrameClassicalAcceleration(model, data, contact.frame, WORLD).linear for contact in self.contacts]
        ).reshape(-1)
        rows = len(drift)
        kkt = np.block([[mass, -jacobian.T], [jacobian, np.zeros((rows, rows))]])
        right = np.concatenate([-bias, -drift])
        right[6 : model.nv] += tau
        try:
            solution = np.linalg.solve(kkt, right)
        except np.linalg.LinAlgError:  # a motion so wild that its contacts depend on each other
            solution = np.full_like(right, np.nan)
        return solution[: model.nv], solution[model.nv :].reshape(-1, 3), (jacobian @ v).reshape(-1, 3)


def standing_torques(robot: Robot, q: np.ndarray, contacts: frozenset[str]) -> np.ndarray:
    """Torques that hold q at rest, with the contact forces of least norm."""
    dynamics = ContactDynamics(robot, contacts)
    gravity = pin.rnea(robot.model, dynamics.data, q, np.zeros(robot.model.nv), np.zeros(robot.model.nv))
    pin.computeJointJacobians(robot.model, dynamics.data, q)
    pin.updateFramePlacements(robot.model, dynamics.data)
    jacobian = dynamics.jacobian(q)
    forces = np.linalg.lstsq(jacobian[:, :6].T, gravity[:6], rcond=None)[0]
    return (gravity - jacobian.T @ forces)[6:]
