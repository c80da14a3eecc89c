"""What the judge found of everybody's motions of the same tasks, as a table in Markdown. Standard library only."""

import collections

from load.quantiles import quantiles

LABELS = {"prowl": "Prowl", "boxfddp": "BoxFDDP", "intro": "Intro", "sqp": "SQP", "csqp": "CSQP"}
# Re-integration error of an interval: that of grade draft (docs/verification.md), and ten and a hundred times as much.
ERRORS = [5e-4, 5e-3, 5e-2]


def label(solver: str) -> str:
    name, _, step = solver.partition(":")
    return f"{LABELS[name]}, {1e3 * float(step):g} ms" if step else LABELS[name]


def keeps(record: dict) -> bool:
    """All that the judge looks at but the integration error."""
    return record.get("keeps_task", False)


def share(found: list[bool]) -> str:
    return f"{sum(found)} ({100.0 * sum(found) / max(1, len(found)):.0f} %)"


def times(seconds: list[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in quantiles(seconds)) or "-"


def median(values: list[float], form: str) -> str:
    return form.format(quantiles(values)[0]) if values else "-"


def failures(records: list[dict]) -> str:
    """Of each motion that does not keep its task the check that is farthest beyond its limit."""
    worst = collections.Counter(r["failed"] if "failed" in r else r["worst"]["check"] for r in records if not keeps(r))
    return ", ".join(f"{name} {count}" for name, count in worst.most_common(4)) or "-"


def table(records: list[dict]) -> str:
    """One column a solver."""
    names = list(records[0]["solvers"])
    columns = [[record["solvers"][name] for record in records] for name in names]
    proven = [i for i, record in enumerate(records) if record["solvers"]["prowl"].get("good")]

    rows = [("", *map(label, names)), ("---", *["---:"] * len(names))]

    def add(title: str, cell) -> None:
        rows.append((title, *map(cell, columns)))

    add("says that it converged", lambda column: share([r.get("converged", False) for r in column]))
    add("keeps its task", lambda column: share([keeps(r) for r in column]))
    add("... of those that Prowl's certificate passes", lambda column: share([keeps(column[i]) for i in proven]))
    for error in ERRORS:
        add(
            f"keeps it, error of an interval ≤ {error:g}",
            lambda column, error=error: share([keeps(r) and r["error"] <= error for r in column]),
        )
    add("error of an interval, median", lambda column: median([r["error"] for r in column if "error" in r], "{:.1e}"))
    add("iterations, median", lambda column: median([r["iterations"] for r in column if "iterations" in r], "{:.0f}"))
    add("CPU time where it keeps its task [s]", lambda column: times([r["seconds"] for r in column if keeps(r)]))
    add(
        "CPU time where not [s]",
        lambda column: times([r["seconds"] for r in column if not keeps(r) and "seconds" in r]),
    )
    add("breaks most", failures)
    return "\n".join("| " + " | ".join(row) + " |" for row in rows)


def pairs(records: list[dict]) -> str:
    """Prowl against each peer: who kept which tasks, and times on those that both kept."""
    lines = []
    for name in [name for name in records[0]["solvers"] if name != "prowl"]:
        both = [(record["solvers"]["prowl"], record["solvers"][name]) for record in records]
        kept = collections.Counter((keeps(ours), keeps(theirs)) for ours, theirs in both)
        ratios = [ours["seconds"] / theirs["seconds"] for ours, theirs in both if keeps(ours) and keeps(theirs)]
        lines.append(
            f"Prowl and {label(name)}: both keep {kept[True, True]}, Prowl alone {kept[True, False]}, {label(name)} alone "
            f"{kept[False, True]}, none {kept[False, False]}; Prowl's CPU time over its where both do: {times(ratios)}"
        )
    return "\n".join(lines)


def whole_calls(records: list[dict]) -> str:
    ours = [record["solvers"]["prowl"] for record in records]
    return f"CPU time of Prowl with proofs before, certificate and hints after the solve [s]: {times([r['call_seconds'] for r in ours])}"
