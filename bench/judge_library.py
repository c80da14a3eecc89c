"""Judges motions of a library by code that shares nothing with Prowl but the URDF: judge_library.py LIBRARY [COUNT [SEED]].

Draws COUNT (500) of the motions that are kept, makes their plans again, compares them with the samples, and gives them to
tests/second_checker. Prints what it rejects; exit status 1 if there is one.
"""

from __future__ import annotations

import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

import numpy as np
import prowl
from tqdm import tqdm

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/second_checker"))
import second_checker  # noqa: E402

PACKAGES = next((ROOT / ".venv/lib").glob("python3*/site-packages/cmeel.prefix/share"))


def rejected(library: prowl.Library, index: int, folder: Path) -> set[str]:
    """Names of checks that fail."""
    plan, samples = library.plan(index), library.arrays(index)
    again = plan.sample(1 / library.job.rate)
    if not all(
        np.array_equal(getattr(again, name).reshape(samples[name].shape), samples[name])
        for name in ("t", "q", "tau", "f")
    ):
        return {"samples are not those of the plan"}
    plan.write(folder / "plan")
    task = folder / "task.toml"
    task.write_text(re.sub(r"^robot = .*$", f'robot = "{plan.robot.path}"', plan.task.text, flags=re.MULTILINE))
    return second_checker.check(second_checker.Plan(folder / "plan", task, PACKAGES))


def main() -> None:
    library = prowl.read_library(sys.argv[1])
    count, seed = (int(text) for text in [*sys.argv[2:], "500", "1"][:2])
    kept = np.array(library.kept_rows["index"].to_pylist())
    drawn = np.random.default_rng(seed).choice(kept, min(count, len(kept)), replace=False)
    why: Counter[str] = Counter()
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        for index in tqdm(drawn.tolist(), unit="motion"):
            if failed := rejected(library, index, Path(folder)):
                bad += 1
                why.update(failed)
                print(index, failed, flush=True)
    print(f"{len(drawn)} motions judged, {bad} rejected {dict(why)}")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()
