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
# # Your own robot
# From a URDF to a plan. The robot here is made up: a body of 12 kg on four legs with three joints each. Replace it by the path
# of your own URDF; docs/adding-a-robot.md contains the long version.

# %%
from pathlib import Path

import numpy as np

import prowl


def link(name: str, mass: float, size: tuple[float, float, float], centre: tuple[float, float, float]) -> str:
    """A solid box."""
    x, y, z = size
    inertia = [mass / 12 * (y * y + z * z), mass / 12 * (x * x + z * z), mass / 12 * (x * x + y * y)]
    return f"""<link name="{name}"><inertial><origin xyz="{" ".join(map(str, centre))}"/><mass value="{mass}"/>
      <inertia ixx="{inertia[0]}" iyy="{inertia[1]}" izz="{inertia[2]}" ixy="0" ixz="0" iyz="0"/></inertial></link>"""


def joint(
    name: str, parent: str, child: str, at: tuple[float, float, float], axis: str, lower: float, upper: float
) -> str:
    return f"""<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
      <origin xyz="{" ".join(map(str, at))}"/><axis xyz="{axis}"/>
      <limit lower="{lower}" upper="{upper}" effort="40" velocity="15"/></joint>"""


def leg(name: str, x: float, y: float) -> str:
    side = 0.08 if y > 0 else -0.08
    return "\n".join(
        [
            joint(f"{name}_hip", "body", f"{name}_hip_link", (x, y, 0), "1 0 0", -0.8, 0.8),
            link(f"{name}_hip_link", 0.6, (0.08, 0.08, 0.08), (0, side / 2, 0)),
            joint(f"{name}_thigh", f"{name}_hip_link", f"{name}_thigh_link", (0, side, 0), "0 1 0", -1.5, 2.5),
            link(f"{name}_thigh_link", 0.9, (0.04, 0.04, 0.25), (0, 0, -0.125)),
            joint(f"{name}_knee", f"{name}_thigh_link", f"{name}_shank_link", (0, 0, -0.25), "0 1 0", -2.6, -0.3),
            link(f"{name}_shank_link", 0.3, (0.03, 0.03, 0.25), (0, 0, -0.125)),
            f'<joint name="{name}_foot_joint" type="fixed"><parent link="{name}_shank_link"/><child link="{name}_foot"/>'
            f'<origin xyz="0 0 -0.25"/></joint><link name="{name}_foot"/>',
        ]
    )


FEET = {"lf": (0.2, 0.1), "lh": (-0.2, 0.1), "rf": (0.2, -0.1), "rh": (-0.2, -0.1)}
folder = Path("out/own_robot")
folder.mkdir(parents=True, exist_ok=True)
legs = "\n".join(leg(name, x, y) for name, (x, y) in FEET.items())
(folder / "quad.urdf").write_text(f'<robot name="quad">{link("body", 12, (0.5, 0.2, 0.12), (0, 0, 0))}{legs}</robot>')

# %% [markdown]
# ## The robot file
# A robot file names the URDF, the contacts that may touch the ground, and a posture, here as a dict, or as TOML in a file. List
# the frames for contacts first:

# %%
description: dict = {"name": "quad", "urdf": "quad.urdf"}
robot = prowl.parse_robot(description, folder=folder)
print(robot, robot.frames(), sep="\n")

# %%
description["contact"] = [{"name": f"{name}_foot", "frame": f"{name}_foot", "radius_m": 0.02} for name in FEET]
description["nominal"] = {
    "joints": {f"{name}_{part}": angle for name in FEET for part, angle in (("thigh", 0.8), ("knee", -1.6))}
}
robot = prowl.parse_robot(description, folder=folder)
print(robot.summary())
print("warnings:", robot.warnings())
assert robot.mass > 19 and robot.contact_names == ["lf_foot", "lh_foot", "rf_foot", "rh_foot"]

# %% [markdown]
# Errors contain location and remedy:

# %%
try:
    prowl.parse_robot({**description, "contact": [{"name": "lf_foot", "frame": "lf_fot"}]}, folder=folder)
except prowl.InputError as error:
    print(error)

# %% [markdown]
# ## A task for it
# Down by 8 cm and up again. Keys and units: docs/task-file.md. The robot is the object from above.

# %%
rest = np.zeros(3)


def crouch(depth: float) -> dict:
    """A task as a dict: lists may be NumPy arrays."""
    return {
        "name": "crouch",
        "robot": robot,
        "surface": [{"name": "floor", "friction": 0.6}],
        "phase": [{"contacts": "all", "duration_s": 1.2, "intervals": 80}],
        "goal": [
            {"time_s": 0.6, "base_displacement_m": np.array([0.0, 0.0, -depth]), "base_rpy_rad": rest},
            {
                "time_s": 1.2,
                "base_displacement_m": rest,
                "base_rpy_rad": rest,
                "base_linear_velocity_mps": rest,
                "base_angular_velocity_radps": rest,
            },
        ],
        "cost": {
            "base_linear_acceleration": 1.0,
            "base_angular_acceleration": 1.0,
            "joint_acceleration": 0.01,
            "torque": 1e-4,
        },
    }


plan = prowl.solve(crouch(0.08))
print(plan.summary())
assert plan.good

# %% [markdown]
# ## How much can it do?
# The same with deeper and deeper goals, each started from the first plan. The last is too deep for these legs: this raises no
# exception, but returns a plan that is not good, with reasons or hints.

# %%
for depth in (0.08, 0.14, 0.20, 0.26):
    deeper = prowl.solve(crouch(depth), start_from=plan, gains=False)
    torque = np.abs(deeper.tau).max() / robot.torque_limit.max()
    print(
        f"{100 * depth:3.0f} cm: {deeper.status}, certificate {deeper.certificate.grade}, {100 * torque:.0f} % of the torque"
    )
    for reason in deeper.reasons + deeper.hints:
        print("   ", reason)
assert not deeper.good and deeper.reasons + deeper.hints
