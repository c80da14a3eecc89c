"""Loads a dataset with LeRobot's own class: load_lerobot.py FOLDER, in an environment with lerobot 0.4.4
(scripts/trainers)."""

import os
import sys

os.environ["HF_HUB_OFFLINE"] = "1"

import torch
from lerobot.datasets.lerobot_dataset import LeRobotDataset

dataset = LeRobotDataset("prowl/library", root=sys.argv[1], delta_timestamps={"action": [0.0, 0.02, 0.04]})
print(f"LeRobot loads {dataset.num_episodes} episodes, {len(dataset)} frames of {dataset.meta.robot_type}")
batch = next(iter(torch.utils.data.DataLoader(dataset, batch_size=64, shuffle=True)))
for name in ("observation.state", "observation.contact_force", "observation.in_contact", "action"):
    print(f"{name}: {tuple(batch[name].shape)}, mean of all {float(dataset.meta.stats[name]['mean'].mean()):.4g}")
    assert torch.isfinite(batch[name]).all()
