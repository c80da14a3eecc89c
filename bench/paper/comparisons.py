"""The paper's own formulation, and the sizes of all: what `prowl compare` says of tasks/paper."""

import json
import pathlib

from motions import SUBJECTS
from plans import ROOT, Planner

# Forward dynamics in the defects of the trapezoid, distances of the feet at the nodes, Euler angles, no guess to speak of.
PAPERS = ("--formulation", "forward", "--contact", "distance,distance-5mm", "--orientation", "euler")
AS_IN_THE_PAPER = (*PAPERS, "--guess", "straight", "--tolerance", "1e-5")


def _compare(planner: Planner, folder: pathlib.Path, task: str, *options: str) -> list[dict]:
    planner.run("compare", ROOT / "tasks/paper" / f"{task}.toml", *options, "--out", folder)
    return json.loads((folder / "compare.json").read_text(encoding="utf-8"))["runs"]


def papers_formulation(planner: Planner, folder: pathlib.Path, solvers: str, workers) -> list[dict]:
    """Each motion in the paper's formulation, a row of prowl compare each."""
    runs = workers.map(
        lambda s: _compare(planner, folder / f"{s.name}_compare", s.name, *AS_IN_THE_PAPER, "--solver", solvers),
        SUBJECTS,
    )
    return [run for of_task in runs for run in of_task]


def sizes_of_a_node(planner: Planner, folder: pathlib.Path) -> dict[str, tuple[int, int]]:
    """Variables and constraints of one node, by form of the dynamics: what standing has more with seven nodes than with six."""
    sizes = {}
    for contact, dynamics in (("distance", "forward"), ("stabilised", "inverse,kkt,centroidal")):
        for intervals in (5, 6):
            options = ("--formulation", dynamics, "--contact", contact, "--solver", "ipopt")
            limits = ("--intervals", str(intervals), "--max-iterations", "1")  # nobody looks at the motion
            for run in _compare(planner, folder / f"sizes_{contact}_{intervals}", "stand", *options, *limits):
                sizes.setdefault(run["dynamics"], {})[intervals] = (run["variables"], run["constraints"])
    return {name: tuple(b - a for a, b in zip(size[5], size[6])) for name, size in sizes.items()}
