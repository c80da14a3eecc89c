"""Pictures of docs/concepts.md."""

import matplotlib.pyplot as plt
import numpy as np
from scipy.spatial.transform import Rotation

from skeleton import Skeleton, draw, pose
from style import GREEN, GREY, ORANGE, PURPLE, SKY, VERMILLION

LEGS = ["lf", "lh", "rf", "rh"]
FEET = [f"{leg}_foot" for leg in LEGS]


def projection(planner) -> plt.Figure:
    """A velocity that takes the feet off their places, and what P leaves of it: where both carry HyQ in a tenth of a second."""
    plan = planner.plan("hyq/crouch", "--no-gains")
    robot = Skeleton(plan.json["urdf"]["text"])
    start = pose(plan.trajectory, 0)
    wanted = np.zeros(6 + len(robot.names))
    for k, name in enumerate(robot.names):
        if "kfe" in name:
            wanted[6 + k] = 4.0 * np.sign(start[1][name])  # knees bend, nothing else moves [rad/s]
    figure, panels = plt.subplots(1, 2, figsize=(7.6, 3.1), sharey=True)
    for axes, title, allow in zip(
        panels,
        ("v: the knees bend, nothing else moves", "P v: what the contacts allow of it"),
        (lambda J, v: v, lambda J, v: v - np.linalg.pinv(J) @ (J @ v)),
    ):
        first = robot.jacobian(FEET, *start)
        rates = (first @ allow(first, wanted)).reshape(-1, 3)
        axes.axhline(0, color=GREY, linewidth=1)
        draw(axes, robot, FEET[:2], *start, [GREY] * 2, linewidth=2, alpha=0.55)
        draw(axes, robot, FEET[:2], *_after(robot, start, wanted, allow), [SKY] * 2, linewidth=2.4)
        for foot, rate in zip(FEET[:2], rates):
            at = robot.points(foot, *start)[0][-1]
            if np.linalg.norm(rate) > 1e-6:
                axes.annotate(
                    "",
                    (at + 0.1 * rate)[[0, 2]],
                    at[[0, 2]],
                    arrowprops={"arrowstyle": "-|>", "color": VERMILLION, "linewidth": 2},
                )
        axes.set_title(f"{title}\nfeet at {max(np.linalg.norm(rates, axis=1)):.2f} m/s")
        axes.set_aspect("equal")
        axes.set_axis_off()
    return figure


def _after(robot: Skeleton, start, v, allow, duration: float = 0.1, steps: int = 50):
    (place, turn), angles = start[0], dict(start[1])
    for _ in range(steps):
        dq = allow(robot.jacobian(FEET, (place, turn), angles), v) * duration / steps
        place, turn = place + dq[:3], Rotation.from_rotvec(dq[3:6]) * turn
        angles = {name: angles[name] + dq[6 + k] for k, name in enumerate(robot.names)}
    return (place, turn), angles


def phases(planner) -> plt.Figure:
    """Who stands when, and with which force: HyQ's trot."""
    plan = planner.plan("hyq/trot", "--no-gains")
    table, times = plan.trajectory, plan.trajectory["time_s"]
    switches = np.flatnonzero(np.diff(table["phase"]))
    shown = np.union1d(np.arange(0, len(times), 4), [*switches, *(switches + 1), len(times) - 1])
    figure, panels = plt.subplots(5, 1, figsize=(7.6, 4.6), sharex=True, height_ratios=[1.6, 1, 1, 1, 1])
    for k, name in enumerate(FEET):
        standing = table[f"contact_{name}"] > 0.5
        for phase in np.unique(table["phase"]):
            span = times[(table["phase"] == phase) & standing]
            if len(span):
                panels[0].broken_barh(
                    [(span[0], span[-1] - span[0])], (-k - 0.38, 0.76), color=[SKY, ORANGE, PURPLE, GREEN][k]
                )
        force = table[f"f_{name}_z_N"]
        panels[1 + k].fill_between(
            times[shown], force[shown], color=[SKY, ORANGE, PURPLE, GREEN][k], alpha=0.6, linewidth=0
        )
        panels[1 + k].set_ylabel(f"{name[:2]} [N]", rotation=0, ha="right", va="center")
        panels[1 + k].set_ylim(0, 800)
        panels[1 + k].set_yticks([0, 800])
    panels[0].set_yticks(-np.arange(4), FEET)
    panels[0].set_title("contacts of each phase (above), planned normal force of each foot (below)")
    for axes in panels:
        for time in times[switches]:
            axes.axvline(time, color=GREY, linewidth=0.8, linestyle=(0, (2, 2)))
        axes.set_xlim(times[0], times[-1])
    panels[-1].set_xlabel("time [s]")
    return figure


def mesh(planner) -> plt.Figure:
    """Integration error of each interval of HyQ's crouch on three meshes, and the limits of both grades."""
    figure, axes = plt.subplots(figsize=(7.6, 3.2))
    for intervals, colour in ((40, VERMILLION), (80, SKY), (344, GREEN)):
        plan = planner.plan("hyq/crouch", "--no-gains", "--intervals", str(intervals), good=False)
        certificate = plan.json["certificate"]
        errors = certificate["integration_errors"]
        axes.stairs(
            [entry["error"] for entry in errors],
            [errors[0]["start_s"], *(entry["end_s"] for entry in errors)],
            color=colour,
            baseline=None,
            linewidth=1.6,
            label=f"{intervals} intervals: {certificate['grade']}",
        )
    for limit, name in ((1e-4, "limit: draft"), (1e-6, "limit: certified")):
        axes.axhline(limit, color=GREY, linewidth=1, linestyle=(0, (4, 2)))
        axes.text(2.02, limit, name, va="center")
    axes.set(
        yscale="log",
        xlim=(0, 2),
        ylim=(3e-8, 2e-3),
        xlabel="time [s]",
        title="local integration error of each mesh interval",
    )
    axes.legend(loc="upper center", ncols=3, handlelength=1.2)
    return figure


def margins(planner) -> plt.Figure:
    """How much of its limit each check of HyQ's crouch uses, of those that use a thousandth."""
    checks = planner.plan("hyq/crouch", "--no-gains").json["certificate"]["checks"]
    shares = {check["name"]: check["worst"] / check["limit"] for check in checks if check["limit"] > 0}
    shares = {name: max(share, 0.0) for name, share in shares.items()}
    names = sorted((name for name in shares if shares[name] > 1e-3), key=shares.get)
    figure, axes = plt.subplots(figsize=(7.6, 0.27 * len(names) + 0.7))
    axes.barh(names, [shares[name] for name in names], color=SKY, height=0.65)
    axes.axvline(1, color=VERMILLION, linewidth=1.6)
    axes.set(xlim=(0, 1.05), xlabel="worst moment, as a share of the limit of grade draft")
    axes.tick_params(axis="y", length=0)
    return figure
