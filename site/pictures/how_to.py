"""Pictures of the how-tos."""

import matplotlib.pyplot as plt
import numpy as np

from plans import Table
from style import GREEN, VERMILLION


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
