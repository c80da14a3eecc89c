"""The motions of tasks/paper: planned on the meshes of their files, planned again on meshes that pass the certificate, and
run in both simulations."""

import csv
import dataclasses
import json
import pathlib
import tomllib

import numpy as np
from plans import Plan, Planner
from scene import Scene

AXES = ("x", "y", "z")
HEIGHT = 2  # of the base's position: its z


def read_table(path: pathlib.Path) -> dict[str, np.ndarray]:
    """A CSV of numbers with a heading, column by column."""
    with open(path, newline="", encoding="utf-8") as file:
        names = next(csv.reader(file))
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return {name: values[:, i] for i, name in enumerate(names)}


@dataclasses.dataclass(frozen=True)
class Subject:
    """One motion of the paper."""

    name: str
    title: str  # as the paper calls it
    phase: str = ""  # the intermediate one, whose middle the paper's pictures show; "": the end of the motion


SUBJECTS = (
    Subject("stand", "Standing"),
    Subject("crouch", "Crouching"),
    Subject("balance", "Balancing", "balance"),
    Subject("step", "Stepping", "swing"),
    Subject("rear", "Rearing", "rear"),
)


class Motion:
    """`coarse` is the plan on the mesh of the task file, `fine` the one that its certificate passes, with gains and a simulation."""

    def __init__(self, subject: Subject, planner: Planner):
        self.subject = subject
        self.coarse = planner.plan(f"paper/{subject.name}", good=False)
        self.fine = planner.plan(f"paper/{subject.name}", "--refine")
        self.rollout = self._simulate(planner, "--engine", "rollout")
        self.simulation = self._simulate(planner)
        self.simulated = read_table(self.fine.folder / "simulate.csv")
        planner.run("report", self.fine.folder)
        planner.run("report", self.coarse.folder)
        self.scene = Scene(self.fine.folder / "report.html")
        self.coarse_scene = Scene(self.coarse.folder / "report.html")

    def _simulate(self, planner: Planner, *options: str) -> dict:
        planner.run("simulate", self.fine.folder, *options, allowed=(0, 8))
        return json.loads((self.fine.folder / "simulate.json").read_text(encoding="utf-8"))

    @property
    def joints(self) -> list[str]:
        return self.fine.json["problem"]["joints"]

    def nominal_joints(self) -> dict[str, float]:
        return tomllib.loads(self.fine.json["robot_file"]["text"])["nominal"]["joints"]

    def asked_base(self) -> np.ndarray:
        """Where the cost pulls the base: a place of the trunk point, else the start [m]. What it does not weigh is the start's."""
        place = base_positions(self.fine)[0]
        for cost in tomllib.loads(self.fine.json["task_file"]["text"])["cost"].get("contact_position", []):
            weighed = np.broadcast_to(cost["weight"], 3) > 0
            place = np.where(weighed, cost["reference_m"], place)
        return place

    def phases(self, plan: Plan) -> list[tuple[str, float, float]]:
        """Name, start and end [s]."""
        time, phase = plan.trajectory["time_s"], plan.trajectory["phase"]
        names = [entry["name"] for entry in plan.json["problem"]["phases"]]
        return [(name, time[phase == p][0], time[phase == p][-1]) for p, name in enumerate(names)]

    def still_time(self) -> float:
        """Of the picture: the middle of the intermediate phase, or the end [s]."""
        for name, start, end in self.phases(self.fine):
            if name == self.subject.phase:
                return (start + end) / 2
        return float(self.fine.trajectory["time_s"][-1])


def base_positions(plan: Plan) -> np.ndarray:
    """At the nodes, world frame [m]."""
    return plan.trajectory.columns("base_px_m", "base_py_m", "base_pz_m")


def make_motions(planner: Planner, workers) -> dict[str, Motion]:
    """All, some at a time."""
    return dict(zip((s.name for s in SUBJECTS), workers.map(lambda subject: Motion(subject, planner), SUBJECTS)))
