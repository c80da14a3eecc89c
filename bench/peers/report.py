"""Records as Markdown tables; the columns are explained in bench/README.md."""

import pathlib
from collections.abc import Callable, Iterable

Column = tuple[str, Callable[[dict], str]]


def number(value: float, digits: int = 3) -> str:
    """So many digits, as a plain number where that is short."""
    if value == 0:
        return "0"
    if 1e-3 <= abs(value) < 1e5:
        text = f"{value:.{digits}g}"
        return text if "e" not in text else f"{value:.0f}"
    return f"{value:.{max(0, digits - 2)}e}"


def mesh(record: dict) -> str:
    return f"{record['intervals']}"


def iterations(record: dict) -> str:
    meshes = record.get("iterations_by_mesh", [])
    text = (
        " + ".join(map(str, meshes))
        if len(meshes) > 1 and sum(meshes) == record["iterations"]
        else str(record["iterations"])
    )
    return text if record["converged"] else f"{text}, not converged"


def clock(record: dict) -> str:
    mark = "" if record["clock"] == "cpu" else "*"
    spread = (
        f" [{number(1e3 * record['seconds_min'])}, {number(1e3 * record['seconds_max'])}]"
        if record["repetitions"] > 1
        else ""
    )
    return f"{number(1e3 * record['seconds'])}{mark}{spread}"


def wall_clock(record: dict) -> str:
    return (
        f"{number(1e3 * record['wall_seconds'])} [{number(1e3 * record['wall_seconds_min'])}, "
        f"{number(1e3 * record['wall_seconds_max'])}]"
    )


def worst(record: dict) -> str:
    found = record["worst"]
    if record["keeps_task"]:
        return "none"
    return f"{found['check']} {number(found['value'], 2)} {found['unit']}"


def split(record: dict) -> str:
    parts = record.get("split_s", {})
    return ", ".join(f"{name.replace('_', ' ')} {number(1e3 * value)}" for name, value in parts.items())


TASK: list[Column] = [
    ("solver", lambda r: r["label"] + (" (joints bounded)" if r.get("joint_bounds") else "")),
    ("intervals", mesh),
    ("iterations", iterations),
    ("CPU time [ms]", clock),
    ("time per node and iteration [us]", lambda r: number(r["us_per_node_iteration"])),
    ("of the motion's duration", lambda r: number(r["ratio_to_motion"])),
    ("error of an interval", lambda r: number(r["error"])),
    ("error in a second", lambda r: number(r["error_per_second"])),
    ("cost", lambda r: number(r["cost"], 4)),
    ("worst violation", worst),
]
MATCH: list[Column] = [
    ("task", lambda r: r["task"]),
    ("solver", lambda r: r["label"]),
    ("intervals", mesh),
    ("iterations", iterations),
    ("CPU time [ms]", clock),
    ("of BoxFDDP's", lambda r: r["to_boxfddp"]),
    ("of SQP's", lambda r: r["to_sqp"]),
    ("of the motion's duration", lambda r: number(r["ratio_to_motion"])),
    ("error of an interval: Prowl, BoxFDDP", lambda r: f"{number(r['error'])}, {r['box_error']}"),
    ("error in a second: Prowl, BoxFDDP", lambda r: f"{number(r['error_per_second'])}, {r['box_error_per_second']}"),
    ("for the error in a second alone", lambda r: r["by_second_alone"]),
    ("worst violation", worst),
    ("spent on [ms]", split),
]
GROWTH: list[Column] = [
    ("intervals", mesh),
    ("solver", lambda r: r["label"] + (" (after coarser meshes)" if r.get("after_coarser_meshes") else "")),
    ("iterations", iterations),
    ("CPU time [ms]", clock),
    ("time per node and iteration [us]", lambda r: number(r["us_per_node_iteration"])),
    ("error of an interval", lambda r: number(r["error"])),
    ("error in a second", lambda r: number(r["error_per_second"])),
]

THREADS: list[Column] = [
    ("task", lambda r: r["task"]),
    ("solver", lambda r: r["label"]),
    ("threads", lambda r: str(r["threads"])),
    ("iterations", iterations),
    ("wall clock [ms]", wall_clock),
    ("CPU time [ms]", clock),
    ("of one thread's", lambda r: r["to_one"]),
]


def describe(record: dict) -> str:
    """One line for the terminal."""
    if record["kind"] in ("about", "end"):
        return f"{record['kind']}: load {record['load']:.2f}"
    head = f"{record['kind']:7} {record['task']:8} {record['label']:18}"
    if "failed" in record:
        return f"{head} failed: {record['failed']}"
    return (
        f"{head} {record['intervals']:4} intervals  {iterations(record):>14} it  {clock(record):>22} ms  "
        f"error {record['error']:.2e} {record['error_per_second']:.2e}/s  {worst(record)}"
    )


