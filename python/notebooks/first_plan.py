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
# HyQ, a quadruped of 87 kg, lowers its body by 17 cm and stands up again. From the task to a motion that was checked and
# simulated: a few seconds. Run it as it is, or open it as a notebook (`jupytext --to ipynb first_plan.py`).

# %%
import matplotlib.pyplot as plt
import numpy as np

import prowl

task = prowl.read_task("hyq/crouch")  # one of prowl.shipped_tasks(), or the path of a task file
print(task, task.robot, *task.phases, sep="\n")

# %% [markdown]
# ## Solve
# Iterations are shown as they come. Ctrl-C, or the notebook's stop button, ends it with the best motion so far.

# %%
plan = prowl.solve(task)
plan

# %% [markdown]
# ## See it move
# The page of `prowl report`: below this cell in a notebook, in the browser for a script.

# %%
plan.show()

# %% [markdown]
# ## Is it any good?
# Converged is a claim of the solver. The certificate is a check of the finished motion by code with other dynamics and no solver:
# how well it obeys the dynamics, whether contacts hold, whether torques and friction stay within their limits.

# %%
assert plan.good
print("grade:", plan.certificate.grade)
plan.certificate

# %% [markdown]
# ## Plots
# Base, contact forces, torques of the joints that work hardest, and their share of the limits.

# %%
plan.plot()

# %% [markdown]
# ## The motion as arrays
# NumPy arrays, one row a node: `t`, `q`, `v`, `a`, `tau`, `f`. They are views, not copies, and read-only.

# %%
robot = plan.robot
motion = plan.sample(0.005)  # between the nodes as the planner means it
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
# In MuJoCo, which knows nothing of how the plan was made, with noisy sensors, an estimator and delayed torques.

# %%
simulation = prowl.simulate(plan)
print(simulation.summary())
assert simulation.success
simulation

# %% [markdown]
# The same page with the simulation beside the plan:

# %%
plan.show(simulation)

# %% [markdown]
# ## Keep it
# The folder that `prowl plan` writes: for `prowl check`, `prowl figures` and a robot's controller.

# %%
plan.write("out/first_plan")
simulation.write("out/first_plan")
assert prowl.read_plan("out/first_plan").good
