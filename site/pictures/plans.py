"""Plans for the pictures, made by the prowl command that is there."""

import csv
import json
import pathlib
import subprocess

import numpy as np

ROOT = pathlib.Path(__file__).parents[2]


class Table:
    """Columns of a CSV file by name."""

    def __init__(self, path: pathlib.Path):
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        self.names = rows[0]
        self._values = np.array([[float(entry) for entry in row] for row in rows[1:]])

    def __getitem__(self, name: str) -> np.ndarray:
        return self._values[:, self.names.index(name)]

    def columns(self, *names: str) -> np.ndarray:
        return np.column_stack([self[name] for name in names])


class Plan:
    def __init__(self, folder: pathlib.Path):
        self.folder = folder
        self.json = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
        self.trajectory = Table(folder / "trajectory.csv")
        self.contacts = [name.removeprefix("contact_") for name in self.trajectory.names if name.startswith("contact_")]


class Planner:
    """Runs prowl; plans go into `work`. Ends with prowl's own message if one fails."""

    def __init__(self, prowl: pathlib.Path, work: pathlib.Path, packages: list[str]):
        self._prowl, self._work, self._packages = prowl, work, packages

    def plan(self, task: str, *options: str, good: bool = True) -> Plan:
        return self._plan(ROOT / "tasks" / f"{task}.toml", options, good)

    def output_of(self, program: str) -> str:
        """Of a program of the build that prowl is in."""
        return subprocess.run(
            [self._prowl.resolve().parents[1] / program], capture_output=True, text=True, check=True
        ).stdout

    def _plan(self, task: pathlib.Path, options: tuple, good: bool) -> Plan:
        folder = self._work / "-".join([task.parent.name, task.stem, *(option.strip("-") for option in options)])
        if not folder.exists():
            self.run("plan", task, "--out", folder, *options, allowed=(0,) if good else (0, 7))
        return Plan(folder)

    def run(self, *arguments, allowed=(0,)) -> None:
        command = [str(part) for part in (self._prowl, *arguments, "--package-dir", *self._packages)]
        if not self._packages:
            command.remove("--package-dir")
        result = subprocess.run(command, capture_output=True, text=True)
        if result.returncode not in allowed:
            raise SystemExit(f"{' '.join(command)} ended with {result.returncode}\n{result.stderr}")
