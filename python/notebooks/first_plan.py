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
# # A first plan
# HyQ, a quadruped of 87 kg, lowers its body by 17 cm and stands up again. It takes a few seconds from the task to a checked and
# simulated motion. Run this file as a script, or open it as a notebook (`jupytext --to ipynb first_plan.py`).

# %%
import matplotlib.pyplot as plt
import numpy as np

import prowl

task = prowl.read_task("hyq/crouch")  # one of prowl.shipped_tasks(), or the path of a task file
print(task, task.robot, *task.phases, sep="\n")

# %% [markdown]
# ## Solve
# Shows the iterations. Ctrl-C, or the notebook's stop button, ends the solve with the best motion so far.

# %%
plan = prowl.solve(task)
plan

# %% [markdown]
# ## See it move
# The page of `prowl report`, below this cell in a notebook, in the browser from a script.

# %%
plan.show()

# %% [markdown]
# ## Is the plan good?
# *Converged* is the result of the solver. The certificate checks the finished motion with different dynamics and without a solver:
# errors of the dynamics, drift of contacts, limits of torques and friction.

# %%
assert plan.good
print("grade:", plan.certificate.grade)
plan.certificate

# %% [markdown]
# ## Plots
# Base, contact forces, torques of the most loaded joints, and their share of the limits.

# %%
plan.plot()

# %% [markdown]
# ## The motion as arrays
# NumPy arrays, one row per node: `t`, `q`, `v`, `a`, `tau`, `f`. They are read-only views, not copies.

# %%
robot = plan.robot
motion = plan.sample(0.005)  # interpolated as in the transcription
figure, torque = plt.subplots(figsize=(8, 3), layout="constrained")
for j, name in enumerate(robot.joint_names):
    if name.startswith("lf_"):
        torque.plot(motion.t, motion.tau[:, j], label=name)
torque.axhline(robot.torque_limit[0], color="0.6", linewidth=1)
torque.set_ylabel("torque [N m]")
torque.set_xlabel("time [s]")
torque.legend()
plt.show()

lowest = motion.q[:, 2].min() - motion.q[0, 2]
print(f"lowest point: {100 * lowest:.1f} cm; largest torque {np.abs(motion.tau).max():.0f} N m")
assert abs(lowest + 0.17) < 0.01

# %% [markdown]
# ## Simulate
# In MuJoCo, independent of the planner, with noisy sensors, an estimator and delayed torques.

# %%
simulation = prowl.simulate(plan)
print(simulation.summary())
assert simulation.success
simulation

# %% [markdown]
# The same page, with the simulation next to the plan:

# %%
plan.show(simulation)

# %% [markdown]
# ## Save it
# The same folder as `prowl plan` writes, for `prowl check`, `prowl figures` and a robot's controller.

# %%
plan.write("out/first_plan")
simulation.write("out/first_plan")
assert prowl.read_plan("out/first_plan").good
