"""Verbs of the command that this package implements. `prowl figures`, `export`, `batch`, `library`, `retarget` and `mpc --foxglove` run this file
(cli/verbs/python_verb.cpp):

    _verb.py VERB OPTIONS

Prints one JSON object per line: {"progress": [done, total, plural name, note]} (the note may be missing), {"message": text},
{"note": text} (not with --quiet), {"event": name, ...}, and at the end {"error":
text, "kind": as in docs/command-line.md}, or {"result": object, "text": the same for people}.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import sys
import warnings

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))

LIBRARIES = {  # of each verb: what it needs, and the extra of the wheel that brings it
    "figures": ("numpy, scipy and matplotlib", "figures"),
    "export": ("numpy, mcap and mcap-ros2-support", "formats"),
    "batch": ("dask, distributed and pyarrow", "batch"),
    "library": ("pyarrow", "batch"),
    "retarget": ("numpy", "notebook"),
    "mpc": ("numpy, foxglove-sdk and mcap-ros2-support", "foxglove"),
}


SHOWN = 600.0  # duration of a live run without --duration [s]


def _say(**line: object) -> None:
    text = json.dumps(line, ensure_ascii=False) + "\n"
    # File names may not be UTF-8, but JSON must be.
    sys.stdout.buffer.write(text.encode("utf-8", "surrogateescape").decode("utf-8", "replace").encode())
    sys.stdout.buffer.flush()


def _result(plan: object, directory: str, written: list[str], text: str, **more: object) -> None:
    about = {"directory": os.path.abspath(directory), "name": plan.task.name, "robot": plan.robot.name}
    _say(result={**about, "written": written, **more}, text=text)


def _figures(options: argparse.Namespace) -> None:
    import prowl

    drawn = prowl.figures(
        options.directory,
        out=options.out,
        joint=options.joint,
        package_dirs=options.package_dir,
        allow_libraries=options.allow_libraries,
        on_progress=lambda done, total: _say(progress=[done, total, "figures"]),
    )
    text = f"{', '.join(drawn.names)}\nwritten to {drawn.folder}, each as .svg, .png and .csv\n"
    paths = [os.path.join(drawn.folder, name) for name in drawn.files]
    _result(drawn.plan, options.directory, paths, text, figures=drawn.names)


def _export(options: argparse.Namespace) -> None:
    import prowl

    done = prowl.export(
        options.directory,
        options.format,
        out=options.out,
        rate=options.rate,
        simulation=options.simulation,
        package_dirs=options.package_dir,
        allow_libraries=options.allow_libraries,
    )
    paths = {os.path.join(done.folder, name): size for name, size in done.files.items()}
    text = "".join(f"{1e-3 * size:>10.1f} kB  {path}\n" for path, size in paths.items())
    text += f"{done.samples} samples of the {done.motion}, {done.end:g} s\n"
    _result(
        done.plan,
        options.directory,
        list(paths),
        text,
        motion=done.motion,
        samples=done.samples,
        has_gains=done.has_gains,
        files=[{"name": name, "bytes": size} for name, size in done.files.items()],
    )


def _summary(library: object) -> tuple[str, dict[str, object]]:
    """For people, and the same as data."""
    grades, causes = library.grades(), library.causes()
    lines = [f"{library.count} motions, {library.done} done, {library.kept} kept"]
    lines += [f"{count:>8}  {grade}" for grade, count in grades.items()]
    lines += [f"{count:>8}  failed: {cause}" for cause, count in causes.items()]
    lines.append(f"sha256 {library.sha256()}")
    data = {"count": library.count, "done": library.done, "kept": library.kept, "grades": grades, "causes": causes}
    return "\n".join(lines) + "\n", data


def _so_far(progress: object) -> str:
    """Share that is kept, and the most frequent causes of failure, in ASCII."""
    if not progress.done:
        return ""
    causes = sorted(progress.causes.items(), key=lambda cause: -cause[1])[:3]
    parts = [f"{100 * progress.kept / progress.done:.0f} % kept", *(f"{count} {name}" for name, count in causes)]
    return ", ".join(parts).encode("ascii", "replace").decode()


def _batch(options: argparse.Namespace) -> None:
    import prowl

    job = options.directory
    out = options.out or os.path.join("out", os.path.splitext(os.path.basename(job))[0])
    tls = {"tls_ca_file": options.tls_ca, "tls_client_cert": options.tls_cert, "tls_client_key": options.tls_key}
    last = None

    def tell(progress: object) -> None:
        nonlocal last
        if last is None and progress.dashboard:
            _say(note=f"Dask's dashboard: {progress.dashboard}")
        last = progress
        _say(progress=[progress.done, progress.total, "motions", _so_far(progress)])
        _say(
            event="progress",
            done=progress.done,
            total=progress.total,
            kept=progress.kept,
            causes=progress.causes,
            unfinished=progress.unfinished,
            rate=progress.rate,
        )

    try:
        library = prowl.batch(
            job,
            out,
            workers=options.workers,
            scheduler=options.scheduler,
            tls={key: value for key, value in tls.items() if value} or None,
            package_dirs=options.package_dir,
            progress=False,
            on_progress=tell,
        )
    except KeyboardInterrupt:
        _say(message="stopped; repeat the command to resume")
        signal.signal(signal.SIGINT, signal.SIG_DFL)
        os.kill(os.getpid(), signal.SIGINT)
        raise
    text, data = _summary(library)
    rate = f", {last.rate:.3g} motions a second" if last.done_here else ""
    text += f"written to {out}{rate}\n"
    if last.unfinished:
        text += f"{last.unfinished} motions took longer than the job allows; the same command tries them again\n"
    _say(result={"directory": os.path.abspath(out), "exit_status": 6 if last.unfinished else 0, **data}, text=text)


def _library(options: argparse.Namespace) -> None:
    import prowl

    library = prowl.read_library(options.directory)
    if options.motion is not None:
        folder = options.out or os.path.join(
            os.path.dirname(os.path.abspath(options.directory)), f"motion_{options.motion}"
        )
        plan = library.plan(options.motion)
        plan.write(folder)
        _say(result={"directory": os.path.abspath(folder)}, text=f"{plan.summary()}written to {folder}\n")
        return
    if options.format:
        name = f"{os.path.basename(os.path.abspath(options.directory))}_{options.format[0]}"
        folder = options.out or os.path.join(os.path.dirname(os.path.abspath(options.directory)), name)
        names = library.write(
            options.format[0],
            folder,
            rate=options.rate,
            on_progress=lambda done, total: _say(progress=[done, total, "motions"]),
        )
        _say(result={"directory": os.path.abspath(folder), "written": names}, text=f"{len(names)} files in {folder}\n")
        return
    text, data = _summary(library)
    if options.page:
        library.write_page(options.page)
        text += f"written to {options.page}\n"
    _say(result={"directory": os.path.abspath(options.directory), **data}, text=text)


def _retarget(options: argparse.Namespace) -> None:
    import prowl

    motion = options.directory
    folder = options.out or os.path.join("out", os.path.splitext(os.path.basename(motion))[0])
    result = prowl.retarget(
        motion,
        options.robot,
        out=folder,
        fps=options.fps,
        slowest=options.slowest,
        package_dirs=options.package_dir,
    )
    plan = os.path.join(folder, "plan")
    _say(
        result={
            "directory": os.path.abspath(folder),
            "exit_status": 0 if result.followed else 3,
            "followed": result.followed,
            "joint_rms_rad": result.joint_rms if result.plan.status == "converged" else None,
            "time_scale": result.time_scale,
            "reasons": result.reasons,
            "flaws": result.flaws,
            "grade": result.plan.certificate.grade,
        },
        text=f"{result.summary()}written to {plan}, with task.toml and reference.csv beside it\n",
    )


def _mpc(options: argparse.Namespace) -> None:
    """With --foxglove; else the command itself runs."""
    import prowl

    robot = prowl.read_robot(options.directory, package_dirs=options.package_dir)
    given = {
        name: value
        for name in ("gait", "script", "late", "kicks", "random_commands", "friction", "mass", "noise", "seed")
        if (value := getattr(options, name)) is not None
    }
    given |= {
        name: 1e-3 * value for name in ("period", "budget", "delay") if (value := getattr(options, name)) is not None
    }
    with prowl.Foxglove(robot, options.port) as server:
        _say(message=f"{server.url}: open it in Foxglove as a Foxglove WebSocket. Ctrl-C ends the run.")
        run = prowl.run_online(
            robot,
            command=tuple(options.command or (0.0, 0.0, 0.0)),
            duration=options.duration,
            perfect_state=options.perfect_state,
            watch=server,
            package_dirs=options.package_dir,
            **given,
        )
    _say(result={**json.loads(run.to_json()), "exit_status": 0 if run.success else 8}, text=run.summary())


def _options() -> argparse.Namespace:
    """Options, checked and explained by the command."""
    parser = argparse.ArgumentParser()
    parser.error = lambda text: sys.exit(_say(error=text.removeprefix("argument "), kind="input"))
    parser.add_argument("verb", choices=LIBRARIES)
    parser.add_argument("directory")
    parser.add_argument("--out")
    parser.add_argument("--package-dir", action="append", default=[])
    parser.add_argument("--allow-libraries", action="store_true")
    parser.add_argument("--joint")
    parser.add_argument("--format", action="append")
    parser.add_argument("--rate", type=float)
    parser.add_argument("--simulation", action="store_true")
    parser.add_argument("--workers", type=int)
    parser.add_argument("--scheduler")
    for name in ("ca", "cert", "key"):
        parser.add_argument(f"--tls-{name}")
    parser.add_argument("--motion", type=int)
    parser.add_argument("--page")
    parser.add_argument("--robot")
    parser.add_argument("--fps", type=float)
    parser.add_argument("--slowest", type=float, default=1.0)
    for name in ("gait", "script", "late"):
        parser.add_argument(f"--{name}")
    for name in ("period", "budget", "delay", "kicks", "random-commands", "friction", "mass", "noise"):
        parser.add_argument(f"--{name}", type=float)
    parser.add_argument("--command", type=float, action="append")
    parser.add_argument("--duration", type=float, default=SHOWN)
    parser.add_argument("--seed", type=int)
    parser.add_argument("--port", type=int, default=8765)
    for name in ("foxglove", "perfect-state"):
        parser.add_argument(f"--{name}", action="store_true")
    return parser.parse_args()


def _run(options: argparse.Namespace) -> None:
    import prowl
    from prowl._processes import die_with_parent

    die_with_parent()
    warnings.showwarning = lambda message, *_, **__: _say(message=f"warning: {message}")
    kinds = {
        prowl.InputError: "input",
        prowl.FileError: "files",
        prowl.NumericalError: "numerical",
        OSError: "files",
    }
    try:
        verbs = {
            "figures": _figures,
            "export": _export,
            "batch": _batch,
            "library": _library,
            "retarget": _retarget,
            "mpc": _mpc,
        }
        verbs[options.verb](options)
    except tuple(kinds) as error:
        if isinstance(error.__cause__, ModuleNotFoundError):
            raise error.__cause__ from None
        is_option = str(error).startswith(
            ("format: ", "joint: ", "rate: ", "scheduler: ", "slowest: ")
        )  # named like the argument of the function
        kind = next(kind for base, kind in kinds.items() if isinstance(error, base))
        _say(error=f"{'--' if is_option else ''}{error}", kind=kind)


def main() -> None:
    options = _options()
    if options.verb != "batch":  # which closes its library
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        _run(options)
    except ModuleNotFoundError as error:
        writes = options.verb == "library" and options.format
        libraries, extra = ("pandas and pyarrow", "trainers") if writes else LIBRARIES[options.verb]
        needed = f'need a Python with {libraries}: pip install "prowl[{extra}]", or --python PATH'
        _say(error=f"{sys.executable}: {error.name} is missing; {needed}", kind="input")
    except ImportError as error:  # compiled module or its libraries are missing
        _say(error=str(error), kind="files")


if __name__ == "__main__":
    main()
