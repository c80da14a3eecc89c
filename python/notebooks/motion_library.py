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
# # A library of motions
# HyQ crouches fifty times, with random depth, shift and friction. Prowl plans and checks each motion. The notebook needs
# `pip install "prowl[batch]" pandas`. Run this file as a script, or open it as a notebook (`jupytext --to ipynb motion_library.py`).

# %%
import matplotlib.pyplot as plt
import pandas

import prowl

job = {
    "task": "hyq/crouch",
    "count": 50,
    "seed": 1,
    "shard": 25,
    "draw": [
        {"key": "goal[0].base_displacement_m[0]", "uniform": [-0.06, 0.06]},
        {"key": "goal[0].base_displacement_m[2]", "uniform": [-0.18, -0.02]},
        {"key": "surface[0].friction", "one_of": [0.4, 0.5, 0.7]},
    ],
}

# %% [markdown]
# ## Make it
# Prowl starts one process per core. If the cell is interrupted, run it again to resume.

# %%
library = prowl.batch(job, "out/crouches")
print(library, library.grades(), library.causes())

# %% [markdown]
# ## Look at it
# One row for each motion, in a file that pandas, Polars and DuckDB read.

# %%
index = pandas.read_parquet("out/crouches/index.parquet")
assert len(index) == 50 and index.kept.sum() >= 45
index[["index", "kept", "grade", "cost", "goal[0].base_displacement_m[2]"]].head()

# %% [markdown]
# ## Margins
# Each certificate has its checks. How much of the torque limits does a crouch of some depth use?

# %%
kept = index[index.kept]
torque = [next(check["worst"] for check in checks if check["name"] == "joint torque") for checks in kept.checks]
figure, axes = plt.subplots()
axes.plot(kept["goal[0].base_displacement_m[2]"], torque, ".")
axes.set(xlabel="depth [m]", ylabel="largest torque, of its limit")
library.write_page("out/crouches.html")  # all margins, in a browser

# %% [markdown]
# ## Samples
# Motions with torques and forces, as arrays or in the Parquet files.

# %%
deepest = int(kept.loc[kept["goal[0].base_displacement_m[2]"].idxmin(), "index"])
motion = library.arrays(deepest)
assert motion["q"].shape == (len(motion["t"]), 19) and motion["tau"].shape[1] == 12
print({name: values.shape for name, values in motion.items()})

# %% [markdown]
# ## Replay one
# A motion is planned again from job and index, the same to the last bit, with its gains.

# %%
plan = library.plan(deepest)
assert plan.cost == kept.cost[deepest]
plan.show()
prowl.simulate(plan, seed=1)
