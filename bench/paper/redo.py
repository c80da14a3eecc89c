"""scripts/paper from the plans to the page."""

import pathlib

import comparisons
import figures
import motions
import page
import stills
import style
import tables
from plans import Planner


def everything(out: pathlib.Path, title: str, prowl: pathlib.Path, packages: list[str], solvers: str, workers) -> None:
    work = out / "work"
    planner = Planner(prowl, work, packages)
    print("planning and simulating tasks/paper", flush=True)
    made = motions.make_motions(planner, workers)
    print("comparing with the paper's own formulation", flush=True)
    runs = comparisons.papers_formulation(planner, work, solvers, workers)
    shown = {
        "counts": tables.counts(comparisons.sizes_of_a_node(planner, work)),
        "plans": tables.plans(made),
        "simulations": tables.simulations(made),
        "formulations": tables.formulations(runs),
    }
    print("drawing", flush=True)
    draw(made, planner, out, workers)
    names = {"counts": "table_1"}  # the paper's
    for name, table in shown.items():
        tables.write(table, out / f"{names.get(name, name)}.csv")
    page.write(out, title, made["stand"].coarse.json["versions"]["prowl"], **shown)


def draw(made: dict[str, motions.Motion], planner: Planner, out: pathlib.Path, workers) -> None:
    gains = workers.submit(figures.model_tables, planner, made["crouch"], "--joint", figures.GAINS_OF)
    model = workers.submit(figures.model_tables, planner, made["stand"])
    style.use()
    figures.draw_phases(made["step"], out)
    figures.draw_standing_torques(made["stand"], out)
    figures.draw_simulation(made["stand"], out, "fig_07_standing")
    figures.draw_simulation(made["crouch"], out, "fig_08_crouching")
    stills.draw_robot(made["crouch"], out)
    stills.draw_stills(made, out)
    figures.draw_knee_limit(made, model.result(), out)
    figures.draw_contact_acceleration(made["stand"], model.result(), out)
    figures.take_gains(gains.result(), out)
