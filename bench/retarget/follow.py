"""Retargets all references of references.py and prints a table: `follow.py [FOLDER]`. Exit status 1 if one that is
feasible is not followed, or a planted flaw is not told."""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

from references import CASES, Case, write

import prowl


def verdict(case: Case, done: prowl.Retargeted) -> bool:
    if not case.flaw:
        return done.followed
    said = " ".join([*done.reasons, *done.flaws, *(limit for one in done.deviations for limit in one.limits)])
    return any(word in said for word in case.told)


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="prowl_references_"))
    folder.mkdir(parents=True, exist_ok=True)
    right, feasible, followed = 0, 0, 0
    print(
        "| reference | planted | followed | joints, RMS [rad] | grade | time [s] | told |\n|---|---|---|--:|---|--:|---|"
    )
    for case in CASES:
        start = time.monotonic()
        done = prowl.retarget(write(case, folder), case.robot)
        seconds = time.monotonic() - start
        told = (*done.reasons, *done.flaws)
        print(
            f"| {case.name} | {case.flaw or '-'} | {'yes' if done.followed else 'no'} | {done.joint_rms:.4f} "
            f"| {done.plan.certificate.grade} | {seconds:.1f} | {told[0] if told else '-'} |",
            flush=True,
        )
        right += verdict(case, done)
        if not case.flaw:
            feasible += 1
            followed += done.followed
    print(f"\n{followed} of {feasible} feasible references followed; {right} of {len(CASES)} verdicts right")
    sys.exit(right != len(CASES))


if __name__ == "__main__":
    main()
