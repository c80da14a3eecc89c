"""`pip install .` in an environment with nothing else: the wheel finds its libraries, robot, tasks and tools by itself.

Built without isolation, with the libraries and compiler of the build that runs this, so that ccache has the objects already.
"""

import os
import re
import subprocess
import sys
import tempfile
import tomllib
import venv
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parent.parent.parent
CLEAN = {"PATH": "/usr/bin:/bin", "HOME": "/nonexistent", "MPLBACKEND": "Agg", "LANG": "C.UTF-8"}


def normal(pin: str) -> str:
    return pin.lower().replace("_", "-")


def test_pins_are_those_of_requirements():
    known = {normal(line) for line in (SOURCE / "requirements.txt").read_text().split() if "==" in line}
    project = tomllib.loads((SOURCE / "pyproject.toml").read_text())
    build, run = project["build-system"]["requires"], project["project"]["dependencies"]
    pinned = [pin for pin in run if "==" in pin]
    assert set(map(normal, build)) <= known
    assert len(pinned) > 10 and set(pinned) <= set(build), "what was built against is what is run with"
    (robots,) = project["project"]["optional-dependencies"]["robots"]
    assert normal(robots) in known
    assert f'"{robots}"' in (SOURCE / "python/prowl/_files.py").read_text(), "what the message says"


@pytest.fixture(scope="module")
def folder():
    """Outside of the clone, removed at the end: an environment takes 0.8 GB."""
    with tempfile.TemporaryDirectory(prefix="prowl_wheel_") as name:
        yield Path(name)


@pytest.fixture(scope="module")
def environment(folder) -> Path:
    build = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        SOURCE,
        "--no-deps",
        "--no-build-isolation",
        "--no-input",
        "--disable-pip-version-check",
        f"-Cbuild-dir={os.environ['PROWL_WHEEL_BUILD']}",
        "-w",
        folder / "wheels",
    ]
    subprocess.run(build, check=True, stdout=sys.stderr)
    (wheel,) = (folder / "wheels").glob("prowl-*.whl")
    venv.create(folder / "venv", with_pip=True)
    subprocess.run(
        [
            folder / "venv/bin/pip",
            "install",
            "--no-input",
            "--disable-pip-version-check",
            "--quiet",
            "--retries",
            "5",
            "--timeout",
            "60",
            wheel,
        ],
        check=True,
        stdout=sys.stderr,
    )
    return folder / "venv"


def run(environment: Path, *command: str | Path) -> str:
    """In the clean environment, elsewhere, with no variable that could help."""
    work = environment.parent / "work"
    work.mkdir(exist_ok=True)
    program, *arguments = command
    result = subprocess.run(
        [environment / "bin" / program, *arguments], cwd=work, env=CLEAN, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_all_its_libraries_are_in_the_environment_or_the_systems(environment):
    (package,) = environment.glob("lib/python3*/site-packages/prowl")
    programs = [package / "bin/prowl", *package.glob("_prowl*.so"), *package.glob("lib/lib*.so*")]
    assert len(programs) > 12
    for program in programs:
        listed = subprocess.run(["ldd", program], env=CLEAN, capture_output=True, text=True, check=True).stdout
        assert "not found" not in listed, listed
        for path in re.findall(r"=> (/\S+)", listed):
            assert path.startswith((f"{environment}/", "/lib/", "/lib64/", "/usr/lib/")), f"{program} takes {path}"
        ours = [
            line
            for line in listed.splitlines()
            if re.search(r"lib(fmt|tomlplusplus|meshoptimizer|prowl|pinocchio|ipopt|mujoco)", line)
        ]
        assert all(str(environment) in line for line in ours), listed


def test_it_has_types_and_licences(environment):
    (package,) = environment.glob("lib/python3*/site-packages/prowl")
    for name in (
        "py.typed",
        "_prowl.pyi",
        "share/example-robot-data/robots/hyq_description/LICENSE",
        *(
            f"share/doc/prowl/licences/{library}.txt"
            for library in ("nanobind", "fmt", "tomlplusplus", "meshoptimizer")
        ),
    ):
        assert (package / name).is_file(), name


def test_python_and_what_it_loads(environment):
    script = (
        "import prowl; task = prowl.read_task('hyq/crouch');"
        "plan = prowl.solve(task, solver='ipopt', threads=2); assert plan.good, plan.summary();"
        "assert prowl.simulate(plan).success; print(task.path);"
        "print(*{line.split()[-1] for line in open('/proc/self/maps') if '.so' in line}, sep='\\n')"
    )
    task, *loaded = run(environment, "python", "-c", script).split()
    assert task.startswith(str(environment)) and any("libpinocchio" in path for path in loaded)
    assert not [path for path in loaded if path.startswith(str(SOURCE))]


def test_robots_that_it_does_not_bring(environment):
    script = "import prowl\ntry: prowl.read_task('go2/crouch')\nexcept prowl.InputError as error: print(error)"
    assert "pip install example-robot-data" in run(environment, "python", "-c", script)


def test_the_command(environment):
    assert "Pinocchio" in run(environment, "prowl", "--version")
    task = run(environment, "python", "-c", "import prowl; print(prowl.read_task('hyq/crouch').path)").strip()
    assert "certificate: passed" in run(environment, "prowl", "plan", task, "--out", "out")
    assert "success" in run(environment, "prowl", "simulate", "out")
    run(environment, "prowl", "figures", "out")
    assert (environment.parent / "work/out/figures").is_dir()
    run(environment, "prowl", "export", "out", "--format", "npz,mcap")
    assert {"motion.npz", "motion.mcap"} <= {path.name for path in (environment.parent / "work/out/exports").iterdir()}
    run(environment, "prowl", "report", "out")
    assert "<!doctype html>" in (environment.parent / "work/out/report.html").read_text()[:200].lower()


def test_the_first_notebook(environment):
    assert "lowest point: -17.0 cm" in run(environment, "python", SOURCE / "python/notebooks/first_plan.py")
