"""The same random tasks for the peers: a process in their environment that is asked task by task. Standard library only."""

import json
import pathlib
import subprocess

from load.random_tasks import folder
from peers.environment import package_dirs, variables


def prowl_record(plan, seconds: float, found: dict) -> dict:
    """Prowl's own word on its plan beside what the judge found; `seconds`: CPU time of all that `solve` does."""
    solver = json.loads(plan.to_json())["solver"]
    return {
        "label": "Prowl",
        "converged": plan.status == "converged",
        "good": plan.good,
        "iterations": plan.iterations,
        "seconds": solver.get("cpu_seconds", 0.0),
        "call_seconds": seconds,
        **(found or {"failed": "refused"}),
    }


class Peers:
    """Judges Prowl's motions, and makes and judges those of its peers."""

    def __init__(
        self, environment: pathlib.Path, solvers: list[str], time_limit: float, file: pathlib.Path | None = None
    ):
        """`file`: for the records, a JSON line each."""
        self.solvers, self.time_limit, self.records = solvers, time_limit, []
        self.file = file.open("w", encoding="utf-8") if file else None
        self.packages = [str(path) for path in package_dirs(environment)]
        self.process = subprocess.Popen(
            [environment / "bin/python", "-m", "load.peer_worker"],
            env=variables(),
            text=True,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )

    def ask(self, number: int, robot: str, document: dict, plan, seconds: float) -> None:
        columns = ("t", "phase", "q", "v", "tau")
        motion = (
            None if plan.reasons else {name: getattr(plan, name).tolist() for name in columns}
        )  # refused: the initial guess
        job = {
            "number": number,
            "document": document,
            "folder": str(folder(robot)),
            "packages": self.packages,
            "solvers": self.solvers,
            "time_limit": self.time_limit,
            "motion": motion,
        }
        self.process.stdin.write(json.dumps(job) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise SystemExit(f"load: the peers' process ended at task {number}, status {self.process.wait()}")
        found = json.loads(answer)
        ours = prowl_record(plan, seconds, found.pop("prowl", {}))
        self.records.append({"number": number, "robot": robot, "task": document, "solvers": {"prowl": ours, **found}})
        if self.file:
            print(json.dumps(self.records[-1]), file=self.file, flush=True)
