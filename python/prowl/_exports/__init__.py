"""export(): a plan or its simulation for other programs (docs/exports.md)."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from dataclasses import dataclass

from .. import _prowl


@dataclass(frozen=True)
class Export:
    """What export() has written."""

    plan: _prowl.Plan
    motion: str  #: "plan" or "simulation"
    samples: int
    end: float  #: time of the last sample [s]
    has_gains: bool
    folder: str
    files: dict[str, int]  #: names, with their sizes [bytes]


def export(
    directory: str | os.PathLike[str],
    formats: str | Sequence[str],
    *,
    out: str | os.PathLike[str] | None = None,
    rate: float | None = None,
    simulation: bool = False,
    package_dirs: Sequence[str | os.PathLike[str]] = (),
) -> Export:
    """Writes the plan in a folder for other programs, as `prowl export` does.

    formats: one or more of "csv", "json", "npz", "mcap", "joint-trajectory" and "mujoco". out: folder for the files, which
    may hold others; DIRECTORY/exports if None. rate: samples a second; the nodes of the plan, or all rows of the
    simulation, if None. simulation: the true motion of simulate.csv in place of the plan. package_dirs: as of read_task().

    Needs numpy, for "mcap" also mcap and mcap-ros2-support. Warns of a plan that is not good. Raises InputError, FileError;
    files that were there are replaced one by one, each whole or not at all.
    """
    folder = os.fspath(directory)
    names = [formats] if isinstance(formats, str) else list(formats)
    for name in names:
        if name not in _prowl.export_format_names():
            choices = ", ".join(_prowl.export_format_names())
            raise _prowl.InputError(f"format: {name} is not allowed; need one of {choices}")
    plan = _prowl.read_plan(folder, [os.fspath(path) for path in package_dirs])
    if simulation and "csv" in names:
        simulated = os.path.join(folder, "simulate.csv")
        raise _prowl.InputError(f"format: csv is not allowed; of a simulation there is {simulated} already")

    from .samples import sample_plan, sample_simulation  # with numpy

    samples = sample_simulation(plan, rate) if simulation else sample_plan(plan, rate)
    if not plan.good:
        certificate = "passed" if plan.certificate.passed else "failed"
        warnings.warn(f"this plan is not good: {plan.status}, certificate {certificate}", stacklevel=2)
    files = _files(plan, samples, set(names), rate)
    place = os.path.join(folder, "exports") if out is None else os.fspath(out)
    _prowl.write_files(place, files)
    return Export(
        plan,
        "simulation" if simulation else "plan",
        len(samples.motion),
        float(samples.motion.t[-1]),
        samples.gains is not None,
        place,
        {name: len(files[name]) for name in sorted(files)},
    )


def _files(plan: _prowl.Plan, samples, formats: set[str], rate: float | None) -> dict[str, bytes]:
    """Files of all formats, by name."""
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
            from . import mcap

            in_parent = plan.robot.link_placements(samples.motion.q, in_parent=True).tolist()
            files[f"{prefix}motion.mcap"] = mcap.write(document, in_parent, samples.one_a_time(), plan.robot.urdf_text)
    return {name: text.encode() if isinstance(text, str) else text for name, text in files.items()}
