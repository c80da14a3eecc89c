"""The options of scripts/bench; standard library only, for it runs before the peers' environment is there."""

import argparse
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
TASKS = ["stand", "crouch", "balance", "rear", "step"]
PEERS = ["fddp", "boxfddp", "intro", "sqp", "csqp"]


def _list(text: str) -> list[str]:
    return [entry for entry in text.split(",") if entry]


def _numbers(text: str) -> list[float]:
    values = [float(entry) for entry in _list(text)]
    if not values or min(values) <= 0:
        raise argparse.ArgumentTypeError(f"{text}: need numbers > 0, separated by commas")
    return values


def _counts(text: str) -> list[int]:
    return [int(value) for value in _numbers(text)]


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="scripts/bench",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Plans HyQ's tasks with Prowl and with its peers (Crocoddyl, mim_solvers) on one core, judges all motions\n"
        "with the same code, and writes tables, JSON lines and plots. What the columns mean: bench/README.md.",
    )
    parser.add_argument(
        "out",
        nargs="?",
        type=pathlib.Path,
        default=ROOT / "build/bench-results",
        help="folder for the results; default build/bench-results",
    )
    parser.add_argument(
        "--quick", action="store_true", help="a smoke test of less than 3 minutes: stand only, coarse, no repetitions"
    )
    parser.add_argument(
        "--tasks", type=_list, default=TASKS, metavar="NAME,...", help=f"of tasks/hyq; default {','.join(TASKS)}"
    )
    parser.add_argument(
        "--solvers",
        type=_list,
        metavar="NAME,...",
        help="of Prowl, names of `prowl plan --solver`; default: those that go by stages, riccati and fatrop",
    )
    parser.add_argument(
        "--peers", type=_list, default=PEERS, metavar="NAME,...", help=f"default {','.join(PEERS)}; none: --peers="
    )
    parser.add_argument(
        "--steps",
        type=_numbers,
        default=[0.02, 0.04, 0.01],
        metavar="S,...",
        help="Euler steps of the peers [s]; the first is the one that Prowl is compared at; default 0.02,0.04,0.01",
    )
    parser.add_argument(
        "--growth-tasks",
        type=_list,
        default=["stand", "crouch"],
        metavar="NAME,...",
        help="tasks that are measured over the number of intervals; default stand,crouch; none: --growth-tasks=",
    )
    parser.add_argument(
        "--growth",
        type=_counts,
        default=[10, 20, 40, 80, 160, 320],
        metavar="N,...",
        help="these numbers of intervals; default 10,20,40,80,160,320",
    )
    parser.add_argument(
        "--threads",
        type=_counts,
        default=[1, 2],
        metavar="N,...",
        help="Prowl on each task's own mesh with so many threads, by the wall clock; default 1,2; none: --threads 1",
    )
    parser.add_argument(
        "--repetitions", type=int, default=5, metavar="N", help="of each solve, for the clock; default 5"
    )
    parser.add_argument(
        "--patience",
        type=float,
        default=15.0,
        metavar="S",
        help="no more repetitions, and no other steps, once they took so long together; default 15 s",
    )
    parser.add_argument("--time-limit", type=float, default=90.0, metavar="S", help="of one solve; default 90 s")
    parser.add_argument("--core", type=int, metavar="N", help="that all is pinned to; default: the last one allowed")
    parser.add_argument(
        "--prowl", type=pathlib.Path, default=ROOT / "build/bin/prowl", metavar="FILE", help="default build/bin/prowl"
    )
    parser.add_argument(
        "--package-dir",
        type=pathlib.Path,
        action="append",
        default=[],
        metavar="DIR",
        help="where to look for package://, as prowl's option; may be given again",
    )
    parser.add_argument(
        "--environment",
        type=pathlib.Path,
        default=ROOT / ".venv-peers",
        metavar="DIR",
        help="virtual environment of the peers, made on first use; default .venv-peers",
    )
    parser.add_argument(
        "--footprint",
        action="store_true",
        help="only print size on disk, time to start, and memory of each shipped task",
    )
    parser.add_argument("--test", action="store_true", help="run the tests of the judge and of the task reader instead")
    return parser


def read_options(arguments: list[str]) -> argparse.Namespace:
    parser = make_parser()
    options = parser.parse_args(arguments)
    if unknown := set(options.peers) - set(PEERS):
        parser.error(f"--peers {','.join(sorted(unknown))}: need some of {','.join(PEERS)}")
    for name in [*options.tasks, *options.growth_tasks]:
        if not (ROOT / f"tasks/hyq/{name}.toml").is_file():
            parser.error(f"{name}: there is no tasks/hyq/{name}.toml")
    if options.repetitions < 1:
        parser.error(f"--repetitions {options.repetitions}: need 1 or more")
    if options.quick:
        options.tasks, options.growth_tasks, options.growth = ["stand"], ["stand"], [10, 20, 40]
        options.steps, options.repetitions, options.threads = options.steps[:1], 1, [1]
    return options
