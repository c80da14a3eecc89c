"""Plan.plot(): a plan and its simulation in one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .. import _prowl
from .._extras import needs

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def plot(plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> Figure:
    """Four axes over time: base position, vertical contact forces, torques of the most loaded joints, largest
    share of the torque limits. Plan: lines; simulation: dashes of the same colours."""
    with needs("figures"):
        import matplotlib.pyplot as plt
    from .._figures import style

    with plt.rc_context():
        style.use()
        figure, grid = plt.subplots(2, 2, sharex=True, figsize=(10, 5.6), layout="constrained")
        _draw_base(grid[0, 0], plan, simulation)
        _draw_forces(grid[0, 1], plan, simulation)
        _draw_torques(grid[1, 0], plan, simulation)
        _draw_shares(grid[1, 1], plan, simulation)
        for axes in grid[1]:
            axes.set_xlabel("time [s]")
        for axes in grid.flat:
            _shade_phases(axes, plan)
        figure.suptitle(_title(plan), x=0.01, ha="left", fontweight="bold")
    if "inline" in plt.get_backend():  # close it: the notebook shows the returned figure
        plt.close(figure)
    return figure


def _title(plan: _prowl.Plan) -> str:
    grade = f"certificate: {plan.certificate.grade}"
    return f"{plan.robot.name}, {plan.task.name}: {plan.status.replace('_', ' ')}, {grade}"


def _legend(axes: Axes, columns: int = 4) -> None:
    axes.legend(ncols=columns, loc="lower left", bbox_to_anchor=(-0.01, 0.99), fontsize=7.5, handlelength=1.4)


def _draw_base(axes: Axes, plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> None:
    from .._figures import style

    axes.set_ylabel("base position [m]")
    for i, (axis, colour) in enumerate(zip("xyz", style.AXIS_COLOURS)):
        axes.plot(plan.t, plan.q[:, i], color=colour, label=axis)
        if simulation is not None:
            axes.plot(simulation.t, simulation.q[:, i], color=colour, ls="--", lw=0.9)
    if simulation is not None:
        axes.plot([], [], color="0.4", ls="--", lw=0.9, label="simulated")
    _legend(axes)


def _draw_forces(axes: Axes, plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> None:
    from .._figures import style

    axes.set_ylabel("vertical contact force [N]")
    for c, name in enumerate(plan.robot.contact_names):
        colour = style.LEG_COLOURS[c % len(style.LEG_COLOURS)]
        axes.plot(plan.t, plan.f[:, c, 2], color=colour, label=name)
        if simulation is not None:
            axes.plot(simulation.t, simulation.f[:, c, 2], color=colour, lw=0.5, alpha=0.6)
    _legend(axes)


def _limits(plan: _prowl.Plan, q: np.ndarray, v: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Limit of each torque in its direction, (rows, nu), >= 0."""
    lower, upper = plan.robot.torque_limits(q, v)
    return np.where(tau < 0, -lower, upper)


def _shares(plan: _prowl.Plan, q: np.ndarray, v: np.ndarray, tau: np.ndarray) -> np.ndarray:
    """Used share of each torque limit."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.nan_to_num(np.abs(tau) / _limits(plan, q, v, tau), nan=0.0, posinf=np.inf)


def _draw_torques(axes: Axes, plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> None:
    from .._figures import style

    axes.set_ylabel("torque [N m]")
    hardest = np.argsort(-_shares(plan, plan.q, plan.v, plan.tau).max(axis=0), kind="stable")[:4]
    for j, colour in zip(hardest, style.LEG_COLOURS):
        axes.plot(plan.t, plan.tau[:, j], color=colour, label=plan.robot.joint_names[j])
        if simulation is not None:
            axes.plot(simulation.t, simulation.tau[:, j], color=colour, ls="--", lw=0.9)
    _legend(axes)


def _draw_shares(axes: Axes, plan: _prowl.Plan, simulation: _prowl.Simulation | None) -> None:
    from .._figures import style

    axes.set_ylabel("torque, share of limit [%]")
    axes.plot(plan.t, 100 * _shares(plan, plan.q, plan.v, plan.tau).max(axis=1), color=style.BLUE, label="worst joint")
    if simulation is not None:
        shares = _shares(plan, simulation.q, simulation.v, simulation.tau).max(axis=1)
        axes.plot(simulation.t, 100 * shares, color=style.BLUE, ls="--", lw=0.9, label="simulated")
    axes.axhline(100, color="black", lw=0.9, ls=style.DASHES[2], label="limit")
    axes.set_ylim(bottom=0)
    _legend(axes)


def _shade_phases(axes: Axes, plan: _prowl.Plan) -> None:
    """Every other phase is grey."""
    for p in range(1, len(plan.task.phases), 2):
        times = plan.t[plan.phase == p]
        if times.size:
            axes.axvspan(times[0], times[-1], color="0.95", lw=0, zorder=0)
    axes.margins(x=0)
