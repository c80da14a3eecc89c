"""The wheel of scripts/wheel: what is in it, and that it runs in a clean Debian without compiler and network.

As root: the clean Debian is a root folder made by mmdebstrap, entered with chroot in a network namespace of its own.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import zipfile
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parent.parent.parent
PROJECT = tomllib.loads((SOURCE / "pyproject.toml").read_text())
EXTRAS = ("solvers", "figures", "formats")
TASKS = ("hyq/crouch", "anymal_c/crouch", "go2/crouch", "solo12/crouch", "talos/squat")


def run(*command, **options):
    result = subprocess.run(list(map(str, command)), check=False, capture_output=True, text=True, **options)
    assert result.returncode == 0, f"{command}\n{result.stdout}\n{result.stderr}"
    return result.stdout


@pytest.fixture(scope="module")
def folder():
    """Outside of the clone, removed at the end."""
    with tempfile.TemporaryDirectory(prefix="prowl_wheel_") as name:
        yield Path(name)


@pytest.fixture(scope="module")
def wheel(folder) -> Path:
    subprocess.run([SOURCE / "scripts/wheel", folder / "wheels"], check=True, stdout=sys.stderr)
    (wheel,) = (folder / "wheels").glob("prowl-*.whl")
    return wheel


@pytest.fixture(scope="module")
def unpacked(folder, wheel) -> Path:
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder / "unpacked")
    return folder / "unpacked"


def normal(pin: str) -> str:
    return pin.lower().replace("_", "-")


def test_pins_are_those_of_requirements():
    known = {normal(line) for line in (SOURCE / "requirements.txt").read_text().split() if "==" in line}
    assert set(map(normal, PROJECT["build-system"]["requires"])) <= known
    extras = PROJECT["project"]["optional-dependencies"]
    assert {normal(*extras["solvers"]), normal(*extras["robots"])} <= known, "built against is run with"


def test_it_is_small_and_for_old_systems(wheel):
    assert wheel.stat().st_size < 60e6
    assert wheel.name.endswith("-cp311-cp311-manylinux_2_35_x86_64.whl")


def test_it_has_types_and_licences(unpacked):
    assert (unpacked / "prowl/py.typed").is_file() and (unpacked / "prowl/_prowl.pyi").is_file()
    licences = {path.stem for path in (unpacked / "prowl/share/doc/prowl/licences").iterdir()}
    known = tuple(licences | {"octomath", "z-"})  # part of OctoMap; zlib's is in its binary
    names = [path.name.removeprefix("lib") for path in unpacked.glob("prowl.libs/*")]
    assert len(names) > 10
    assert not [name for name in names if not name.startswith(known)]
    assert (unpacked / "prowl/share/example-robot-data/robots/hyq_description/LICENSE").is_file()


def test_no_other_library_can_take_its_symbols(unpacked):
    for path in unpacked.glob("prowl.libs/*"):
        assert re.search(r"-[0-9a-f]{8}\.so", path.name), f"{path.name} may be mixed up with another version"
    entries = {"prowl/_prowl*.so": "PyInit__prowl", "prowl/lib/libprowl_formulations.so": "prowl_make_formulation"}
    entries |= {f"prowl/lib/libprowl_{solver}.so": "prowl_make_solver" for solver in ("ipopt", "fatrop", "uno")}
    assert {*unpacked.glob("prowl/lib/*.so")} < {path for pattern in entries for path in unpacked.glob(pattern)}
    for pattern, entry in entries.items():
        (module,) = unpacked.glob(pattern)
        shown = run("nm", "--dynamic", "--defined-only", "--format=just-symbols", module).split()
        assert shown == [entry], module


SOLVE = "import prowl; p = prowl.solve('hyq/crouch', gains=False); print(p.q.tobytes().hex()[:4000], p.good)"
OTHERS = "import crocoddyl, numpy, pinocchio; m = pinocchio.buildSampleModelHumanoid(); d = m.createData()"
THEIRS = "print(pinocchio.rnea(m, d, pinocchio.neutral(m), numpy.ones(m.nv), numpy.ones(m.nv)).tobytes().hex())"


def test_it_lives_beside_other_versions_of_its_libraries(unpacked):
    peers = SOURCE / ".venv-peers/bin/python"
    if not peers.exists():
        pytest.skip("PROWL_WITH_PEERS=1 scripts/setup installs other versions of Pinocchio")
    environment = {**os.environ, "PYTHONPATH": str(unpacked), "OPENBLAS_NUM_THREADS": "1"}

    def say(script):
        return run(peers, "-c", script, env=environment).split("\n")

    ours, theirs = say(SOLVE)[0], say(f"{OTHERS}; {THEIRS}")[0]
    assert ours.endswith("True")
    assert say(f"{OTHERS}; {SOLVE}; {THEIRS}")[:2] == [ours, theirs]
    assert say(f"{SOLVE}; {OTHERS}; {THEIRS}")[:2] == [ours, theirs]


@pytest.fixture(scope="module")
def wheelhouse(folder, wheel) -> Path:
    extras = PROJECT["project"]["optional-dependencies"]
    needed = [*PROJECT["project"]["dependencies"], *(pin for name in EXTRAS for pin in extras[name]), "pip"]
    run(sys.executable, "-m", "pip", "download", "--quiet", "--only-binary", ":all:", "-d", wheel.parent, *needed)
    return wheel.parent


class CleanMachine:
    """A minimal Debian with Python: no compiler, no pip, no network."""

    def __init__(self, root: Path):
        self.root = root
        run("mmdebstrap", "--variant=minbase", "--include=python3", "--quiet", "bookworm", root)

    def run(self, *command: str) -> str:
        (self.root / "work").mkdir(exist_ok=True)
        enter = ["unshare", "--net", "--pid", "--fork", f"--mount-proc={self.root}/proc", "chroot", self.root]
        clean = ["env", "--ignore-environment", "--chdir=/work", "PATH=/usr/local/bin:/usr/bin:/bin", "LANG=C.UTF-8"]
        return run(*enter, *clean, "MPLBACKEND=Agg", *command)

    def install(self, *what: str) -> None:
        (pip,) = (self.root / "wheels").glob("pip-*.whl")
        options = ["--no-index", "--find-links", "/wheels", "--break-system-packages", "--root-user-action", "ignore"]
        self.run("python3", f"/wheels/{pip.name}/pip", "install", "--quiet", *options, *what)

    def megabytes(self) -> float:
        return int(run("du", "--summarize", "--block-size=1", self.root / "usr/local").split()[0]) / 1e6


@pytest.fixture(scope="module")
def machine(folder, wheelhouse) -> CleanMachine:
    assert os.geteuid() == 0, "only root can make a clean machine"
    machine = CleanMachine(folder / "debian")
    shutil.copytree(wheelhouse, machine.root / "wheels")
    before, start = machine.megabytes(), time.monotonic()
    machine.install("prowl")
    machine.run("prowl", "plan", "hyq/crouch", "--out", "first")
    print(f"wheel to first plan: {time.monotonic() - start:.0f} s; installed {machine.megabytes() - before:.0f} MB")
    assert machine.megabytes() - before < 250
    return machine


def test_the_machine_is_clean(machine):
    for name in ("g++", "cc", "pip", "cmake"):
        assert not list(machine.root.glob(f"usr/*bin/{name}*")), name
    assert machine.run("cat", "/proc/net/dev").count(":") == 1, "the loopback alone"


def test_doctor(machine):
    found = machine.run("prowl", "doctor")
    assert "Riccati" in found and 'pip install "prowl[solvers]"' in found


@pytest.mark.parametrize("task", TASKS)
def test_a_plan_of_each_robot(machine, task):
    assert "certificate: passed" in machine.run("prowl", "plan", task, "--out", f"out/{task}")


def test_simulation_and_report(machine):
    assert "success" in machine.run("prowl", "simulate", "first")
    machine.run("prowl", "report", "first")
    page = (machine.root / "work/first/report.html").read_text()
    assert "<!doctype html>" in page[:200].lower() and len(page) > 1e6, "with the meshes of the robot"


def test_a_robot_of_ones_own(machine):
    (package,) = machine.root.glob("usr/local/lib/python3*/dist-packages/prowl")
    inside = "/" + str((package / "share/example-robot-data/robots/solo_description").relative_to(machine.root))
    machine.run("prowl", "new", "robot", f"{inside}/robots/solo12.urdf", "--out", "mine/solo.toml")
    machine.run("prowl", "new", "task", "mine/solo.toml", "--kind", "crouch", "--out", "mine/crouch.toml")
    assert "certificate: passed" in machine.run("prowl", "plan", "mine/crouch.toml", "--out", "mine/plan")


def test_python(machine):
    script = "import prowl; p = prowl.solve('hyq/crouch'); assert p.good; print(prowl.simulate(p).success)"
    assert machine.run("python3", "-c", script).strip() == "True"
    figures = "import prowl; prowl.figures('first')"
    missing = "\n".join(("try:", f"    {figures}", "except prowl.InputError as error: print(error)"))
    assert "prowl[figures]" in machine.run("python3", "-c", f"import prowl\n{missing}")


def test_other_formulations(machine):
    found = machine.run(
        "prowl", "compare", "hyq/hold", "--formulation", "inverse,forward,centroidal", "--intervals", "5"
    )
    assert found.count("the Riccati solver needs a problem that is a chain of stages") == 2, "they are built; no solver"


def test_a_solver_that_is_not_there(machine):
    say = "import prowl\ntry: prowl.solve('hyq/crouch', solver='ipopt')\nexcept prowl.InputError as error: print(error)"
    assert 'pip install "prowl[solvers]"' in machine.run("python3", "-c", say)


def test_with_all_extras(machine):
    machine.install(f"prowl[{','.join(EXTRAS)}]")
    for solver in ("ipopt", "fatrop", "uno"):
        assert solver in machine.run("prowl", "doctor").lower()
    assert "certificate: passed" in machine.run("prowl", "plan", "hyq/crouch", "--solver", "ipopt", "--out", "ipopt")
    machine.run("prowl", "figures", "first")
    machine.run("prowl", "export", "first", "--format", "npz,mcap")
    shutil.copy(SOURCE / "python/notebooks/first_plan.py", machine.root / "work")
    assert "lowest point: -17.0 cm" in machine.run("python3", "first_plan.py")


def test_pip_alone_says_what_to_do():
    environment = {**os.environ, "PIP_NO_INPUT": "1"}
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        str(SOURCE),
        "--no-deps",
        "--no-build-isolation",
        "-w",
        "/nonexistent",
    ]
    result = subprocess.run(command, check=False, capture_output=True, text=True, env=environment)
    assert result.returncode != 0 and "Run scripts/wheel" in result.stdout + result.stderr
