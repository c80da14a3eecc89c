"""Pictures of the how-tos."""

import matplotlib.pyplot as plt
import numpy as np

from plans import Table
from skeleton import Skeleton, draw, pose
from style import GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

FEET = ["lf_foot", "lh_foot", "rf_foot", "rh_foot"]


def _side_view(plan, moments, ground) -> plt.Figure:
    """The robot at some moments, its left side in colour, paths of base and feet, and the ground as a line in (x, z)."""
    robot = Skeleton(plan.json["urdf"]["text"])
    times = plan.trajectory["time_s"]
    figure, axes = plt.subplots(figsize=(7.6, 3.8))
    for line in ground:
        axes.plot(*zip(*line), color=GREY, linewidth=3, solid_capstyle="butt")
    poses = [pose(plan.trajectory, k) for k in range(0, len(times), 4)]
    for foot, colour in zip(FEET, (VERMILLION, ORANGE, PURPLE, GREEN)):
        path = np.array([robot.points(foot, *where)[0][-1] for where in poses])
        axes.plot(path[:, 0], path[:, 2], color=colour, linewidth=1.2, label=foot)
    for k, moment in enumerate(moments):
        row = int(np.argmin(abs(times - moment)))
        last = k == len(moments) - 1
        draw(axes, robot, FEET[2:], *pose(plan.trajectory, row), [GREY] * 2, linewidth=1.5, alpha=0.8 if last else 0.3)
        draw(
            axes,
            robot,
            FEET[:2],
            *pose(plan.trajectory, row),
            [SKY if last else GREY] * 2,
            linewidth=2.4,
            alpha=1 if last else 0.45,
        )
    axes.set_aspect("equal")
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0, 1),
        title="paths of",
        alignment="left",
        ncols=4,
        fontsize=9,
        handlelength=1.2,
    )
    axes.set(xlabel="x [m]", ylabel="z [m]")
    return figure


def slope(planner) -> plt.Figure:
    plan = planner.plan_shown("slope.md", "mine/ramp.toml", "--no-gains")
    tilt = np.tan(np.radians(10))
    return _side_view(plan, (0, plan.trajectory["time_s"][-1]), [[(-0.7, -0.7 * tilt), (0.9, 0.9 * tilt)]])


def wall(planner) -> plt.Figure:
    plan = planner.plan_shown("wall.md", "mine/wall.toml", "--no-gains")
    return _side_view(plan, (0, plan.trajectory["time_s"][-1]), [[(-0.7, 0), (0.75, 0)], [(0.75, 0), (0.75, 0.8)]])


def gains(planner) -> plt.Figure:
    """HyQ's crouch from a base 2 cm forward and 1 cm up, in its own dynamics, with the gains and without."""
    plan = planner.plan("hyq/crouch")
    figure, axes = plt.subplots(figsize=(7.6, 3.0))
    for label, options, colour in (
        ("planned torques and gains", [], GREEN),
        ("planned torques alone", ["--open-loop"], VERMILLION),
    ):
        planner.run(
            "simulate",
            plan.folder,
            "--engine",
            "rollout",
            "--base-offset-m",
            "0.02",
            "0",
            "0.01",
            *options,
            allowed=(0, 8),
        )
        table = Table(plan.folder / "simulate.csv")
        names = ["base_px_m", "base_py_m", "base_pz_m"]
        error = np.linalg.norm(
            table.columns(*("true_" + n for n in names)) - table.columns(*("ref_" + n for n in names)), axis=1
        )
        axes.plot(table["time_s"], 100 * error, color=colour, label=label)
    axes.set(xlabel="time [s]", ylabel="base off the plan [cm]", ylim=(0, 12), xlim=(0, 2.5))
    axes.legend(loc="upper right")
    return figure
