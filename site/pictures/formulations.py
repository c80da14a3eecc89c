"""Pictures of docs/formulations.md."""

import csv

import matplotlib.pyplot as plt
import numpy as np

from style import GREY, ORANGE, SKY, VERMILLION

RULES = {"trapezoid": (2, VERMILLION), "hermite-simpson": (4, SKY), "rk4": (4, ORANGE)}  # order, colour


def orders(planner) -> plt.Figure:
    """Error at the end of a motion by given torques over the step."""
    rows = list(csv.DictReader(planner.output_of("bench/orders").splitlines()))
    figure, panels = plt.subplots(1, 2, figsize=(7.6, 3.2), sharey=True)
    for axes, state, title in zip(panels, "qv", ("q: position [m, rad]", "v: velocity [m/s, rad/s]")):
        for rule, (order, colour) in RULES.items():
            steps = np.array([float(row["step_s"]) for row in rows if row["rule"] == rule])
            errors = np.array([float(row[state]) for row in rows if row["rule"] == rule])
            slope = np.polyfit(np.log(steps[1:]), np.log(errors[1:]), 1)[0]  # the longest step is not small
            axes.loglog(steps, errors, "o-", color=colour, label=f"{rule}: {slope:.1f}")
            axes.loglog(steps, errors[-1] * (steps / steps[-1]) ** order, "--", color=GREY, linewidth=1, zorder=0)
        axes.set_xticks(steps, [f"{step:g}" for step in steps])
        axes.minorticks_off()
        axes.set_ylim(1e-10, 1.0)  # the legend is below the curves
        axes.set_xlabel("step [s]")
        axes.set_title(title)
        axes.grid(True, which="major")
        axes.legend(title="slope", loc="lower right")
    return figure
