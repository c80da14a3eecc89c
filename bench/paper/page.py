"""out/paper/index.md: all figures and tables on one page, with what the paper shows, and the list of differences of docs/paper.md."""

import os
import pathlib
import re

import tables
from plans import ROOT

DIFFERENCES = ROOT / "docs/paper.md"

# Name of the picture: heading, what the paper's figure shows, what this one shows.
FIGURES = {
    "fig_01_knee_torque_limit": (
        "Figure 1: torque limit of the knee",
        "the largest torque of HyQ's knee over its angle, a path constraint.",
        "the limit of `robots/hyq.toml`, and below it the four knees in all five motions.",
    ),
    "fig_02_phases": (
        "Figure 2: phases",
        "a drawing of phases and nodes. The last node of a phase satisfies the dynamics of the next phase, too.",
        "the step on the mesh of its task file. Each switch has two nodes, one for the dynamics of each phase.",
    ),
    "fig_03_hyq": (
        "Figure 3: HyQ",
        "the URDF in its nominal configuration, 80 cm x 40 cm x 60 cm. The text has 80 cm x 50 cm and about 80 kg.",
        "the start of the crouch, with lengths from the plan.",
    ),
    "fig_04_gains": (
        "Figure 4: gains",
        "the 36 gains of the left hind knee in the crouch, by time-varying LQR.",
        "the same gains, a panel for each kind of deviation.",
    ),
    "fig_05_standing_torques": (
        "Figure 5: torques of standing",
        "the output of the optimisation for N = 6 nodes and T = 2 s, a panel for each leg, in these colours and marks.",
        "the same. The robot starts beside its nominal posture, so that the torques change.",
    ),
    "fig_06_contact_acceleration": (
        "Figure 6: accelerations of the contacts",
        "the two terms of the acceleration of each foot at the nodes of standing. They cancel.",
        "the same. The sum is small and not zero, since the accelerations pull the feet back to their places.",
    ),
    "fig_07_standing": (
        "Figure 7: simulation of standing",
        "errors of base and joints, and torques, in SL.",
        "the same in MuJoCo. The simulated plan has more than six nodes: only a plan that passes the certificate gets gains.",
    ),
    "fig_08_crouching": (
        "Figure 8: simulation of crouching",
        "the same as figure 7, with another nominal height and its cost.",
        "the same. The base stops above its nominal height, because torques, rates and joint angles cost, too.",
    ),
    "fig_09_balancing": (
        "Figure 9: balancing",
        "a picture from SL, at the end of the intermediate phase.",
        "the middle of that phase, where the feet are highest. Orange arrows are contact forces, blue lines the ways of the feet.",
    ),
    "fig_10_stepping": (
        "Figure 10: stepping",
        "a picture from SL, at the end of the intermediate phase.",
        "the middle of that phase.",
    ),
    "fig_11_rearing": (
        "Figure 11: rearing",
        "a picture from SL, at the end of the intermediate phase.",
        "the middle of that phase, where the task file asks for the pitch.",
    ),
    "fig_12_multiphase_motions": (
        "Figure 12: all motions of more than one phase",
        "figures 9 to 11 side by side.",
        "the same.",
    ),
    "still_standing": ("Standing, at its end", "no such figure.", "what the cost leaves of the displaced start."),
    "still_crouching": ("Crouching, at its end", "no such figure.", "the height that the cost reaches."),
}

HEAD = """{title}

Figures and table of Pardo, Neunert, Winkler, Buchli, *Projection based whole body motion planning for legged robots*, IEEE
Robotics and Automation Letters, 2016. `scripts/paper` made them from the task files in `tasks/paper`, with Prowl {version}.

## Table I: variables and constraints of a node, one phase, four feet

Prowl's counts are those by which the program of standing grows from six nodes to seven.

{counts}
## The motions

`prowl plan` on the mesh of the task file, and with `--refine`, which refines the mesh until the certificate passes. The paper
says "few minutes of processing in a common laptop" of all motions. It names the number of nodes for standing only.

{plans}
{findings}

The simulated plans are those of `--refine`:

{simulations}
The paper's own formulation of the same tasks: forward dynamics in the defects of the trapezoid, Euler angles, distances of the feet
at the nodes, a guess of straight lines. The paper solved it with SNOPT.

{formulations}
## Figures
"""


def _findings(plans: tables.Table) -> str:
    failed = [row["motion"] for row in plans if row["certificate"] == "failed"]
    if not failed:
        return "All plans pass the certificate."
    return (
        f"The certificate fails {len(failed)} of {len(plans)} plans. Their nodes solve the program, the motion between them does "
        "not solve the dynamics."
    )


def differences(folder: pathlib.Path) -> str:
    """The section of docs/paper.md, with links that lead from `folder`."""
    text = DIFFERENCES.read_text(encoding="utf-8")
    section = re.search(r"^## Differences\n.*?(?=^## )", text, re.MULTILINE | re.DOTALL)[0]
    docs = os.path.relpath(DIFFERENCES.parent, folder.resolve())
    return re.sub(r"\]\((?!https?:|#)", f"]({docs}/", section)


def write(folder: pathlib.Path, title: str, version: str, **all_tables: tables.Table) -> None:
    shown = {name: tables.markdown(table) for name, table in all_tables.items()}
    text = HEAD.format(title=title, version=version, findings=_findings(all_tables["plans"]), **shown)
    for name, (heading, papers, ours) in FIGURES.items():
        text += f"\n### {heading}\n\n![{heading}]({name}.png)\n\nPaper: {papers} Here: {ours} [SVG]({name}.svg)\n"
    text += f"\n{differences(folder)}"
    (folder / "index.md").write_text(text.rstrip() + "\n", encoding="utf-8")
