"""Samples of a motion with a switch of contacts: nodes or a rate, gains on both sides of the switch. export() as a function."""

import math
import tomllib

import numpy as np
import pytest

import prowl
from prowl._exports.samples import sample_plan


@pytest.fixture(scope="module")
def step() -> prowl.Plan:
    return prowl.solve(prowl.read_task("hyq/step"), progress=False)


def test_at_the_nodes_gains_are_those_of_the_phase(step):
    samples = sample_plan(step, None)
    np.testing.assert_array_equal(samples.motion.q, step.q)
    assert not samples.simulated
    switches = np.flatnonzero(np.diff(step.phase))
    assert switches.size >= 2
    for i, t in enumerate(step.t[:-1]):  # at the end the tracker goes on standing
        K = step.tracker.gains(math.nextafter(t, 0) if i in switches else t)
        assert np.linalg.norm(samples.gains[i] - K) < 1e-9 * np.linalg.norm(K)
        if i in switches:
            change = np.linalg.norm(samples.gains[i + 1] - samples.gains[i])
            assert change > 1e-3 * np.linalg.norm(K), "other contacts, other gains"
            assert np.any(samples.in_contact[i + 1] != samples.in_contact[i])
    once = samples.one_a_time()
    assert len(once) + switches.size == len(step)
    assert np.all(np.diff(step.t[once]) > 0) and not set(once) & set(switches)


def test_at_a_rate_samples_are_the_trajectory(step):
    samples = sample_plan(step, 90.0)
    count = math.ceil(step.duration * 90 - 1e-9) + 1
    np.testing.assert_allclose(samples.motion.t, np.minimum(np.arange(count) / 90, step.duration), atol=1e-12)
    np.testing.assert_array_equal(samples.motion.tau, step.at(samples.motion.t).tau)
    assert samples.one_a_time() == list(range(count))


def test_a_plan_without_gains_has_none():
    task = prowl.read_task("hyq/stand")
    assert sample_plan(prowl.solve(task, gains=False, progress=False), 90.0).gains is None


@pytest.mark.parametrize("rate", [0.0, -1.0, math.nan, math.inf, 1e9])
def test_a_rate_that_makes_no_sense_is_refused(step, rate):
    with pytest.raises(prowl.InputError, match="^rate: "):
        sample_plan(step, rate)


def test_export_of_a_folder(crouch, tmp_path):
    crouch.write(tmp_path / "plan")
    done = prowl.export(tmp_path / "plan", "csv")
    assert (done.motion, done.samples, done.has_gains, done.end) == ("plan", len(crouch), True, crouch.duration)
    assert done.files == {path.name: path.stat().st_size for path in (tmp_path / "plan/exports").iterdir()}
    assert (tmp_path / "plan/exports/motion.csv").read_text() == (tmp_path / "plan/trajectory.csv").read_text()
    several = prowl.export(tmp_path / "plan", ["json", "mujoco"], rate=50, out=tmp_path / "out")
    assert list(several.files) == ["motion.json", "mujoco.xml", "mujoco_keyframes.xml", "mujoco_model.xml"]
    with pytest.raises(prowl.InputError, match="^format: cvs is not allowed; need one of csv, json"):
        prowl.export(tmp_path / "plan", "cvs")
    with pytest.raises(prowl.InputError, match="first prowl simulate"):
        prowl.export(tmp_path / "plan", "npz", simulation=True)
    with pytest.raises(prowl.FileError, match="cannot create this folder"):
        prowl.export(tmp_path / "plan", "csv", out="/dev/null")


def test_export_warns_of_a_mesh_that_cannot_be_read(hyq, tmp_path):
    (tmp_path / "hyq.urdf").write_text(hyq.urdf_text.replace("meshes/trunk/trunk.dae", "meshes/trunk/none.dae"))
    robot = prowl.parse_robot(tomllib.loads(hyq.text) | {"urdf": "hyq.urdf"}, folder=tmp_path)
    task = tomllib.loads(prowl.read_task("hyq/hold").text) | {"robot": robot}
    plan = prowl.solve(prowl.parse_task(task, folder=tmp_path), gains=False, progress=False)
    with pytest.warns(UserWarning, match="^link trunk: drawn as a box of its inertia: .*none.dae"):
        prowl.export(plan, "mujoco", out=tmp_path / "out")
    assert 'type="box"' in (tmp_path / "out/mujoco.xml").read_text()


def test_export_warns_of_a_plan_that_is_not_good(tmp_path):
    task = prowl.read_task("hyq/step", intervals=250, max_iterations=2)
    prowl.solve(task, coarse_first=False, progress=False).write(tmp_path / "plan")
    with pytest.warns(UserWarning, match="^this plan is not good: iteration_limit, certificate failed"):
        assert not prowl.export(tmp_path / "plan", "csv").has_gains
