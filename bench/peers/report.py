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


def iterations(record: dict) -> str:
    return " + ".join(map(str, record.get("iterations_by_mesh", [record["iterations"]])))


def milliseconds(record: dict) -> str:
    spread = (
        f" [{number(1e3 * record['seconds_min'])}, {number(1e3 * record['seconds_max'])}]"
        if record["repetitions"] > 1
        else ""
    )
    return f"{number(1e3 * record['seconds'])}{spread}"


def broken(record: dict) -> str:
    found = record["worst"]
    return "none" if record["keeps_task"] else f"{found['check']} {number(found['value'], 2)} {found['unit']}"


def solver(record: dict) -> str:
    grade = f", {record['grade']}" if "grade" in record else ""
    return f"{record['label']}{grade}" + (" (joints bounded)" if record.get("joint_bounds") else "")


COLUMNS: list[Column] = [
    ("solver", solver),
    ("intervals", lambda r: str(r["intervals"])),
    ("iterations", iterations),
    ("converged", lambda r: "yes" if r["converged"] else "no"),
    ("limits broken", broken),
    ("CPU time of the solver [ms]", milliseconds),
    ("with the guess [ms]", lambda r: number(1e3 * (r["seconds"] + r["guess_seconds"]))),
    ("with guess and set-up [ms]", lambda r: number(1e3 * r["whole_seconds"])),
    ("error of an interval", lambda r: number(r["error"])),
    ("error in a second", lambda r: number(r["error_per_second"])),
    ("cost", lambda r: number(r["cost"], 4)),
]
RATIOS = ("boxfddp", "sqp", "csqp", "aligator", "intro")


def describe(record: dict) -> str:
    """One line for the terminal."""
    if record["kind"] in ("about", "end"):
        return f"{record['kind']}: load {record['load']:.2f}"
    head = f"{record['kind']:8} {record['task']:8} {record['label']:36}"
    if "failed" in record:
        return f"{head} failed: {record['failed']}"
    said = "" if record["converged"] else ", not converged"
    return (
        f"{head} {record['intervals']:4} intervals  {iterations(record) + said:>14} it  {milliseconds(record):>22} ms  "
        f"error {record['error']:.2e} {record['error_per_second']:.2e}/s  {broken(record)}"
    )


def table(columns: list[Column], records: Iterable[dict]) -> list[str]:
    rows = [[title for title, _ in columns], ["---"] * len(columns)]
    rows += [[show(record) for _, show in columns] for record in records]
    return ["| " + " | ".join(row) + " |" for row in rows]


def failures(records: list[dict]) -> list[str]:
    return [
        f"- {r['label']}" + (f", steps of {1e3 * r['step_s']:g} ms" if "step_s" in r else "") + f": {r['failed']}"
        for r in records
        if "failed" in r
    ]


def ratios(records: list[dict]) -> list[str]:
    """Prowl's CPU time over that of each peer with its faster rule: of the solvers, and with guess and set-up."""

    def cell(task: str, peer: str) -> str:
        found = [r for r in records if r["task"] == task and "failed" not in r]
        ours = next((r for r in found if r["solver"] == "prowl"), None)
        theirs = [r for r in found if r["solver"] == peer]
        if ours is None or not theirs:
            return "-"
        best = min(theirs, key=lambda r: (not r["converged"], r["seconds"]))
        text = f"{number(ours['seconds'] / best['seconds'], 2)}, {number(ours['whole_seconds'] / best['whole_seconds'], 2)}"
        return text + ("" if best["converged"] else " (not converged)")

    peers = [peer for peer in RATIOS if any(r["solver"] == peer for r in records)]
    tasks = dict.fromkeys(r["task"] for r in records)
    rows = [["task", *peers], ["---"] * (1 + len(peers)), *([task, *(cell(task, p) for p in peers)] for task in tasks)]
    return ["| " + " | ".join(row) + " |" for row in rows]


def write_report(records: list[dict], path: pathlib.Path) -> None:
    about = next(r for r in records if r["kind"] == "about")
    end = next(r for r in records if r["kind"] == "end")
    lines = [
        "# Prowl and its peers",
        "",
        f"{about['date']}, {about['processor']}, {about['cores']} cores, all pinned to core {about['core']}, load "
        f"{about['load']:.2f} at the beginning, {end['load']:.2f} at the end; up to {about['repetitions']} repetitions, median "
        f"[least, largest]. Versions: {', '.join(f'{k} {v}' for k, v in about['versions'].items())}. "
        "Columns: bench/README.md.",
        "",
    ]
    titles = {"equal": "At equal accuracy: the coarsest mesh with the errors of grade draft", "defaults": "At defaults"}
    for kind, title in titles.items():
        found = [r for r in records if r["kind"] == kind]
        lines += [f"## {title}", ""]
        if kind == "equal":
            lines += [
                "Prowl's CPU time over its peers', of the solvers, and with guess and set-up:",
                "",
                *ratios(found),
                "",
            ]
        for task in dict.fromkeys(r["task"] for r in found):
            of_task = [r for r in found if r["task"] == task]
            lines += [
                f"### {task}",
                "",
                *table(COLUMNS, [r for r in of_task if "failed" not in r]),
                "",
                *failures(of_task),
                "",
            ]
    path.write_text("\n".join(lines))
