"""The options of scripts/bench; standard library only, for it runs before the peers' environment is there."""

import argparse
import pathlib

from peers.environment import ENVIRONMENT

ROOT = pathlib.Path(__file__).resolve().parents[2]
TASKS = ["stand", "crouch", "balance", "rear", "step"]
PEERS = ["boxfddp", "intro", "sqp", "csqp", "aligator"]
STEPS = [
    0.32,
    0.226,
    0.16,
    0.113,
    0.08,
    0.056,
    0.04,
    0.028,
    0.02,
    0.014,
    0.01,
    0.007,
    0.005,
    0.0035,
    0.0025,
]  # of a factor of sqrt(2), nearly


def _list(text: str) -> list[str]:
    return [entry for entry in text.split(",") if entry]


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="scripts/bench",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Plans HyQ's tasks with Prowl and with its peers (Crocoddyl, mim_solvers, aligator) on one core, judges all\n"
        "motions with the same code, and writes two tables and JSON lines. What the columns mean: bench/README.md.",
    )
    parser.add_argument(
        "out",
        nargs="?",
        type=pathlib.Path,
        default=ROOT / "build/bench-results",
        help="folder for the results; default build/bench-results",
    )
    parser.add_argument(
        "--quick", action="store_true", help="a smoke test of three minutes: stand only, no short steps, no repetitions"
    )
    parser.add_argument(
        "--tasks", type=_list, default=TASKS, metavar="NAME,...", help=f"of tasks/hyq; default {','.join(TASKS)}"
    )
    parser.add_argument(
        "--peers", type=_list, default=PEERS, metavar="NAME,...", help=f"default {','.join(PEERS)}; none: --peers="
    )
    parser.add_argument(
        "--repetitions", type=int, default=5, metavar="N", help="of each solve, for the clock; default 5"
    )
    parser.add_argument(
        "--patience",
        type=float,
        default=5.0,
        metavar="S",
        help="no more repetitions once they took so long together; default 5 s",
    )
    parser.add_argument(
        "--time-limit", type=float, default=60.0, metavar="S", help="CPU time of one solve; default 60 s"
    )
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
        default=ENVIRONMENT,
        metavar="DIR",
        help="virtual environment of the peers but aligator, made on first use; default .venv-peers",
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
    for name in options.tasks:
        if not (ROOT / f"tasks/hyq/{name}.toml").is_file():
            parser.error(f"{name}: there is no tasks/hyq/{name}.toml")
    if options.repetitions < 1:
        parser.error(f"--repetitions {options.repetitions}: need 1 or more")
    options.steps = STEPS
    if options.quick:
        options.tasks, options.steps, options.repetitions = ["stand"], STEPS[:9], 1
    return options
