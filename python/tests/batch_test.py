"""Libraries of motions: the same whatever happens while they are made, readable by all, true to the plans."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import duckdb
import numpy as np
import pandas
import polars
import psutil
import pytest

import prowl

JOB = {
    "task": "go2/crouch",
    "count": 14,
    "seed": 3,
    "shard": 6,
    "draw": [
        {"key": "goal[0].base_displacement_m[2]", "uniform": [-0.1, -0.02]},
        {"key": ["goal[0].base_displacement_m[0]", "goal[0].base_displacement_m[1]"], "normal": [0.0, 0.01]},
        {"key": "surface[0].friction", "one_of": [0.4, 0.6]},
    ],
}


ENVIRONMENT = os.environ | {"PYTHONPATH": str(Path(prowl.__file__).resolve().parents[1])}  #: of programs elsewhere


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    return prowl.batch(JOB, tmp_path_factory.mktemp("batch") / "library", workers=2, progress=False)


def write_job(path: Path, job: dict) -> Path:
    import tomli_w

    path.write_text(tomli_w.dumps(job))
    return path


def test_it_has_all_motions_in_order(library):
    index = library.index
    assert index["index"].to_pylist() == list(range(14))
    assert library.kept + sum(library.causes().values()) == library.done == library.count == 14
    assert library.kept >= 12
    assert index["goal[0].base_displacement_m[2]"].to_pylist() == [library.job.values(i)[0] for i in range(14)]


def test_a_motion_is_the_plan_of_its_task(library):
    kept = [row["index"] for row in library.index.to_pylist() if row["kept"]]
    index = kept[-1]
    plan, samples = library.plan(index), library.samples(index)
    assert plan.cost == library.index["cost"][index].as_py()
    motion = plan.sample(1 / 50)
    assert samples["t"].to_numpy().tolist() == motion.t.tolist()
    for name in ("q", "v", "a", "tau"):
        assert np.array_equal(np.array(samples[name].to_pylist()), getattr(motion, name)), name
    assert np.array_equal(np.array(samples["f"].to_pylist()), motion.f.reshape(len(motion.t), -1))
    # The goal is where the draw puts it.
    depth = library.index["goal[0].base_displacement_m[2]"][index].as_py()
    assert plan.at([1.0]).q[0, 2] - plan.q[0, 2] == pytest.approx(depth, abs=1e-3)


def test_others_read_it_in_one_line(library):
    path = library.folder / "index.parquet"
    assert len(pandas.read_parquet(path)) == 14
    assert polars.read_parquet(path)["kept"].sum() == library.kept
    assert duckdb.sql(f"select count(*) from '{path}' where kept").fetchall() == [(library.kept,)]
    assert len(pandas.read_parquet(library.folder / "motions", columns=["index", "t"])) > 14 * 50
    samples = library.folder / "motions" / "*.parquet"
    assert duckdb.sql(f"select count(distinct index) from '{samples}'").fetchall() == [(library.kept,)]


def test_it_is_the_same_with_one_worker_and_after_a_loss(library, tmp_path):
    other = prowl.batch(JOB, tmp_path / "other", workers=1, progress=False)
    assert other.sha256() == library.sha256()
    # What is gone is made again, and no more than that.
    (other.folder / "index" / "00001.parquet").unlink()
    (other.folder / "index.parquet").unlink()
    first = (other.folder / "index" / "00000.parquet").stat().st_mtime_ns
    seen = []
    prowl.batch(JOB, tmp_path / "other", workers=2, progress=False, on_progress=lambda now: seen.append(now.done))
    assert seen[0] == 8 and seen[-1] == 14
    assert (other.folder / "index" / "00000.parquet").stat().st_mtime_ns == first
    assert other.sha256() == library.sha256()


def is_worker(process: psutil.Process) -> bool:
    try:
        return "spawn_main" in " ".join(process.cmdline())
    except psutil.NoSuchProcess:  # it has just died
        return False


def descendants() -> list[psutil.Process]:
    return [child for child in psutil.Process().children(recursive=True) if is_worker(child)]


def test_workers_may_die(library, tmp_path):
    killed = []

    def kill_one(progress):
        workers = descendants()
        if len(killed) < 4 and workers:
            killed.append(workers[len(killed) % len(workers)].pid)
            os.kill(killed[-1], signal.SIGKILL)

    again = prowl.batch(JOB, tmp_path / "again", workers=2, progress=False, on_progress=kill_one)
    assert len(killed) >= 2
    assert again.sha256() == library.sha256()


def test_the_client_may_die(library, tmp_path):
    job = write_job(tmp_path / "job.toml", JOB)
    line = [os.environ["PROWL_COMMAND"], "batch", str(job), "--out", str(tmp_path / "out"), "--workers", "2", "--quiet"]
    index = tmp_path / "out" / "index"
    for shards in (0, 1):  # as soon as the library begins, and with a part of it
        running = subprocess.Popen(line, stdout=subprocess.DEVNULL)
        while not index.exists() or len(list(index.glob("*.parquet"))) < shards:
            assert running.poll() is None
            time.sleep(0.02)
        running.kill()
        running.wait()
        assert len(list(index.glob("*.parquet"))) < 3
    done = subprocess.run([*line[:-1], "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "% kept" in done.stderr
    result = json.loads(done.stdout[done.stdout.index("{\n") :])
    assert result["done"] == 14 and result["kept"] == library.kept
    # The texts of the jobs differ in the order of their keys.
    (tmp_path / "out" / "job.toml").write_bytes((library.folder / "job.toml").read_bytes())
    assert prowl.read_library(tmp_path / "out").sha256() == library.sha256()


@pytest.fixture
def cluster(tmp_path):
    """Scheduler and two workers as programs of their own, with TLS; the certificates."""
    files = {name: tmp_path / name for name in ("key.pem", "cert.pem", "scheduler.json")}
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=prowl",
         "-keyout", files["key.pem"], "-out", files["cert.pem"]],
        check=True,
        capture_output=True,
    )  # fmt: skip
    tls = ["--tls-ca-file", files["cert.pem"], "--tls-cert", files["cert.pem"], "--tls-key", files["key.pem"]]
    dask = [sys.executable, "-m", "dask"]
    programs = [
        [*dask, "scheduler", "--protocol", "tls", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
         "--scheduler-file", files["scheduler.json"], *tls],
        *[[*dask, "worker", "--scheduler-file", files["scheduler.json"], "--nthreads", "1", "--no-dashboard", *tls]] * 2,
    ]  # fmt: skip
    running = [
        subprocess.Popen(list(map(str, program)), env=ENVIRONMENT, stderr=subprocess.DEVNULL, cwd=tmp_path)
        for program in programs
    ]
    for _ in range(300):
        if files["scheduler.json"].exists() and files["scheduler.json"].read_text():
            break
        time.sleep(0.1)
    yield json.loads(files["scheduler.json"].read_text())["address"], files["cert.pem"], files["key.pem"]
    for program in running:
        program.kill()
        program.wait()


def test_scheduler_and_workers_may_be_programs_of_their_own(library, cluster, tmp_path):
    address, certificate, key = cluster
    assert address.startswith("tls://")
    tls = {"tls_ca_file": str(certificate), "tls_client_cert": str(certificate), "tls_client_key": str(key)}
    far = prowl.batch(JOB, tmp_path / "far", scheduler=address, tls=tls, progress=False)
    assert far.sha256() == library.sha256()


def test_the_scheduler_may_die(library, cluster, tmp_path):
    address, certificate, key = cluster
    tls = {"tls_ca_file": str(certificate), "tls_client_cert": str(certificate), "tls_client_key": str(key)}

    def kill(progress):
        if progress.done >= 6:
            for process in psutil.Process().children():
                if "scheduler" in process.cmdline():
                    process.kill()

    with pytest.raises(prowl.Error, match="the scheduler is gone; repeat the command to resume"):
        prowl.batch(JOB, tmp_path / "far", scheduler=address, tls=tls, progress=False, on_progress=kill)
    assert 0 < prowl.read_library(tmp_path / "far").done < 14
    assert prowl.batch(JOB, tmp_path / "far", workers=2, progress=False).sha256() == library.sha256()


def test_a_scheduler_that_is_not_there_is_named(tmp_path):
    with pytest.raises(prowl.InputError, match="scheduler: tls://127.0.0.1:9 and a worker of it cannot be reached"):
        prowl.batch(JOB, tmp_path / "far", scheduler="tls://127.0.0.1:9", progress=False)


def test_what_takes_too_long_is_left_out(tmp_path):
    seen = []
    made = prowl.batch(
        JOB | {"count": 2, "hang_s": 0.01}, tmp_path / "library", workers=1, progress=False, on_progress=seen.append
    )
    assert made.done == 0 and seen[-1].unfinished == 2 and seen[-1].done == 0
    assert not (made.folder / "index.parquet").exists()


def test_an_interrupted_begin_goes_on(library, tmp_path):
    (tmp_path / "begun" / "index").mkdir(parents=True)
    (tmp_path / "begun" / "job.toml").write_text("half")
    (tmp_path / "begun" / ".task.toml.unfinished").write_text("half")
    made = prowl.batch(JOB | {"count": 2}, tmp_path / "begun", workers=1, progress=False)
    assert made.done == 2


def test_another_machine_is_refused(library, tmp_path):
    import shutil

    shutil.copytree(library.folder, tmp_path / "copy")
    about = json.loads((tmp_path / "copy" / "library.json").read_text())
    about["versions"]["Riccati"] = "0"
    (tmp_path / "copy" / "library.json").write_text(json.dumps(about))
    other = prowl.read_library(tmp_path / "copy")
    assert other.kept == library.kept, "it can be read"
    with pytest.raises(prowl.InputError, match="this machine has Riccati 1, not 0"):
        other.plan(0)
    with pytest.raises(prowl.InputError, match="of another job, version or machine"):
        prowl.batch(JOB, tmp_path / "copy", progress=False)
    about["versions"]["Riccati"] = "1"
    about["files_sha256"] = "0"
    (tmp_path / "copy" / "library.json").write_text(json.dumps(about))
    with pytest.raises(prowl.InputError, match="another robot file, URDF or reference"):
        prowl.read_library(tmp_path / "copy").plan(0)


def test_one_batch_at_a_time(library):
    with library.lock(), pytest.raises(prowl.FileError, match="another batch writes this library"):
        prowl.batch(JOB, library.folder, progress=False)


def test_failures_are_rows_with_a_cause(tmp_path):
    job = JOB | {"count": 6, "shard": 6, "draw": [{"key": "goal[0].base_displacement_m[2]", "one_of": [-0.05, 0.6]}]}
    made = prowl.batch(job, tmp_path / "library", workers=2, progress=False)
    rows = made.index.to_pylist()
    high = [row for row in rows if row["goal[0].base_displacement_m[2]"] > 0]
    assert 0 < len(high) < 6
    assert all(row["kept"] is (row not in high) for row in rows)
    assert all(row["cause"] == "infeasible" and "out of reach" in row["diagnosis"] for row in high)
    assert all(made.samples(row["index"]).num_rows == 0 for row in high)
    assert made.causes() == {"infeasible": len(high)}


def test_gains_and_simulations_are_kept(tmp_path):
    job = JOB | {"count": 2, "gains": True, "simulation": True, "rate_hz": 20.0}
    made = prowl.batch(job, tmp_path / "library", workers=2, progress=False)
    assert made.index["simulated"].to_pylist() == [True, True]
    kept = made.index.filter(made.index["kept"])["index"].to_pylist()
    assert kept
    samples = made.samples(kept[0])
    robot = prowl.read_robot("go2")
    assert {len(gains) for gains in samples["gains"].to_pylist()} == {robot.nu * 2 * robot.nv}


def test_another_job_is_refused(library):
    with pytest.raises(prowl.InputError, match="of another job"):
        prowl.batch(JOB | {"seed": 4}, library.folder, progress=False)


def test_no_library_is_refused(tmp_path):
    with pytest.raises(prowl.InputError, match="no library of motions"):
        prowl.read_library(tmp_path)
    (tmp_path / "library.json").write_text('{"format": 99}')
    with pytest.raises(prowl.InputError, match="format 99"):
        prowl.read_library(tmp_path)
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "mine.txt").write_text("mine")
    with pytest.raises(prowl.InputError, match="not empty"):
        prowl.batch(JOB, tmp_path / "other", progress=False)


def test_mistakes_are_found_before_the_first_motion(tmp_path, command):
    job = write_job(tmp_path / "job.toml", JOB | {"draw": [{"key": "goal[0].time_z", "uniform": [0.5, 1.0]}]})
    with pytest.raises(prowl.InputError, match=r"job.toml:7:7: draw\[0\].key: .*'time_s'"):
        prowl.batch(job, tmp_path / "out", progress=False)
    assert not (tmp_path / "out").exists()
    failed = subprocess.run([os.environ["PROWL_COMMAND"], "batch", job], capture_output=True, text=True)
    assert failed.returncode == 2 and "job.toml:7:7: draw[0].key: " in failed.stderr


FULL_DISK = """
import sys
import prowl
copy = prowl.read_library(sys.argv[1])
try:
    copy.write_shard(0, copy.index, copy.samples(0))
