"""The paper's table, with Prowl's own counts beside it, and what came of the motions. A table is a list of rows by column."""

import csv
import pathlib

from motions import Motion

Table = list[dict[str, object]]

# Table I of the paper: variables and constraints of a node, four feet on the ground, by form of the dynamics.
PAPERS_COUNTS = {"centroidal": ("centroidal dynamics", 76, 63), "forward": ("projection", 49, 48)}
# What Prowl's counts are off by, and why: variables, constraints, reason.
REASONS = {
    "centroidal": ((-1, 0, "no step, its phase has a fixed duration"), (0, 4, "friction is a row of each foot")),
    "forward": (
        (-1, 0, "no step, its phase has a fixed duration"),
        (0, 4, "the knees' torques have a limit both ways, the paper's one way"),
    ),
}
# The forms of the dynamics that the paper does not have.
OTHERS = {
    "inverse": "projection, inverse form: `prowl plan`",
    "kkt": "no projection: accelerations and forces are variables",
}


def _reason(form: str, variables: int, constraints: int) -> str:
    """Ends the script if the difference is not what the reasons add up to."""
    _, papers_variables, papers_constraints = PAPERS_COUNTS[form]
    off = (variables - papers_variables, constraints - papers_constraints)
    explained = tuple(sum(column) for column in list(zip(*REASONS[form]))[:2])
    if off != explained:
        raise SystemExit(f"paper: {form}: off from table I by {off}, of which {explained} is explained")
    return "; ".join(f"{text} ({a + b:+d})" for a, b, text in REASONS[form])


def counts(sizes: dict[str, tuple[int, int]]) -> Table:
    """Table I."""
    rows = []
    for form, (method, *papers) in PAPERS_COUNTS.items():
        values = (*papers, *sizes[form], _reason(form, *sizes[form]))
        rows.append(dict(zip(("method", *COUNT_COLUMNS), (method, *values))))
    for form, method in OTHERS.items():
        rows.append(dict(zip(("method", *COUNT_COLUMNS), (method, "", "", *sizes[form], "not in the paper"))))
    return rows


COUNT_COLUMNS = ("paper: variables", "paper: constraints", "Prowl: variables", "Prowl: constraints", "why")


def plans(motions: dict[str, Motion]) -> Table:
    """What prowl plan found: on the meshes of the task files, and on those that pass the certificate."""
    rows = []
    for name, motion in motions.items():
        for mesh, plan in (("task file", motion.coarse), ("--refine", motion.fine)):
            levels = plan.json["solver"]["levels"]
            rows.append(
                {
                    "motion": name,
                    "mesh": mesh,
                    "nodes": len(plan.trajectory["time_s"]),
                    "variables": plan.json["problem"]["variables"],
                    "constraints": plan.json["problem"]["constraints"],
                    "status": plan.json["status"],
                    "iterations": " + ".join(str(level["iterations"]) for level in levels),
                    "CPU [s]": f"{plan.json['solver']['cpu_seconds']:.2f}",
                    "cost": f"{plan.json['solver']['cost']:.4g}",
                    "duration [s]": f"{plan.trajectory['time_s'][-1]:.2f}",
                    "certificate": plan.json["certificate"]["grade"],
                    "worst check": _worst_check(plan.json["certificate"]),
                }
            )
    return rows


def _worst_check(certificate: dict) -> str:
    share, name = max(
        (check["worst"] / check["limit"], check["name"]) for check in certificate["checks"] if check["limit"]
    )
    return f"{name}, {share:.0f} times its limit" if share > 2 else f"{name}, {share:.2f} of its limit"


def simulations(motions: dict[str, Motion]) -> Table:
    """What the tracked motions did, in their own dynamics and in MuJoCo."""
    return [
        {
            "motion": name,
            "engine": {"rollout": "projected dynamics", "mujoco": "MuJoCo, noise and estimator"}[run["engine"]],
            "result": "success" if run["success"] else "; ".join(run["failures"]),
            "largest base error [mm]": f"{1e3 * run['base_position_m']['largest']:.2g}",
            "in rest [mm]": f"{1e3 * run['base_position_m']['rest']:.2g}" if run["success"] else "",
            "torque [of limit]": f"{run['torque']['largest_share']:.2f}",
        }
        for name, motion in motions.items()
        for run in (motion.rollout, motion.simulation)
    ]


def formulations(runs: list[dict]) -> Table:
    """The paper's own formulation of each motion. A run that was not made has empty cells."""

    def shown(value: float | None, form: str, scale: float = 1) -> str:
        return "" if value is None else format(scale * value, form)

    return [
        {
            "motion": run["task"],
            "feet": {"distance": "on the ground", "distance-5mm": "within 5 mm of it"}[run["contact"]],
            "solver": run["solver"],
            "variables": shown(run["variables"], "d"),
            "constraints": shown(run["constraints"], "d"),
            "status": run["status"],
            "iterations": shown(run["iterations"], "d"),
            "CPU [s]": shown(run["cpu_seconds"], ".2f"),
            "cost": shown(run["cost"], ".4g"),
            "drift of feet [mm]": shown(run["contact_drift_m"], ".2g", 1e3),
            "certificate": run["grade"] or "",
        }
        for run in runs
    ]


def write(table: Table, path: pathlib.Path) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, list(table[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(table)


def markdown(table: Table) -> str:
    lines = [list(table[0]), ["---"] * len(table[0]), *(map(str, row.values()) for row in table)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)
