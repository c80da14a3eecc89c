"""A task as Crocoddyl's shooting problem, forward or inverse dynamics, with limits as penalties or as constraints.

What a peer cannot have, or has otherwise than Prowl, is listed in bench/README.md.
"""

from dataclasses import dataclass

import crocoddyl
import numpy as np
import pinocchio as pin

from judge.motion import Motion
from judge.motion_task import Goal, MotionTask
from judge.robot import Contact
from peers.nodes import Node, anchor, goals_at, held_motion, landing_place, least_height, make_nodes

WORLD = pin.LOCAL_WORLD_ALIGNED
PLACE, TURN, VELOCITY = 1e5, 1e5, 1e4  # penalties on what has to hold at one node: [1/m²], [1/rad²], [s²/m²]
CLEARANCE = 1e5  # ... of a foot in the air below its least height [1/m²]
CONE = 1e1  # ... of a force outside its cone, as in crocoddyl.utils.quadruped [1/N²]
JOINTS = 1e4  # ... of a joint beyond its limits of position [1/rad²]; of velocity the same number
NO_FORCE = 1e1  # ... of a force that has to vanish before its contact opens [1/N²]
FREE = 1e3  # stands for infinity in bounds
FORCE_WEIGHT = 1e-7  # keeps inverse dynamics' forces determined [1/N²]
IDLE = 1e-3  # keeps inputs determined that move nothing
MOMENT = 1e-9  # step of an action that takes no time: Crocoddyl multiplies costs by their step [s]