def table(columns: list[Column], records: Iterable[dict]) -> list[str]:
    rows = [[title for title, _ in columns], ["---"] * len(columns)]
    rows += [[show(record) for _, show in columns] for record in records]
    return ["| " + " | ".join(row) + " |" for row in rows]


def failures(records: list[dict]) -> list[str]:
    return [
        f"- {r['label']}" + (f", steps of {1e3 * r['step_s']:.0f} ms" if "step_s" in r else "") + f": {r['failed']}"
        for r in records
        if "failed" in r
    ]


def with_ratios(record: dict, records: list[dict], step: float) -> dict:
    """With what the peers of the same task took at that step."""

    def peer(solver: str) -> dict | None:
        return next(
            (
                r
                for r in records
                if r["kind"] == "task"
                and r["task"] == record["task"]
                and r["solver"] == solver
                and r.get("step_s") == step
                and "failed" not in r
            ),
            None,
        )

    def ratio(solver: str) -> str:
        found = peer(solver)
        if found is None:
            return "-"
        return number(record["seconds"] / found["seconds"], 2) + ("" if found["converged"] else " (not converged)")

    def coarsest_by_second() -> str:
        enough = [
            r
            for r in records
            if r["kind"] == "search"
            and r["task"] == record["task"]
            and r["solver"] == record["solver"]
            and "failed" not in r
            and r["converged"]
            and r["error_per_second"] <= box["error_per_second"]
        ]
        found = min(enough, key=lambda r: r["intervals"], default=None)
        return f"{found['intervals']} intervals, {number(1e3 * found['seconds'])} ms" if found else "-"

    box = peer("boxfddp")
    return {
        **record,
        "by_second_alone": coarsest_by_second(),
        "to_boxfddp": ratio("boxfddp"),
        "to_sqp": ratio("sqp"),
        "box_error": number(box["error"]),
        "box_error_per_second": number(box["error_per_second"]),
    }


def to_one_thread(record: dict, records: list[dict]) -> dict:
    one = next(
        (r for r in records if r["task"] == record["task"] and r["solver"] == record["solver"] and r["threads"] == 1),
        None,
    )
    return {**record, "to_one": number(record["wall_seconds"] / one["wall_seconds"], 2) if one else "-"}


def write_report(records: list[dict], path: pathlib.Path) -> None:
    about = next(r for r in records if r["kind"] == "about")
    end = next(r for r in records if r["kind"] == "end")
    step = about["steps"][0]
    lines = [
        "# Prowl and its peers",
        "",
        f"{about['date']}, {about['processor']}, {about['cores']} cores, all pinned to core {about['core']}, load "
        f"{about['load']:.2f} at the beginning, {end['load']:.2f} at the end; up to {about['repetitions']} repetitions, median "
        f"[least, largest]. Versions: {', '.join(f'{k} {v}' for k, v in about['versions'].items())}. "
        "Columns: bench/README.md.",
        "",
    ]
    if any(r.get("clock") == "wall" for r in records):
        lines += [
            "\\* wall clock, or CPU time of the whole process where that is less: this Prowl does not tell its solver's CPU time.",
            "",
        ]

    matches = [r for r in records if r["kind"] == "match"]
    if matches:
        lines += [
            f"## At equal error: Prowl's coarsest mesh as exact as BoxFDDP with steps of {1e3 * step:.0f} ms",
            "",
            *table(MATCH, [with_ratios(r, records, step) for r in matches if "failed" not in r]),
            "",
            *failures(matches),
            "",
        ]
    for task in dict.fromkeys(r["task"] for r in records if r["kind"] == "task"):
        found = [r for r in records if r["kind"] == "task" and r["task"] == task]
        lines += [f"## {task}", "", *table(TASK, [r for r in found if "failed" not in r]), "", *failures(found), ""]
    growth = [r for r in records if r["kind"] == "growth"]
    for task in dict.fromkeys(r["task"] for r in growth):
        found = [r for r in growth if r["task"] == task]
        lines += [f"## Growth: {task}", ""]
        if not about["one_mesh"] and any(r.get("after_coarser_meshes") for r in found):
            lines += [
                "This Prowl cannot leave out its coarser meshes: iterations and time are those of the last mesh, which starts from "
                "the one before it.",
                "",
            ]
        lines += [*table(GROWTH, [r for r in found if "failed" not in r]), "", *failures(found), ""]
    if threads := [r for r in records if r["kind"] == "threads"]:
        good = [r for r in threads if "failed" not in r]
        lines += [
            "## Threads: each task on its own mesh, on all cores",
            "",
            *table(THREADS, [to_one_thread(r, good) for r in good]),
            "",
            *failures(threads),
            "",
        ]
    path.write_text("\n".join(lines))
