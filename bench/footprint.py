"""What Prowl takes besides time to plan: size on disk, time to start, memory of each shipped task. Called by scripts/bench."""

import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
WHEELS = ("cmeel.prefix", "casadi", "mujoco")  # in site-packages: those whose libraries the installed command loads
STARTS = 21


def size(folder: pathlib.Path) -> int:
    """Bytes of all files, links not followed."""
    return sum(path.lstat().st_size for path in folder.rglob("*") if path.is_file() and not path.is_symlink())


def print_sizes() -> None:
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(
            ["cmake", "--install", str(ROOT / "build"), "--prefix", prefix, "--strip"],
            check=True,
            stdout=subprocess.DEVNULL,
        )
        print(f"installed (cmake --install --strip): {size(pathlib.Path(prefix)) / 1e6:.1f} MB")
    for site in ROOT.glob(".venv/lib/python3*/site-packages"):
        for wheel in WHEELS:
            print(f"  with the wheel in {wheel}: {size(site / wheel) / 1e6:.0f} MB")


def print_start(prowl: pathlib.Path) -> None:
    seconds = []
    for _ in range(STARTS):
        begin = time.perf_counter()
        subprocess.run([prowl, "--version"], check=True, stdout=subprocess.DEVNULL)
        seconds.append(time.perf_counter() - begin)
    print(
        f"prowl --version: median {1e3 * statistics.median(seconds):.1f} ms, least {1e3 * min(seconds):.1f} ms of {STARTS} starts"
    )


def most_memory(command: list[str]) -> int:
    """Largest resident set of one process [bytes]."""
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        status, usage = os.wait4(process.pid, 0)[1:]
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 7):  # 7: a plan that its certificate refuses
        sys.exit(f"bench: {' '.join(command)}: exit status {process.returncode}")
    return usage.ru_maxrss * 1024


def print_memory(prowl: pathlib.Path) -> None:
    print("| task | memory [MB] |\n|---|---:|")
    for path in sorted(ROOT.glob("tasks/*/*.toml")):
        with tempfile.TemporaryDirectory() as out:
            memory = most_memory([str(prowl), "plan", str(path), "--out", f"{out}/plan"])
        print(f"| {path.parent.name}/{path.stem} | {memory / 1e6:.0f} |", flush=True)


def report(prowl: pathlib.Path) -> None:
    print_sizes()
    print_start(prowl)
    print_memory(prowl)
