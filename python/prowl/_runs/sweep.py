"""sweep(), with a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from .. import _prowl
from .._plans import Folders, PlanOrFolder, as_plan
from .bar import run_with_bar, sweep_bar


def sweep(
    plan: PlanOrFolder,
    n: int = 200,
    *,
    seed: int = 1,
    mass_spread: float = 0.1,
    push_impulse: float | None = None,
    push_impulse_on_two_feet: float | None = None,
    only: Sequence[str] = (),
    breakdown: int = 0,
    open_loop: bool = False,
    package_dirs: Folders = (),
    progress: bool | None = None,
    on_progress: Callable[[int, int], object] | None = None,
) -> _prowl.Sweep:
    """Runs a plan in MuJoCo n times with different masses, friction, pushes and sensor noise, like `prowl
    sweep`.

    plan: a Plan with gains, or its folder. seed: of the first simulation; the others count up. mass_spread:
    largest error of the mass of each body, as a share. push_impulse, push_impulse_on_two_feet: on the base [N s];
    by default 0.12 m/s times the mass of a robot that stands 0.58 m high. only: kinds of perturbations to draw,
    as in `prowl sweep --help`; empty: all.
    breakdown: simulations per size of each perturbation alone; 0: none; 20 takes about a thousand
    simulations. open_loop: feedforward torques only. package_dirs: see read_task(). progress: show a bar with
    tqdm; None: in a terminal or notebook. on_progress: called with the number of finished and of all
    simulations.

    Deterministic. Ctrl-C raises Interrupted, a KeyboardInterrupt; its `sweep` contains the finished
    simulations, or None.
    """
    found = as_plan(plan, package_dirs)

    def run(tell: Callable[[int, int], object] | None) -> _prowl.Sweep:
        return _prowl.sweep(
            found,
            n,
            seed=seed,
            mass_spread=mass_spread,
            push_impulse=push_impulse,
            push_impulse_on_two_feet=push_impulse_on_two_feet,
            only=only,
            breakdown=breakdown,
            open_loop=open_loop,
            on_progress=tell,
        )

    return run_with_bar(progress, sweep_bar(), run, on_progress)
