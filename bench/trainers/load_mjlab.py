"""Loads motions with mjlab's own loader, and compares one with what mjlab's own csv_to_npz makes of its joints and base:
load_mjlab.py FOLDER MODEL.xml, in an environment with mjlab 1.6.0 (scripts/trainers)."""

import os
import sys
from pathlib import Path

os.environ["WANDB_MODE"] = "disabled"

import mjlab.scripts.csv_to_npz as theirs
import mujoco
import numpy as np
import torch
from mjlab.entity import EntityCfg
from mjlab.scene import Scene, SceneCfg
from mjlab.sim.sim import Simulation, SimulationCfg
from mjlab.tasks.tracking.mdp.commands import MotionLoader

folder, model = Path(sys.argv[1]), Path(sys.argv[2])
files = sorted(folder.glob("*.npz"))
frames = 0
for file in files:
    bodies = len(np.load(file)["body_names"])
    loaded = MotionLoader(str(file), torch.arange(bodies))
    assert loaded.body_pos_w.shape == (loaded.time_step_total, bodies, 3)
    frames += loaded.time_step_total
print(f"mjlab loads {len(files)} motions, {frames} frames, {bodies} bodies")

mine = np.load(files[-1])
rows = np.column_stack([mine["body_pos_w"][:, 0], np.roll(mine["body_quat_w"][:, 0], -1, axis=1), mine["joint_pos"]])
np.savetxt(folder / "motion.csv", rows, delimiter=",")


def robot() -> mujoco.MjSpec:
    spec = mujoco.MjSpec.from_file(str(model))
    for ground in list(spec.worldbody.geoms):
        spec.delete(ground)
    return spec


scene = Scene(SceneCfg(num_envs=1, entities={"robot": EntityCfg(spec_fn=robot)}), device="cpu")
simulation = Simulation(num_envs=1, cfg=SimulationCfg(), model=scene.compile(), device="cpu")
scene.initialize(simulation.mj_model, simulation.model, simulation.data)
names = [str(name) for name in mine["joint_names"]]
fps = int(mine["fps"][0])
theirs.run_sim(simulation, scene, names, str(folder / "motion.csv"), fps, fps, "prowl", False, None)
made = np.load("/tmp/motion.npz")  # where csv_to_npz writes
assert list(scene["robot"].joint_names) == names
count = len(made["joint_pos"])
signs = np.sign(np.sum(made["body_quat_w"] * mine["body_quat_w"][:count], axis=-1, keepdims=True))
for name, allowed in (
    ("joint_pos", 1e-6),
    ("body_pos_w", 1e-5),
    ("body_quat_w", 1e-5),
    # Theirs are differences over two frames.
    ("joint_vel", 0.1),
    ("body_lin_vel_w", 0.05),
    ("body_ang_vel_w", 0.1),
):
    own = mine[name][:count] * (signs if name == "body_quat_w" else 1.0)
    difference = float(np.abs(own - made[name]).max())
    print(f"{name}: differs from csv_to_npz by at most {difference:.2g}")
    assert difference < allowed, name
