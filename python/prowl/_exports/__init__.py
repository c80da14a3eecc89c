"""export(): writes a plan or its simulation for other programs (docs/exports.md)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .. import _prowl
from .._extras import needs
from .._plans import Folders, PlanOrFolder, as_plan, folder_with, output_folder

if TYPE_CHECKING:
    from .samples import Samples


@dataclass(frozen=True)
class Export:
    """Result of export()."""

    plan: _prowl.Plan
    motion: str  #: "plan" or "simulation"
    samples: int
    end: float  #: time of the last sample [s]
    has_gains: bool
    folder: str
    files: dict[str, int]  #: file name -> size [bytes]


def export(
    plan: PlanOrFolder,
    formats: str | Sequence[str],
    *,
    out: str | os.PathLike[str] | None = None,
    rate: float | None = None,
    simulation: bool | _prowl.Simulation = False,
    package_dirs: Folders = (),
    allow_libraries: bool = False,
) -> Export:
    """Writes a plan for other programs, like `prowl export`.

    plan: a Plan, or a plan folder. formats: one or more of "csv", "json", "npz", "mcap", "joint-trajectory"
    and "mujoco". out: folder for the files, which may contain others; None: exports in the plan folder. rate:
    samples per second; None: the nodes of the plan, or all rows of the simulation. simulation: export the
    true motion of this Simulation, or if True of simulate.csv in the plan folder, instead of the plan.
    package_dirs, allow_libraries: see read_task().

    Needs numpy, for "mcap" also mcap and mcap-ros2-support. Warns if the plan is not good, and for "mujoco"
    if a mesh cannot be read. Raises InputError, FileError; replaces existing files one by one, each
    atomically.
    """
    names = [formats] if isinstance(formats, str) else list(formats)
    for name in names:
        if name not in _prowl.export_format_names():
            choices = ", ".join(_prowl.export_format_names())
            raise _prowl.InputError(f"format: {name} is not allowed; need one of {choices}")
    source = as_plan(plan, package_dirs, allow_libraries)
    if simulation is not False and "csv" in names:
        simulated = os.path.join(source.path or "", "simulate.csv")
        raise _prowl.InputError(f"format: csv is not allowed; {simulated} contains the simulation already")
    folder = output_folder(source, out, "exports")

    from .samples import sample_plan  # imports numpy

    samples = sample_plan(source, rate) if simulation is False else _simulated(source, simulation, rate)
    if not source.good:
        certificate = "passed" if source.certificate.passed else "failed"
        warnings.warn(f"this plan is not good: {source.status}, certificate {certificate}", stacklevel=2)
    files = _files(source, samples, set(names), rate, package_dirs)
    _prowl.write_files(folder, files)
    return Export(
        source,
        "plan" if simulation is False else "simulation",
        len(samples.motion),
        float(samples.motion.t[-1]),
        samples.gains is not None,
        folder,
        {name: len(files[name]) for name in sorted(files)},
    )


def _simulated(plan: _prowl.Plan, simulation: bool | _prowl.Simulation, rate: float | None) -> Samples:
    """Samples of the simulation in the plan folder, or of a Simulation, written to a temporary folder
    first."""
    from .samples import sample_simulation

    if isinstance(simulation, bool):
        return sample_simulation(plan, rate)
    with folder_with(plan, simulation) as folder:
        again = _prowl.read_plan(folder, own_terms=plan.task.own_terms, allow_libraries=plan.task.allow_libraries)
        return sample_simulation(again, rate)


def _files(
    plan: _prowl.Plan, samples: Samples, formats: set[str], rate: float | None, package_dirs: Folders
) -> dict[str, bytes]:
    """Files of all formats, by name. Warns of meshes that cannot be read."""
    from . import texts

    prefix = "simulated_" if samples.simulated else ""
    files: dict[str, str | bytes] = {}
    if "csv" in formats:
        files["motion.csv"] = plan.to_csv(None if rate is None else 1 / rate)
        if samples.gains is not None:
            files["gains.csv"] = texts.gains_csv(plan, samples)
    if "joint-trajectory" in formats:
        files[f"{prefix}joint_trajectory.json"] = texts.joint_trajectory_json(plan, samples)
    if "mujoco" in formats:
        files[f"{prefix}mujoco.xml"], told = plan.mujoco_xml(
            samples.motion, package_dirs=[os.fspath(path) for path in package_dirs]
        )
        for warning in told:
            warnings.warn(warning, stacklevel=3)
        model = f"{prefix}mujoco_model.xml"
        files[model] = plan.task.mujoco_xml()
        files[f"{prefix}mujoco_keyframes.xml"] = plan.mujoco_keyframes(samples.motion, model)
    if formats & {"json", "npz", "mcap"}:
        document = texts.motion_document(plan, samples)
        if "json" in formats:
            files[f"{prefix}motion.json"] = texts.motion_json(document)
        if "npz" in formats:
            from . import npz

            files[f"{prefix}motion.npz"] = npz.write(document)
        if "mcap" in formats:
            with needs("formats"):
                from . import mcap

            in_parent = plan.robot.link_placements(samples.motion.q, in_parent=True).tolist()
            files[f"{prefix}motion.mcap"] = mcap.write(document, in_parent, samples.one_a_time(), plan.robot.urdf_text)
    return {name: text.encode() if isinstance(text, str) else text for name, text in files.items()}
