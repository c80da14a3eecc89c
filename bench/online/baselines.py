"""HyQ, kicked, under other controllers in the loop of `prowl mpc`: a table of successful runs.

Usage: baselines.py RUNS.json --prowl-runs HYQ.json --seeds N --first-seed S. Runs that the file has are not repeated. scripts/bench_online calls it.
"""

import argparse
import functools
import itertools
import json
import pathlib
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

import prowl
from fixed_plan import FixedPlan
from peer_planner import PeerPlanner
from peers.environment import ENVIRONMENT, ROOT, install

ROBOT = ROOT / "robots/hyq.toml"
KICKS = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2)  # [m/s], as the rows curve_* of `prowl mpc --benchmark`
DURATION = 20.0  # [s]
ITERATIONS = 4  # with time stopped: more hold no more kicks


@dataclass(frozen=True)
class Baseline:
    name: str
    make: Callable[[prowl.Robot], Callable]
    late: str
    budget: float  # [s]


def peer(solver: str, iterations: int) -> Callable[[prowl.Robot], PeerPlanner]:
    return lambda robot: PeerPlanner(robot, ROBOT, solver, iterations)


@functools.cache
def fixed_plan(robot: prowl.Robot) -> FixedPlan:
    """A trot with the schedule of Prowl's online trot, which a first request tells."""
    swings = []

    def ask(request: prowl.MotionRequest) -> None:
        times = np.arange(request.start, request.start + 2.0, 1e-3)
        swings.extend(swing for t in times for foot in range(4) if (swing := request.swing(foot, t)))

    prowl.run_online(robot, gait="trot", duration=0.01, planner=ask)
    lifts = sorted({lift for lift, _ in swings})
    first = min(swings)
    stride = lifts[2] - lifts[0]
    return FixedPlan(robot, str(ROBOT), first[0], stride, 1.0 - (first[1] - first[0]) / stride)


BASELINES = (
    Baseline("fixed plan with TVLQR", fixed_plan, "act", 0.0),
    Baseline("Crocoddyl BoxFDDP, real time", peer("boxfddp", 1), "wait", 0.01),
    Baseline("Crocoddyl BoxFDDP, time stopped", peer("boxfddp", ITERATIONS), "act", 0.0),
    Baseline("mim_solvers SQP, real time", peer("sqp", 1), "wait", 0.01),
    Baseline("mim_solvers SQP, time stopped", peer("sqp", ITERATIONS), "act", 0.0),
)


def run(robot: prowl.Robot, baseline: Baseline, kick: float, seed: int, duration: float = DURATION) -> dict:
    planner = baseline.make(robot)
    result = prowl.run_online(
        robot,
        gait="trot",
        kicks=kick,
        duration=duration,
        seed=seed,
        budget=baseline.budget,
        late=baseline.late,
        planner=planner,
        record_rate=0.0,
    )
    if isinstance(planner, PeerPlanner):
        planner.close()
    times = 1e3 * result.plan_times
    return {
        "controller": baseline.name,
        "kick_mps": kick,
        "seed": seed,
        "success": result.success,
        "failures": result.failures,
        "velocity_error_mps": result.velocity_error,
        "plan_ms": [round(float(np.percentile(times, q)), 2) for q in (50, 99)],
    }


def table(runs: list[dict], seeds: list[int]) -> str:
    """One row a controller, one column a kick; computing times over all its runs."""
    lines = [
        "| controller | " + " | ".join(f"{kick:g} m/s" for kick in KICKS) + " | p50, median [ms] | p99, worst [ms] |",
        "|---" * (len(KICKS) + 3) + "|",
    ]
    for baseline in BASELINES:
        mine = [one for one in runs if one["controller"] == baseline.name and one["seed"] in seeds]
        cells = [baseline.name]
        for kick in KICKS:
            of_kick = [one["success"] for one in mine if one["kick_mps"] == kick]
            cells.append(f"{sum(of_kick)} of {len(of_kick)}")
        times = np.array([one["plan_ms"] for one in mine if one["plan_ms"][0] > 0.0])
        cells += [f"{np.median(times[:, 0]):.1f}", f"{times[:, 1].max():.1f}"] if len(times) else ["", ""]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def prowl_row(runs: list[dict], seeds: list[int]) -> str:
    """The same of Prowl, from the runs of `prowl mpc --benchmark`."""
    cells, times = ["Prowl, 10 ms budget"], []
    for kick in KICKS:
        rows = (f"curve_{kick:.1f}", f"kicks_{kick:.1f}")
        of_kick = [one for one in runs if one["row"] in rows and one["seed"] in seeds]
        cells.append(f"{sum(one['success'] for one in of_kick)} of {len(of_kick)}")
        times += [(one["plan_ms"]["median"], one["plan_ms"]["p99"]) for one in of_kick]
    medians, p99s = zip(*times, strict=True) if times else ((0.0,), (0.0,))
    cells += [f"{np.median(medians):.1f}", f"{max(p99s):.1f}"]
    return "| " + " | ".join(cells) + " |\n"


def read(file: pathlib.Path) -> list[dict]:
    return json.loads(file.read_text()) if file.exists() else []


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--first-seed", type=int, required=True)
    parser.add_argument("--prowl-runs", type=pathlib.Path, required=True, help="of HyQ, by prowl mpc --benchmark")
    arguments = parser.parse_args()
    seeds = list(range(arguments.first_seed, arguments.first_seed + arguments.seeds))
    runs = read(arguments.runs)
    known = {(one["controller"], one["kick_mps"], one["seed"]) for one in runs}
    install(ENVIRONMENT)
    robot = prowl.read_robot(ROBOT)
    for seed, kick, baseline in itertools.product(seeds, KICKS, BASELINES):
        if (baseline.name, kick, seed) not in known:
            runs.append(run(robot, baseline, kick, seed))
            arguments.runs.write_text(json.dumps(runs, indent=1))
    print(table(runs, seeds) + prowl_row(read(arguments.prowl_runs), seeds), end="")


if __name__ == "__main__":
    main()
