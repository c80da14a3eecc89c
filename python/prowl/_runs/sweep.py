"""sweep(), with a display of progress."""

from __future__ import annotations

from collections.abc import Callable

from .. import _prowl
from .bar import run_with_bar, sweep_bar
from .._plans import Folders, PlanOrFolder, as_plan


def sweep(
    plan: PlanOrFolder,
    n: int = 200,
    *,
    seed: int = 1,
    mass_spread: float = 0.1,
    push_impulse: float = 10.0,
    push_impulse_on_two_feet: float = 2.0,
    breakdown: int = 0,
    open_loop: bool = False,
    package_dirs: Folders = (),
    progress: bool | None = None,
    on_progress: Callable[[int, int], object] | None = None,
) -> _prowl.Sweep:
    """Runs a plan in MuJoCo n times, each with other masses, friction, pushes and sensor noise, as `prowl sweep` does.

    plan: a Plan with gains, or the folder of one. seed: of the first simulation, the others count on. mass_spread: masses
    are off by up to this share. push_impulse, push_impulse_on_two_feet: on the base [N s]. breakdown: simulations for each
    size of one perturbation alone; 0 leaves that out, 20 takes about a thousand simulations. open_loop: feedforward torques
    only. package_dirs: as of read_task(). progress: show a bar with tqdm; None does so in a terminal and in a notebook.
    on_progress: called with the number of simulations that are done, and of all.

    The same arguments give the same result. Ctrl-C raises Interrupted, a KeyboardInterrupt; its `sweep` contains the simulations
    that have finished, and is None if none has.
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
            breakdown=breakdown,
            open_loop=open_loop,
            on_progress=tell,
        )

    return run_with_bar(progress, sweep_bar(), run, on_progress)
