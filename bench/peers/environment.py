"""The peers' virtual environment; standard library only, for it runs before that is there."""

import os
import pathlib
import subprocess
import sys
import venv

ROOT = pathlib.Path(__file__).resolve().parents[2]


def install(environment: pathlib.Path) -> None:
    """The pinned wheels, unless they are there already."""
    wanted, stamp = ROOT / "bench/peers/requirements.txt", environment / "requirements.stamp"
    if stamp.exists() and stamp.read_bytes() == wanted.read_bytes():
        return
    print(f"== making {environment} for the peers, 1.3 GB", file=sys.stderr, flush=True)
    stamp.unlink(missing_ok=True)
    venv.create(environment, with_pip=True)
    result = subprocess.run(
        [
            environment / "bin/python",
            "-m",
            "pip",
            "install",
            "--no-input",
            "--disable-pip-version-check",
            "--quiet",
            "--retries",
            "5",
            "--timeout",
            "60",
            "-r",
            wanted,
        ]
    )
    if result.returncode != 0:
        sys.exit(f"bench: the peers' wheels could not be installed into {environment}; see above")
    stamp.write_bytes(wanted.read_bytes())


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
