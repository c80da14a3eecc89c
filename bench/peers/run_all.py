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
from peers.clock import Clock
from peers.environment import package_dirs
from peers.measure import failure, label, measure_peer, measure_prowl
from peers.mesh_search import coarsest_step
from peers.options import ROOT, read_options
from peers.peer_solvers import EXAMPLES_STEP, PEERS, PeerSetup
from peers.prowl_command import ProwlCommand
from peers.report import describe, write_report

# Of grade draft (docs/verification.md): re-integration error of an interval, and integration error in a second.
DRAFT_ERROR, DRAFT_ERROR_PER_SECOND = 5e-4, 3e-3
ORDERS = {"euler": 1, "semi-implicit": 1, "rk2": 2, "rk4": 4}  # of the error in a second


def finite(value):
    """The same with null for NaN and infinity, which JSON does not have."""
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


class Benchmark:
    def __init__(self, options):
        self.options, self.records = options, []
        self.packages = [*options.package_dir, *package_dirs(options.environment)]
        self.prowl = ProwlCommand(options.prowl, self.packages)
        self.once = Clock(time_limit=options.time_limit)
        self.clock = Clock(options.repetitions, options.patience, options.time_limit)
        self.lines = open(options.out / "results.jsonl", "w")

    def keep(self, record: dict) -> dict:
        self.records.append(record)
        self.lines.write(json.dumps(finite(record)) + "\n")
        self.lines.flush()
        print(describe(record), flush=True)
        return record

    def task_file(self, name: str) -> pathlib.Path:
        return ROOT / "tasks/hyq" / f"{name}.toml"

    def with_durations(self, task: MotionTask) -> MotionTask:
        """Free durations as Prowl chooses them."""
        if not task.free_durations():
            return task
        durations = self.prowl.plan(self.task_file(task.name), self.once, []).durations
        print(f"{task.name}: durations {', '.join(f'{d:.4f}' for d in durations)} s, as Prowl chose them")
        return task.with_durations(durations)

    def run_task(self, name: str) -> None:
        task = self.with_durations(read_task(self.task_file(name), self.packages))
        draft = self.keep(measure_prowl("equal", self.prowl, task, self.task_file(name), self.clock, []))
        self.keep({**draft, "kind": "defaults"})  # the same command
        certified = ["--refine", "certified"]
        self.keep(measure_prowl("defaults", self.prowl, task, self.task_file(name), self.clock, certified))
        for peer in self.options.peers:
            for rule in PEERS[peer].rules:
                self.match(task, peer, rule)
            defaults = PeerSetup(peer, EXAMPLES_STEP, PEERS[peer].rules[0], anchored=False, defaults=True)
            self.keep(measure_peer("defaults", task, defaults, self.clock))

    def match(self, task: MotionTask, peer: str, rule: str) -> None:
        """The peer on its coarsest mesh with the errors of grade draft."""

        def ratio(step: float) -> float:
            found = self.keep(measure_peer("search", task, PeerSetup(peer, step, rule), self.once))
            if "failed" in found:
                return math.inf
            return max(found["error"] / DRAFT_ERROR, found["error_per_second"] / DRAFT_ERROR_PER_SECOND)

        step = coarsest_step(self.options.steps, ORDERS[rule], ratio)
        if step is None:
            name = label(PeerSetup(peer, 0.0, rule))
            self.keep(failure("equal", task.name, peer, name, "none of its meshes is as exact", rule=rule))
        else:
            self.keep(measure_peer("equal", task, PeerSetup(peer, step, rule), self.clock))

    def about(self) -> dict:
        processor = next(
            (line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), ""
        )
        versions = {name: importlib.metadata.version(name) for name in ("crocoddyl", "mim-solvers", "pin")}
        pinned = (ROOT / "bench/peers/aligator/requirements.txt").read_text().splitlines()
        versions |= dict(line.split("==") for line in pinned if line.startswith("libaligator=="))
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
            "repetitions": self.options.repetitions,
        }

    def run(self) -> None:
        self.keep(self.about())
        for name in self.options.tasks:
            self.run_task(name)
        self.keep({"kind": "end", "load": os.getloadavg()[0]})
        write_report(self.records, self.options.out / "report.md")
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
    Benchmark(options).run()


if __name__ == "__main__":
    main()
