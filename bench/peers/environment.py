"""The peers' virtual environments, and Aligator's program; standard library only, for it runs before they are there.

Two, because Crocoddyl's wheels are built against another Pinocchio than Aligator's.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]
ENVIRONMENT = ROOT / ".venv-peers"  # of all but Aligator
ALIGATOR = ROOT / ".venv-aligator"
ALIGATOR_PROGRAM = ROOT / "build/bench-aligator/aligator_peer"


def _install(environment: pathlib.Path, wanted: pathlib.Path, size: str) -> None:
    """The pinned wheels, unless they are there already."""
    stamp = environment / "requirements.stamp"
    if stamp.exists() and stamp.read_bytes() == wanted.read_bytes():
        return
    print(f"== making {environment} for the peers, {size}", file=sys.stderr, flush=True)
    stamp.unlink(missing_ok=True)
    venv.create(environment, with_pip=True)
    quietly = ["--no-input", "--disable-pip-version-check", "--quiet", "--retries", "5", "--timeout", "60"]
    if subprocess.run([environment / "bin/python", "-m", "pip", "install", *quietly, "-r", wanted]).returncode != 0:
        sys.exit(f"bench: the peers' wheels could not be installed into {environment}; see above")
    stamp.write_bytes(wanted.read_bytes())


def install(environment: pathlib.Path) -> None:
    _install(environment, ROOT / "bench/peers/requirements.txt", "1.3 GB")


def install_aligator() -> None:
    """Its wheels, and bench/peers/aligator built with them: three minutes on first use."""
    _install(ALIGATOR, ROOT / "bench/peers/aligator/requirements.txt", "0.9 GB")
    wheels = next(ALIGATOR.glob("lib/python3*/site-packages/cmeel.prefix"))
    source, build = ROOT / "bench/peers/aligator", ALIGATOR_PROGRAM.parent
    configure = ["cmake", "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={wheels}"]
    if compiler_cache := shutil.which("ccache"):
        configure.append(f"-DCMAKE_CXX_COMPILER_LAUNCHER={compiler_cache}")
    for command in (configure, ["cmake", "--build", build, "--parallel", "2"]):
        if subprocess.run(command, stdout=sys.stderr).returncode != 0:
            sys.exit("bench: aligator_peer could not be built; see above")


def variables() -> dict[str, str]:
    """Environment variables of a program in it: one thread, and the modules of bench/."""
    one_thread = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL")}
    return {**os.environ, **one_thread, "PYTHONPATH": str(ROOT / "bench"), "PYTHONDONTWRITEBYTECODE": "1"}


def package_dirs(environment: pathlib.Path) -> list[pathlib.Path]:
    """Where to look for package://: first in Prowl's own environment, so that all have the same URDFs."""
    return [
        path
        for folder in (ROOT / ".venv", environment)
        for path in folder.glob("lib/python3*/site-packages/cmeel.prefix/share")
    ]
