"""The whole benchmark, in the peers' environment: called by scripts/bench with its arguments."""

import datetime
import importlib.metadata
import json
import math
import os
import pathlib
import platform
import shutil
import sys

from judge.motion_task import MotionTask, read_task
from peers.environment import package_dirs
from peers.measure import failure, measure_peer, measure_prowl
from peers.mesh_search import coarsest_mesh
from peers.options import ROOT, read_options
from peers.plots import plot_all
from peers.prowl_command import ProwlCommand
from peers.report import describe, write_report

YARDSTICK = "boxfddp"  # whose error Prowl's mesh has to match
QUICK_INTERVALS = 20


def finite(value):
    """The same with null for NaN and infinity, which JSON does not have."""
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Benchmark:
    def __init__(self, options, cores: frozenset[int]):
        self.options, self.records, self.cores = options, [], cores
        self.packages = [*options.package_dir, *package_dirs(options.environment)]
        self.prowl = ProwlCommand(options.prowl, self.packages, options.time_limit)
        known = self.prowl.solvers()
        self.solvers = (
            options.solvers
            if options.solvers is not None
            else [name for name in known if name in ("riccati", "fatrop")]
        )
        if unknown := set(self.solvers) - set(known):
            raise SystemExit(f"bench: --solvers {','.join(sorted(unknown))}: {options.prowl} has {','.join(known)}")
        self.lines = open(options.out / "results.jsonl", "w")

    def keep(self, record: dict) -> dict:
        self.records.append(record)
        self.lines.write(json.dumps(finite(record)) + "\n")
        self.lines.flush()
        print(describe(record), flush=True)
        return record

    def task_file(self, name: str) -> pathlib.Path:
        return ROOT / "tasks/hyq" / f"{name}.toml"

    def run_prowl(self, kind: str, task: MotionTask, solver: str, **more) -> dict:
        return measure_prowl(kind, self.prowl, task, self.task_file(task.name), solver, **more)

    @property
    def clock(self) -> dict:
        return {"repetitions": self.options.repetitions, "patience": self.options.patience}

    def with_durations(self, task: MotionTask) -> MotionTask:
        """Free durations as Prowl's first solver chose them on the task's own mesh; without Prowl, the middle of their ranges."""
        if not task.free_durations() or not self.solvers:
            return task
        durations = self.prowl.plan(self.task_file(task.name), self.solvers[0]).durations
        print(
            f"{task.name}: durations {', '.join(f'{d:.4f}' for d in durations)} s, as Prowl {self.solvers[0]} chose them"
        )
        return task.with_durations(durations)

    def run_task(self, name: str) -> None:
        task = self.with_durations(read_task(self.task_file(name), self.packages))
        for peer in self.options.peers:
            for step in self.options.steps:
                found = self.keep(
                    measure_peer("task", task, peer, step, time_limit=self.options.time_limit, **self.clock)
                )
                if "failed" in found or found["seconds"] > self.options.patience:
                    break
        yardstick = next(
            (
                r
                for r in self.records
                if r["kind"] == "task"
                and r["task"] == task.name
                and "failed" not in r
                and r["solver"] == YARDSTICK
                and r["step_s"] == self.options.steps[0]
            ),
            None,
        )
        for solver in self.solvers:
            intervals = QUICK_INTERVALS if self.options.quick else None
            self.keep(self.run_prowl("task", task, solver, intervals=intervals, **self.clock))
            if yardstick:
                self.match(task, solver, yardstick)

    def match(self, task: MotionTask, solver: str, yardstick: dict) -> None:
        """Prowl on its coarsest mesh with no larger an error than the yardstick's, of an interval and in a second."""
        tried: dict[int, dict] = {}

        def good(intervals: int) -> bool:
            for count in range(intervals, intervals + 4):  # goals have to be at nodes, which not every number grants
                tried[intervals] = self.run_prowl("search", task, solver, intervals=count)
                if "failed" not in tried[intervals]:
                    break
            found = self.keep(tried[intervals])
            return (
                "failed" not in found
                and found["converged"]
                and found["error"] <= yardstick["error"]
                and found["error_per_second"] <= yardstick["error_per_second"]
            )

        first = 4 * len(task.phases)
        intervals = coarsest_mesh(good, first)
        if intervals is None:
            self.keep(failure("match", task.name, solver, f"Prowl {solver}", "no mesh is as exact"))
            return
        found = self.run_prowl("match", task, solver, intervals=tried[intervals]["intervals"], **self.clock)
        self.keep({**found, "yardstick": YARDSTICK})

    def run_growth(self, name: str) -> None:
        task = read_task(self.task_file(name), self.packages)
        repetitions = {"repetitions": min(3, self.options.repetitions), "patience": self.options.patience}
        for intervals in self.options.growth:
            if YARDSTICK in self.options.peers:
                self.keep(
                    measure_peer(
                        "growth",
                        task,
                        YARDSTICK,
                        task.duration / intervals,
                        time_limit=self.options.time_limit,
                        **repetitions,
                    )
                )
            for solver in self.solvers:
                self.keep(self.run_prowl("growth", task, solver, intervals=intervals, one_mesh=True, **repetitions))

    def run_threads(self, name: str) -> None:
        task = read_task(self.task_file(name), self.packages)
        for solver in self.solvers:
            for threads in self.options.threads:
                self.keep(self.run_prowl("threads", task, solver, threads=threads, cores=self.cores, **self.clock))

    def about(self) -> dict:
        processor = next(
            (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), ""
        )
        versions = {name: importlib.metadata.version(name) for name in ("crocoddyl", "mim-solvers", "pin")}
        return {
            "kind": "about",
            "date": datetime.datetime.now().isoformat(timespec="seconds"),
            "processor": processor,
            "cores": os.cpu_count(),
            "core": min(os.sched_getaffinity(0)),
            "load": os.getloadavg()[0],
            "system": platform.platform(),
            "versions": versions,
            "prowl": str(self.options.prowl),
            "one_mesh": self.prowl.has_one_mesh,
            "steps": self.options.steps,
            "repetitions": self.options.repetitions,
        }

    def run(self) -> None:
        self.keep(self.about())
        for name in self.options.tasks:
            self.run_task(name)
        for name in self.options.growth_tasks:
            self.run_growth(name)
        if self.options.threads != [1]:
            for name in self.options.tasks:
                self.run_threads(name)
        self.keep({"kind": "end", "load": os.getloadavg()[0]})
        write_report(self.records, self.options.out / "report.md")
        plot_all(self.records, self.options.out)
        print(f"written to {self.options.out}")


def main() -> None:
    options = read_options(sys.argv[1:])
    allowed = os.sched_getaffinity(0)
    core = options.core if options.core is not None else max(allowed)
    if core not in allowed:
        raise SystemExit(f"bench: --core {core}: this process may run on {', '.join(map(str, sorted(allowed)))}")
    os.sched_setaffinity(0, {core})
    options.out.mkdir(parents=True, exist_ok=True)
    for name in ("results.jsonl", "report.md"):
        old = options.out / name
        if old.exists():
            shutil.move(old, old.with_name(f"{old.name}.old"))
    Benchmark(options, frozenset(allowed)).run()


if __name__ == "__main__":
    main()
