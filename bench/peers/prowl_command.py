"""Plans of the `prowl` command, with the time that its solver says it took."""

import json
import os
import pathlib
import statistics
import subprocess
import tempfile
from dataclasses import dataclass

from judge.motion import Motion, read_plan_motion
from peers.clock import Clock


@dataclass(frozen=True)
class ProwlRun:
    motion: Motion
    durations: list[float]  # of the phases [s]
    seconds: list[float]  # CPU time of the solver, on all meshes together, one a repetition
    guess_seconds: float
    process_seconds: list[float]  # CPU time of the whole process: files, proofs, solver, certificate
    split: dict[str, float]  # shares of `seconds` by what was computed
    levels: list[dict]
    converged: bool
    grade: str
    reintegration: float  # the certificate's own figure, to compare with the judge's


class ProwlError(RuntimeError):
    """The command wrote no plan, or knew without solving that there is none."""


class ProwlCommand:
    def __init__(self, binary: pathlib.Path, package_dirs: list[pathlib.Path]):
        if not binary.is_file():
            raise SystemExit(f"bench: {binary}: no such file; scripts/setup builds it, or give --prowl FILE")
        self.binary = binary
        self.packages = [word for folder in package_dirs for word in ("--package-dir", str(folder))]

    def plan(self, task_file: pathlib.Path, clock: Clock, options: list[str]) -> ProwlRun:
        seconds: list[float] = []
        guess_seconds: list[float] = []
        process_seconds: list[float] = []
        while not seconds or (len(seconds) < clock.repetitions and sum(seconds) < clock.patience):
            with tempfile.TemporaryDirectory() as folder:
                out = pathlib.Path(folder) / "plan"
                process_seconds.append(self._run(task_file, clock.time_limit, options, out))
                record = json.loads((out / "plan.json").read_text())
                motion = read_plan_motion(out)
            found = record["solver"]
            if not found["levels"]:
                raise ProwlError(f"{record['status']}: {'; '.join(record['reasons'])}")
            seconds.append(found["cpu_seconds"])
            guess_seconds.append(found["evaluation"]["guess"])
        checks = {check["name"]: check["worst"] for check in record["certificate"]["checks"]}
        return ProwlRun(
            motion,
            [phase["duration_s"] for phase in record["problem"]["phases"]],
            seconds,
            statistics.median(guess_seconds),
            process_seconds,
            found["evaluation"],
            found["levels"],
            record["status"] == "converged",
            record["certificate"]["grade"],
            checks.get("re-integration", float("nan")),
        )

    def _run(self, task_file: pathlib.Path, time_limit: float, options: list[str], out: pathlib.Path) -> float:
        """CPU seconds of the whole process."""
        command = [str(self.binary), "plan", str(task_file), "--out", str(out), "--max-time", str(time_limit)]
        command += [*self.packages, "--no-gains", *options]
        with tempfile.TemporaryFile("w+") as messages:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=messages)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            messages.seek(0)
            said = [line for line in messages.read().splitlines() if line.startswith("prowl:")]
        if not (out / "plan.json").exists():
            raise ProwlError(said[0] if said else f"exit status {process.returncode}")
        return usage.ru_utime + usage.ru_stime
