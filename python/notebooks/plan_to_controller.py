# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     name: python3
# ---

# %% [markdown]
# # From plan to controller
# The planned torques alone let the robot fall: standing is unstable. `solve` also designs feedback gains K(t) along the motion,
# and `plan.tracker` is the control law
#
#     tau = tau*(t) + K(t) (x* - x),  within the torque limits
#
# This notebook shows it, runs it by hand, and prepares it for a robot.

# %%
import time
from pathlib import Path

import numpy as np

import prowl

plan = prowl.solve("hyq/crouch")
assert plan.tracker is not None  # the plan is good
tracker = plan.tracker
print(tracker, tracker.K.shape, "joints x (position and velocity), for each of", len(tracker), "samples")

# %% [markdown]
# ## By hand
# Integrates the dynamics with all feet on the ground in small steps, from a start that is 2 cm and 2 degrees off, with the planned
# torques alone and with those of the tracker.

# %%
dynamics = prowl.Dynamics(plan.robot, contacts=plan.task.phases[0].contacts)
step = 1e-3


def start_beside() -> np.ndarray:
    """The planned start with the body displaced and the feet in place, by a few Newton steps."""
    q0 = plan.q[0]
    q = prowl.integrate(q0, np.array([0.01, 0.015, -0.01, 0.02, -0.02, 0.0] + 12 * [0.0]))
    feet = dynamics.contact_positions(q0)
    for _ in range(10):
        off = (feet - dynamics.contact_positions(q)).ravel()
        J = dynamics.contact_jacobian(q).reshape(12, 18)[:, 6:]  # columns of the joints: the body stays
        q = prowl.integrate(q, np.concatenate([np.zeros(6), np.linalg.solve(J, off)]))
    return q


def run(control, until: float) -> np.ndarray:
    """Distance of the base from the plan at every step [m]."""
    q, v, distance = start_beside(), np.zeros(18), []
    for t in np.arange(0.0, until, step):
        distance.append(np.linalg.norm(q[:3] - tracker.reference(t)[0][:3]))
        v = v + step * dynamics.forward(q, v, control(t, q, v)).value
        tangent = step * v
        x, y, z, w = q[3:7]
        turn = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        tangent[:3] = turn @ tangent[:3]  # v is in the base frame, a displacement in the world
        q = prowl.integrate(q, tangent)
    return np.array(distance)


open_loop = run(lambda t, q, v: tracker.feedforward(t), until=0.6)
closed_loop = run(tracker.torque, until=2.0)
print(
    f"off by {100 * closed_loop[0]:.1f} cm at the start; after 0.6 s {100 * open_loop[-1]:.1f} cm in open loop and "
    f"{100 * closed_loop[600]:.2f} cm in closed loop; {1000 * closed_loop[-1]:.2f} mm at the end"
)
assert open_loop[-1] > 2 * open_loop[0] and closed_loop[600] < 0.2 * closed_loop[0] and closed_loop[-1] < 1e-3

# %% [markdown]
# ## In MuJoCo
# With sensors, an estimator and delay, on a robot 5 % heavier than planned, and a push of 30 N s from the side.

# %%
simulation = prowl.simulate(plan, mass=1.05, delay=3e-3, pushes=[(0.5, (0.0, 30.0, 0.0))])
print(simulation.summary())
assert simulation.success
print("without feedback:", *prowl.simulate(plan, open_loop=True).failures)

# %% [markdown]
# ## On a robot
# `tracker.bin` contains everything that a controller needs. In C++ (`prowl/tracker`, which needs only Eigen):
#
#     const auto tracker = prowl::Tracker::read("out/plan_to_controller/tracker.bin");
#     tracker.torque(t, q, v, tau);   // every tick; no allocation
#
# and the same in Python:

# %%
plan.write("out/plan_to_controller")
on_robot = prowl.Tracker.read(Path("out/plan_to_controller/tracker.bin"))
q, v = on_robot.reference(0.5)
np.testing.assert_array_equal(on_robot.torque(0.5, q, v), tracker.torque(0.5, q, v))
begin, calls = time.perf_counter(), 2000
for _ in range(calls):
    on_robot.torque(0.5, q, v)
print(
    f"phase '{on_robot.phase(0.5)}', contacts {on_robot.contacts(0.5)}; "
    f"{1e6 * (time.perf_counter() - begin) / calls:.1f} us a call from Python"
)