class ShootingProblem:
    """`rule`: "euler" or "rk4". `inverse`: nodes with accelerations and forces as inputs. `hard`: cones, torque limits and clearances as
    constraints. `joint_bounds`: joints are kept within their limits of position and velocity. `anchored`: contacts whose place the
    task tells are pulled back to it, with critical damping; else only their velocities are corrected."""

    def __init__(
        self,
        task: MotionTask,
        step: float,
        rule: str,
        inverse: bool,
        hard: bool,
        joint_bounds: bool,
        anchored: bool,
    ):
        self.task, self.rule, self.inverse, self.hard = task, rule, inverse, hard
        self.joint_bounds, self.anchored = joint_bounds, anchored
        self.robot, self.model = task.robot, task.robot.model
        self.state = crocoddyl.StateMultibody(self.model)
        self.actuation = crocoddyl.ActuationModelFloatingBase(self.state)
        self.start = np.concatenate([task.start, task.velocity])
        self.rest = np.concatenate([task.start, np.zeros(self.model.nv)])
        self.nodes = make_nodes(task, step)
        self.base = self.model.getFrameId(self.model.frames[2].name)  # the root link, which the free flyer moves
        actions, self.at = [], []  # the action of each node
        for node in self.nodes:
            if self._has_moment(node):
                actions.append(self._moment(node))
            self.at.append(len(actions))
            actions.append(self._action(node))
        self.problem = crocoddyl.ShootingProblem(self.start, actions[:-1], actions[-1])

    def guess(self) -> tuple[list, list]:
        """The start at every node, and the torques that hold it there."""
        running = [self.rest] * self.problem.T
        return running + [self.rest], list(self.problem.quasiStatic(running))

    def motion(self, states, inputs) -> Motion:
        if self.inverse:
            self.problem.calc(states, inputs)
            torques = [np.array(data.differential.multibody.joint.tau) for data in self.problem.runningDatas]
        else:
            torques = [np.array(torque) for torque in inputs]
        return held_motion(
            self.model.nq, self.nodes, [np.array(states[k]) for k in self.at], [torques[k] for k in self.at[:-1]]
        )

    # One node

    def _has_moment(self, node: Node) -> bool:
        """True if what has to hold at this node alone needs an action of its own: Runge-Kutta spreads costs over the step."""
        lands = node.first and bool(self.task.lands(node.phase))
        return self.rule == "rk4" and node.step > 0 and (lands or bool(goals_at(self.task, node)))

    def _moment(self, node: Node):
        """Only what has to hold at this node."""
        nu = self.actuation.nu
        costs = crocoddyl.CostModelSum(self.state, nu)
        self._add_events(node, costs, nu, 1.0 / MOMENT)
        idle = crocoddyl.ResidualModelControl(self.state, nu)
        self._add(costs, "idle", idle, np.full(nu, IDLE), 1.0 / MOMENT)
        dynamics = crocoddyl.DifferentialActionModelFreeFwdDynamics(self.state, self.actuation, costs)
        return crocoddyl.IntegratedActionModelEuler(dynamics, MOMENT)

    def _action(self, node: Node):
        phase = self.task.phases[node.phase]
        held = [contact for contact in self.robot.contacts if contact.name in phase.contacts]
        nu = self.model.nv + 3 * len(held) if self.inverse else self.actuation.nu
        costs = crocoddyl.CostModelSum(self.state, nu)
        constraints = crocoddyl.ConstraintModelManager(self.state, nu)
        contacts = crocoddyl.ContactModelMultiple(self.state, nu)
        for contact in held:
            contacts.addContact(contact.name, self._contact(contact, node, nu))
        if node.step:
            self._add_running_cost(costs, nu, held)
            self._add_limits(node, held, costs, constraints, nu)
        if node.last:
            self._add_openings(node, costs, nu)
        if not self._has_moment(node):
            self._add_events(node, costs, nu, 1.0 / node.step if node.step else 1.0)

        if self.inverse:
            dynamics = crocoddyl.DifferentialActionModelContactInvDynamics(
                self.state, self.actuation, contacts, costs, constraints
            )
        elif self.hard:
            dynamics = crocoddyl.DifferentialActionModelContactFwdDynamics(
                self.state, self.actuation, contacts, costs, constraints, 0.0, True
            )
        else:
            dynamics = crocoddyl.DifferentialActionModelContactFwdDynamics(
                self.state, self.actuation, contacts, costs, 0.0, True
            )
        if self.rule == "rk4" and node.step:
            action = crocoddyl.IntegratedActionModelRK(dynamics, crocoddyl.RKType.four, node.step)
        else:
            action = crocoddyl.IntegratedActionModelEuler(dynamics, node.step)
        if node.step and not self.inverse:
            action.u_lb, action.u_ub = -self.robot.torque_limit, self.robot.torque_limit  # BoxFDDP keeps them
        return action

    def _contact(self, contact: Contact, node: Node, nu: int):
        place = anchor(self.task, node.phase, contact.name) if self.anchored else None
        stiffness = 0.0 if place is None else node.damping**2 / 4
        place = np.zeros(3) if place is None else place
        gains = np.array([stiffness, node.damping])
        return crocoddyl.ContactModel3D(self.state, contact.frame, place, WORLD, nu, gains)

    def _add(self, costs, name: str, residual, weights: np.ndarray, scale: float = 1.0) -> None:
        activation = crocoddyl.ActivationModelWeightedQuad(np.array(weights, dtype=float))
        costs.addCost(name, crocoddyl.CostModelResidual(self.state, activation, residual), scale)

    def _add_running_cost(self, costs, nu: int, held) -> None:
        cost = self.task.cost
        self._add(
            costs,
            "state",
            crocoddyl.ResidualModelState(self.state, self.rest, nu),
            np.concatenate([cost.configuration, cost.velocity]),
        )
        if self.inverse:
            self._add(
                costs,
                "acceleration",
                crocoddyl.ResidualModelControl(self.state, nu),
                np.concatenate([cost.acceleration, np.full(3 * len(held), FORCE_WEIGHT)]),
            )
            self._add(
                costs,
                "torque",
                crocoddyl.ResidualModelJointEffort(self.state, self.actuation, cost.torque_reference, nu),
                cost.torque,
            )
        else:
            self._add(
                costs, "acceleration", crocoddyl.ResidualModelJointAcceleration(self.state, nu), cost.acceleration
            )
            self._add(costs, "torque", crocoddyl.ResidualModelControl(self.state, cost.torque_reference), cost.torque)

        for contact in held if cost.force.any() else ():
            self._add(
                costs,
                f"force {contact.name}",
                crocoddyl.ResidualModelContactForce(
                    self.state, contact.frame, pin.Force.Zero(), 3, nu, not self.inverse
                ),
                cost.force,
            )

    def _bound(self, costs, constraints, name: str, residual, low, high, weight: float, at_states: bool) -> None:
        """low <= residual <= high, as a constraint or as a penalty."""
        if self.hard:
            constraints.addConstraint(
                name, crocoddyl.ConstraintModelResidual(self.state, residual, low, high, at_states)
            )
        else:
            activation = crocoddyl.ActivationModelQuadraticBarrier(crocoddyl.ActivationBounds(low, high))
            costs.addCost(name, crocoddyl.CostModelResidual(self.state, activation, residual), weight)

    def _joint_bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Bounds on state - neutral state: joints and their velocities, the base free."""
        free = np.full(6, FREE)
        high = np.concatenate([free, self.model.upperPositionLimit[7:], free, self.model.velocityLimit[6:]])
        low = np.concatenate([-free, self.model.lowerPositionLimit[7:], -free, -self.model.velocityLimit[6:]])
        return low, high

    def _add_limits(self, node: Node, held, costs, constraints, nu: int) -> None:
        for contact in held:
            cone = crocoddyl.FrictionCone(
                self.task.ground_axes, self.task.friction, 4, True
            )  # four planes inside the cone
            self._bound(
                costs,
                constraints,
                f"cone {contact.name}",
                crocoddyl.ResidualModelContactFrictionCone(self.state, contact.frame, cone, nu, not self.inverse),
                cone.lb,
                cone.ub,
                CONE,
                False,
            )
        for contact in self.robot.contacts:
            if contact in held:
                continue
            self._bound(
                costs,
                constraints,
                f"clearance {contact.name}",
                crocoddyl.ResidualModelFrameTranslation(self.state, contact.frame, np.zeros(3), nu),
                np.array([-FREE, -FREE, least_height(self.task, node, contact)]),
                np.full(3, FREE),
                CLEARANCE,
                True,
            )
        if self.joint_bounds and node.phase + node.share > 0:  # the start is given
            low, high = self._joint_bounds()
            zero = np.concatenate([pin.neutral(self.model), np.zeros(self.model.nv)])
            self._bound(
                costs,
                constraints,
                "joints",
                crocoddyl.ResidualModelState(self.state, zero, nu),
                low,
                high,
                JOINTS,
                True,
            )
        if self.hard:
            limit = self.robot.torque_limit
            constraints.addConstraint(
                "torque",
                crocoddyl.ConstraintModelResidual(
                    self.state, crocoddyl.ResidualModelControl(self.state, nu), -limit, limit, False
                ),
            )

    def _add_openings(self, node: Node, costs, nu: int) -> None:
        """No force before a contact opens."""
        for name in self.task.opens(node.phase):
            self._add(
                costs,
                f"no force {name}",
                crocoddyl.ResidualModelContactForce(
                    self.state, self.robot.contact(name).frame, pin.Force.Zero(), 3, nu, not self.inverse
                ),
                [NO_FORCE] * 3,
            )

    def _add_events(self, node: Node, costs, nu: int, scale: float) -> None:
        """What has to hold at this node alone: landings and goals."""
        if node.first:
            for name in self.task.lands(node.phase):
                self._add_landing(node, name, costs, nu, scale)
        for number, goal in enumerate(goals_at(self.task, node)):
            self._add_goal(f"goal {number}", goal, costs, nu, scale)

    def _add_landing(self, node: Node, name: str, costs, nu: int, scale: float) -> None:
        contact, place = self.robot.contact(name), landing_place(self.task, node.phase, name)
        self._add(
            costs,
            f"landing {name}",
            crocoddyl.ResidualModelFrameTranslation(self.state, contact.frame, np.nan_to_num(place), nu),
            PLACE * ~np.isnan(place),
            scale,
        )
        self._add(
            costs,
            f"landing speed {name}",
            crocoddyl.ResidualModelFrameVelocity(self.state, contact.frame, pin.Motion.Zero(), WORLD, nu),
            VELOCITY * np.array([1, 1, 1, 0, 0, 0]),
            scale,
        )

    def _add_goal(self, name: str, goal: Goal, costs, nu: int, scale: float) -> None:
        place, speed = ~np.isnan(goal.position), ~np.isnan(goal.velocity)
        if place.any():
            self._add(
                costs,
                f"{name} position",
                crocoddyl.ResidualModelFrameTranslation(self.state, self.base, np.nan_to_num(goal.position), nu),
                PLACE * place,
                scale,
            )
        if goal.rotation is not None:
            self._add(
                costs,
                f"{name} rotation",
                crocoddyl.ResidualModelFrameRotation(self.state, self.base, goal.rotation, nu),
                TURN * goal.turn,
                scale,
            )
        if speed.any():
            target = self.rest.copy()
            target[self.model.nq : self.model.nq + 6] = np.nan_to_num(goal.velocity)
            weights = np.zeros(2 * self.model.nv)
            weights[self.model.nv : self.model.nv + 6] = VELOCITY * speed
            self._add(costs, f"{name} velocity", crocoddyl.ResidualModelState(self.state, target, nu), weights, scale)
