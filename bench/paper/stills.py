"""Pictures of the robot: the paper's figures 3 and 9 to 12, and the end of standing and crouching."""

import pathlib

import matplotlib.pyplot as plt
import numpy as np
import style
from motions import SUBJECTS, Motion
from scene import draw

GRAVITY = 9.81  # as prowl has it [m/s²]
FRAME = (5.2, 4.0)  # [in]
PICTURES = {
    "balance": "fig_09_balancing",
    "step": "fig_10_stepping",
    "rear": "fig_11_rearing",
    "stand": "still_standing",
    "crouch": "still_crouching",
}


def _save(figure: plt.Figure, out: pathlib.Path, name: str, title: str) -> None:
    figure.savefig(out / f"{name}.svg", metadata={"Date": None, "Title": title})
    figure.savefig(out / f"{name}.png", metadata={"Title": title})
    plt.close(figure)


def _axes(figure: plt.Figure, left: float = 0.0, width: float = 1.0):
    """For a robot, of this part of the figure's width. Such axes are square: they reach over both edges of a flat figure."""
    flat = figure.get_figwidth() * width / figure.get_figheight()
    return figure.add_axes((left, (1 - flat) / 2 - 0.02, width, flat), projection="3d")


def _caption(figure: plt.Figure, left: float, title: str, text: str) -> None:
    figure.text(left + 0.012, 0.97, title, fontweight="bold", fontsize=11, va="top")
    figure.text(left + 0.012, 0.90, text, color="0.35", va="top")


def _panel(figure: plt.Figure, motion: Motion, left: float = 0.0, width: float = 1.0) -> None:
    draw(_axes(figure, left, width), motion.scene, motion.still_time())
    when = f"middle of phase “{motion.subject.phase}”" if motion.subject.phase else "end of the motion"
    _caption(figure, left, motion.subject.title, f"t = {motion.still_time():.2f} s, {when}")


def draw_stills(motions: dict[str, Motion], out: pathlib.Path) -> None:
    """One picture a motion, and figure 12, which has those of more than one phase side by side."""
    for name, motion in motions.items():
        figure = plt.figure(figsize=FRAME)
        _panel(figure, motion)
        _save(figure, out, PICTURES[name], motion.subject.title)
    several = [motions[subject.name] for subject in SUBJECTS if subject.phase]
    figure = plt.figure(figsize=(FRAME[0] * 0.72 * len(several), FRAME[1] * 0.72))
    for i, motion in enumerate(several):
        _panel(figure, motion, i / len(several), 1 / len(several))
    _save(figure, out, "fig_12_multiphase_motions", "Multiphase motions")


def draw_robot(motion: Motion, out: pathlib.Path) -> None:
    """Figure 3: the nominal configuration, with the lengths that the paper gives of it, as measured here."""
    figure = plt.figure(figsize=(6.0, 4.8))
    axes = _axes(figure)
    corners = draw(axes, motion.scene, 0.0, view=(14, -50), forces=False).reshape(-1, 3)
    hips = {leg: motion.scene.body(f"{leg}_haa_joint", 0.0) for leg in ("lf", "rf", "rh")}
    base = motion.scene.body("base", 0.0)
    near, front = corners[:, 1].min() - 0.05, corners[:, 0].max()
    ends = (
        ((hips["rh"][0], near, 0), (hips["rf"][0], near, 0)),
        ((front, hips["rf"][1], 0), (front, hips["lf"][1], 0)),
        ((front, near, 0), (front, near, base[2])),
    )
    for (start, end), (across, along) in zip(ends, (("right", "top"), ("left", "top"), ("left", "center"))):
        line = np.array([start, end])
        axes.plot(*line.T, color=style.GREEN, lw=1.4, marker="o", ms=3, zorder=7)
        length = f" {100 * np.linalg.norm(line[1] - line[0]):.0f} cm "
        axes.text(*line.mean(axis=0), length, color=style.GREEN, zorder=8, ha=across, va=along, fontsize=11)
    text = f"{motion.scene.weight / GRAVITY:.1f} kg; from hip to hip, and the height of the base"
    _caption(figure, 0.0, "HyQ, nominal configuration", text)
    _save(figure, out, "fig_03_hyq", "HyQ, nominal configuration")
