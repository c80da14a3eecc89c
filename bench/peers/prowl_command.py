"""Plans of the `prowl` command, with the time that its solver says it took."""

import json
import os
import pathlib
import re
import subprocess
import tempfile
from dataclasses import dataclass

from judge.motion import Motion, read_plan_motion

ONE_MESH = "--one-mesh"  # option that leaves out the coarser meshes, where the command has it
NO_GAINS = "--no-gains"
THREADS = "--threads"


@dataclass(frozen=True)
class ProwlRun:
    motion: Motion
    durations: list[float]  # of the phases [s]
    seconds: list[float]  # of the solver, on all meshes together, one a repetition
    last_seconds: list[float]  # of its last mesh alone
    wall_seconds: list[float]  # of the solver by the wall clock, one a repetition
    clock: str  # what `seconds` are: "cpu", or "wall" where the plan tells no CPU time
    split: dict[str, float]  # shares of `seconds` by what was computed, as far as the plan tells
    levels: list[dict]
    converged: bool
    grade: str
    reintegration: float  # the certificate's own figure, to compare with the judge's

    @property
    def iterations(self) -> int:
        return sum(level["iterations"] for level in self.levels)


class ProwlError(RuntimeError):
    """The command wrote no plan, or knew without solving that there is none."""


class ProwlCommand:
    def __init__(self, binary: pathlib.Path, package_dirs: list[pathlib.Path], time_limit: float):
        if not binary.is_file():
            raise SystemExit(f"bench: {binary}: no such file; scripts/setup builds it, or give --prowl FILE")
        self.binary, self.time_limit = binary, time_limit
        self.packages = [word for folder in package_dirs for word in ("--package-dir", str(folder))]
        self.help = subprocess.run([binary, "plan", "--help"], capture_output=True, text=True, check=True).stdout
        self.has_one_mesh = ONE_MESH in self.help
        self.without_gains = [NO_GAINS] if NO_GAINS in self.help else []
        self.has_threads = THREADS in self.help

    def solvers(self) -> list[str]:
        found = re.search(r"--solver NAME:\{([^}]*)\}", self.help)
        return found.group(1).split(",") if found else []

    def plan(
        self,
        task_file: pathlib.Path,
        solver: str,
        intervals: int | None = None,
        one_mesh: bool = False,
        repetitions: int = 1,
        patience: float = 0.0,
        threads: int = 1,
        cores: frozenset[int] = frozenset(),
    ) -> ProwlRun:
        """`cores`: that it may run on; empty: those of this process."""
        seconds: list[float] = []
        last_seconds: list[float] = []
        wall_seconds: list[float] = []
        while not seconds or (len(seconds) < repetitions and sum(seconds) < patience):
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / "plan"
                process_seconds = self._run(task_file, solver, intervals, one_mesh, threads, cores, out)
                record = json.loads((out / "plan.json").read_text())
                motion = read_plan_motion(out)
            found = record["solver"]
            if not found["levels"]:
                raise ProwlError(f"{record['status']}: {'; '.join(record['reasons'])}")
            # The wall clock also counts what other programs took of the core, the process also what is not the solver.
            seconds.append(found.get("cpu_seconds", min(found["seconds"], process_seconds)))
            wall_seconds.append(found["seconds"])
            last = found["levels"][-1]
            last_seconds.append(last.get("cpu_seconds", last["seconds"] * seconds[-1] / found["seconds"]))
        checks = {check["name"]: check["worst"] for check in record["certificate"]["checks"]}
        return ProwlRun(
            motion,
            [phase["duration_s"] for phase in record["problem"]["phases"]],
            seconds,
            last_seconds,
            wall_seconds,
            "cpu" if "cpu_seconds" in found else "wall",
            found.get("evaluation", {}),
            found["levels"],
            record["status"] == "converged",
            record["certificate"]["grade"],
            checks.get("re-integration", float("nan")),
        )

    def _run(self, task_file, solver, intervals, one_mesh, threads, cores, out) -> float:
        """CPU seconds of the whole process."""
        command = [
            str(self.binary),
            "plan",
            str(task_file),
            "--solver",
            solver,
            "--out",
            str(out),
            "--max-time",
            str(self.time_limit),
            *self.packages,
            *self.without_gains,
        ]
        command += ["--intervals", str(intervals)] if intervals else []
        command += [ONE_MESH] if one_mesh else []
        command += [THREADS, str(threads)] if threads > 1 else []
        with tempfile.TemporaryFile("w+") as messages:
            process = subprocess.Popen(
                command,
                stdout=subprocess.DEVNULL,
                stderr=messages,
                preexec_fn=(lambda: os.sched_setaffinity(0, cores)) if cores else None,
            )
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            messages.seek(0)
            said = [line for line in messages.read().splitlines() if line.startswith("prowl:")]
        if not (out / "plan.json").exists():
            raise ProwlError(said[0] if said else f"exit status {process.returncode}")
        return usage.ru_utime + usage.ru_stime