except prowl.FileError as error:
    print(error)
print(prowl.read_library(sys.argv[1]).done)
"""


def test_a_full_disk_keeps_what_is_complete(library, tmp_path):
    """On a disk of its own, which takes the right to mount one."""
    copy = prowl.batch(JOB | {"count": 6}, tmp_path / "copy", workers=1, progress=False)
    (tmp_path / "disk").mkdir()
    line = (
        "mount -t tmpfs -o size=4m none disk && cp -r copy disk && { dd if=/dev/zero of=disk/rest bs=4k 2>/dev/null; "
    )
    line += f"{sys.executable} -c '{FULL_DISK}' disk/copy; ls -A disk/copy disk/copy/motions; }}"
    if subprocess.run(["unshare", "-m", "true"]).returncode != 0:
        pytest.skip("needs root, or the right to mount")
    full = subprocess.run(
        ["unshare", "-m", "sh", "-c", line], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True
    )
    said, done, listed = full.stdout.partition("\n6\n")
    assert "No space left on device; what is complete is kept" in said, full.stderr
    assert done and "00000.parquet" in listed and ".prowl" not in listed
    assert copy.done == 6


def test_a_motion_that_ends_its_process_runs_alone_with_limited_memory(library, monkeypatch):
    from prowl._batch import alone
    from prowl._batch.tables import from_bytes

    block = alone.plan_alone(library.text, 2, library.job)
    row = from_bytes(block.index).to_pylist()[0]
    assert row == library.index.to_pylist()[2]
    monkeypatch.setattr(alone, "MEMORY", 64 << 20)
    block = alone.plan_alone(library.text, 2, library.job)
    assert from_bytes(block.index)["cause"].to_pylist() == ["out of memory"]


def test_a_reference_belongs_to_the_library(tmp_path):
    robot = prowl.read_robot("go2")
    q = ",".join(map(str, robot.nominal_configuration))
    names = ["time_s", *(f"base_{a}" for a in ("px_m", "py_m", "pz_m", "qx", "qy", "qz", "qw"))]
    names += [f"q_{joint}_rad" for joint in robot.joint_names]
    reference = tmp_path / "still.csv"
    reference.write_text(f"{','.join(names)}\n0,{q}\n1,{q}\n")
    task = tmp_path / "still.toml"
    task.write_text(
        f'robot = "{robot.path}"\n[[phase]]\ncontacts = "all"\nduration_s = 1.0\n'
        '[reference]\nfile = "still.csv"\njoint_position = 10\n[cost]\njoint_acceleration = 0.001\n'
    )
    job = {"task": os.fspath(task), "count": 2, "draw": [{"key": "reference.joint_position", "uniform": [1.0, 20.0]}]}
    library = prowl.batch(job, tmp_path / "library", workers=1, progress=False)
    assert library.kept == 2 and library.plan(1).task.reference_text == reference.read_text()
    reference.write_text(reference.read_text().replace("\n1,", "\n1.5,"))
    with pytest.raises(prowl.InputError, match="another robot file, URDF or reference"):
        prowl.read_library(library.folder).plan(1)


def test_motions_are_refined_to_the_grade_asked(tmp_path):
    job = {"task": "go2/crouch", "count": 2, "grade": "certified"}
    library = prowl.batch(job, tmp_path / "library", workers=2, progress=False)
    assert library.grades() == {"certified": 2}
    plan = library.plan(1)
    assert plan.certificate.grade == "certified" and plan.cost == library.index["cost"][1].as_py()


def test_a_script_needs_no_guard(tmp_path):
    (tmp_path / "script.py").write_text(
        "import prowl\n"
        "library = prowl.batch({'task': 'go2/crouch', 'count': 2}, 'library', workers=1, progress=False)\n"
        "print(library.kept, 'kept', __file__)\n"
    )
    command = [sys.executable, "script.py"]
    done = subprocess.run(command, cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, timeout=120)
    assert done.stdout.split() == ["2", "kept", os.fspath(tmp_path / "script.py")], done.stdout + done.stderr


def test_the_page_counts_outcomes(library, tmp_path):
    library.write_page(tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    start = page.index('id="prowl-data">') + len('id="prowl-data">')
    data = json.loads(page[start : page.index("</script>", start)])
    assert (data["asked"], data["done"], data["kept"]) == (14, 14, library.kept)
    assert sum(outcome["count"] for outcome in data["outcomes"]) == 14
    torque = next(margin for margin in data["margins"] if margin["name"] == "joint torque")
    assert sum(torque["counts"]["kept"]) == library.kept and 0 < torque["edges"][-1] < 1.01
    depth = data["draws"][0]
    assert sum(depth["counts"]["kept"]) + sum(depth["counts"]["failed"]) == 14
