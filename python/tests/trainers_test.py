"""What trainers read: body poses and velocities against MuJoCo's, the dataset against the library, the environment."""

import json

import gymnasium
import mujoco
import numpy as np
import pandas
import prowl.gym
import pyarrow.parquet as pq
import pytest
from gymnasium.utils.env_checker import check_env
from prowl._trainers.bodies import body_motion, order_of

import prowl

JOB = {
    "task": "go2/crouch",
    "count": 4,
    "seed": 2,
    "draw": [{"key": "goal[0].base_displacement_m[2]", "uniform": [-0.08, -0.02]}],
}


@pytest.fixture(scope="module")
def library(tmp_path_factory):
    library = prowl.batch(JOB, tmp_path_factory.mktemp("trainers") / "library", workers=2, progress=False)
    assert library.kept == 4
    return library


@pytest.fixture(scope="module")
def npz(library, tmp_path_factory):
    folder = tmp_path_factory.mktemp("mjlab") / "out"
    names = library.write("mjlab", folder)
    assert names == [f"motion_{i:05d}.npz" for i in range(4)]
    return folder


class Replay:
    """A model of MuJoCo at the states of a file."""

    def __init__(self, xml: str):
        self.model = mujoco.MjModel.from_xml_string(xml)
        self.data = mujoco.MjData(self.model)

    def set(self, robot, q, v):
        """A state of Prowl: the base's twist is in its axes."""
        data, model = self.data, self.model
        data.qpos[:7] = [*q[:3], q[6], *q[3:6]]
        mujoco.mju_rotVecQuat(data.qvel[:3], np.ascontiguousarray(v[:3]), np.ascontiguousarray(data.qpos[3:7]))
        data.qvel[3:6] = v[3:6]
        for name, position, velocity in zip(robot.joint_names, q[7:], v[6:], strict=True):
            joint = model.joint(name).id
            data.qpos[model.jnt_qposadr[joint]] = position
            data.qvel[model.jnt_dofadr[joint]] = velocity
        mujoco.mj_forward(model, data)

    def body(self, body):
        velocity = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, body, velocity, 0)
        return self.data.xpos[body], self.data.xquat[body], velocity[3:], velocity[:3]


def largest_errors(replay, robot, states, arrays, bodies):
    """Of position, orientation, linear and angular velocity over some states: sample, q, v. bodies: those of MuJoCo for
    each of the arrays'."""
    errors = np.zeros(4)
    for k, q, v in states:
        replay.set(robot, q, v)
        for i, body in enumerate(bodies):
            position, turn, linear, angular = replay.body(body)
            errors = np.maximum(
                errors,
                [
                    np.abs(position - arrays["body_pos_w"][k, i]).max(),
                    1 - abs(turn @ arrays["body_quat_w"][k, i]),
                    np.abs(linear - arrays["body_lin_vel_w"][k, i]).max(),
                    np.abs(angular - arrays["body_ang_vel_w"][k, i]).max(),
                ],
            )
    return errors


def test_bodies_are_where_mujoco_has_them(library, npz):
    task, motion = library.base_task(), library.arrays(2)
    arrays = dict(np.load(npz / "motion_00002.npz"))
    replay = Replay(task.mujoco_xml())
    assert list(arrays["body_names"][:5]) == ["base", "FL_hip", "FL_thigh", "FL_calf", "FR_hip"]
    bodies = list(range(1, replay.model.nbody))
    assert len(bodies) == len(arrays["body_names"]) == 13
    states = [(k, motion["q"][k], motion["v"][k]) for k in range(0, len(motion["t"]), 9)]
    assert (largest_errors(replay, task.robot, states, arrays, bodies) < [1e-6, 1e-6, 2e-5, 2e-5]).all()
    # The test sees an order that is wrong.
    assert largest_errors(replay, task.robot, states, arrays, [1, 3, 2, *bodies[3:]])[0] > 0.05
    for k, q, v in states:
        for i, name in enumerate(arrays["joint_names"]):
            joint = task.robot.joint_names.index(name)
            assert arrays["joint_pos"][k, i] == np.float32(q[7 + joint])
            assert arrays["joint_vel"][k, i] == np.float32(v[6 + joint])
    assert list(arrays["joint_names"]) == [replay.model.joint(i).name for i in range(1, replay.model.njnt)]


@pytest.mark.parametrize("name", ["hyq", "talos"])
def test_random_states_of_other_robots(name):
    robot = prowl.read_robot(name)
    document = {"robot": name, "phase": [{"contacts": "all", "duration_s": 1.0}]}
    xml = prowl.parse_task(document).mujoco_xml()
    order, rng = order_of(robot, xml), np.random.default_rng(3)
    q = prowl.integrate(np.tile(robot.nominal_configuration, (5, 1)), 0.3 * rng.standard_normal((5, robot.nv)))
    v = rng.standard_normal((5, robot.nv))
    found = body_motion(robot, q, v, order.bodies)
    arrays = {
        "body_pos_w": found.position,
        "body_quat_w": found.quaternion,
        "body_lin_vel_w": found.linear_velocity,
        "body_ang_vel_w": found.angular_velocity,
    }
    replay = Replay(xml)
    bodies = range(1, replay.model.nbody)
    assert len(order.bodies) == len(bodies)
    errors = largest_errors(replay, robot, list(zip(range(5), q, v)), arrays, bodies)
    assert (errors < [1e-9, 1e-9, 1e-7, 1e-7]).all()


def test_the_rate_may_differ_from_the_librarys(library, tmp_path):
    library.write("mjlab", tmp_path / "fast", rate=100)
    fast = np.load(tmp_path / "fast/motion_00001.npz")
    motion = library.arrays(1)
    assert fast["fps"] == 100 and len(fast["joint_pos"]) == 201
    joints = [prowl.read_robot("go2").joint_names.index(name) for name in fast["joint_names"]]
    assert np.allclose(fast["joint_pos"][::2], motion["q"][:, 7:][:, joints], atol=1e-6)


def test_the_dataset_has_all_motions(library, tmp_path):
    folder = tmp_path / "dataset"
    assert set(library.write("lerobot", folder)) == {
        "data/chunk-000/file-000.parquet",
        "meta/episodes/chunk-000/file-000.parquet",
        "meta/info.json",
        "meta/stats.json",
        "meta/tasks.parquet",
    }
    info = json.loads((folder / "meta/info.json").read_text())
    data = pq.read_table(folder / "data/chunk-000/file-000.parquet")
    episodes = pq.read_table(folder / "meta/episodes/chunk-000/file-000.parquet").to_pylist()
    assert info["total_frames"] == data.num_rows == episodes[-1]["dataset_to_index"]
    assert set(info["features"]) == set(data.column_names)
    assert pandas.read_parquet(folder / "meta/tasks.parquet").index.to_list() == ["crouch"]
    for episode in episodes:
        motion = library.arrays(episode["episode_index"])
        rows = data.slice(episode["dataset_from_index"], episode["length"])
        state = np.array(rows["observation.state"].to_pylist())
        assert np.allclose(state, np.hstack([motion["q"], motion["v"]]), atol=1e-5)
        assert np.allclose(np.array(rows["action"].to_pylist()), motion["tau"], rtol=1e-6, atol=1e-5)
        assert np.allclose(rows["timestamp"].to_numpy(), motion["t"], atol=1e-6)
    assert len(info["features"]["observation.state"]["names"]) == state.shape[1]


def test_a_folder_with_files_is_refused(library, tmp_path):
    (tmp_path / "mine.txt").write_text("")
    with pytest.raises(prowl.InputError, match="not empty"):
        library.write("mjlab", tmp_path)
    with pytest.raises(prowl.InputError, match="need one of mjlab, lerobot"):
        library.write("rlds", tmp_path / "other")


def test_a_model_of_another_robot_is_refused(library, tmp_path):
    own, model = library.base_task().mujoco_xml(), tmp_path / "other.xml"
    other = prowl.parse_task({"robot": "hyq", "phase": [{"contacts": "all", "duration_s": 1.0}]}).mujoco_xml()
    extra = own.replace('<joint name="FL_hip_joint"', '<joint name="odd" axis="1 0 0"/><joint name="FL_hip_joint"')
    for text, message in (
        (other, "body 'lf_haa_joint' is none of Go2"),
        (own.replace('<body name="base"', '<body name="torso"'), "body 'torso' is none of Go2"),
        (extra, "joint 'odd' is none of Go2"),
        ("no xml", "no XML"),
    ):
        assert text != own
        model.write_text(text)
        with pytest.raises(prowl.InputError, match=message):
            library.write("mjlab", tmp_path / "out", model=model)
    assert not (tmp_path / "out").exists()


@pytest.fixture
def env(library):
    with gymnasium.make("prowl/TrackMotion-v0", library=library.folder) as made:
        yield made


@pytest.mark.filterwarnings("ignore:.*A Box observation space")
def test_the_environment_is_one(env):
    check_env(env.unwrapped, skip_render_check=True)


def test_the_motion_itself_is_rewarded(env):
    rewards = []
    env.reset(seed=5, options={"motion": 3})
    truncated = False
    while not truncated:
        _, reward, terminated, truncated, info = env.step(np.zeros(12, dtype=np.float32))
        assert not terminated and info["motion"] == 3
        rewards.append(reward)
    assert np.mean(rewards) > 0.95


def test_other_actions_are_rewarded_less_and_a_fall_ends_the_episode(env):
    env.reset(seed=5)
    terminated, rewards = False, []
    for _ in range(100):
        _, reward, terminated, truncated, _ = env.step(np.ones(12, dtype=np.float32))
        rewards.append(reward)
        if terminated or truncated:
            break
    assert terminated and np.mean(rewards) < 0.6


def test_the_same_seed_gives_the_same_episode(env):
    def run():
        observation, _ = env.reset(seed=9)
        return [observation] + [env.step(0.1 * np.ones(12, dtype=np.float32))[0] for _ in range(20)]

    assert np.array_equal(run(), run())


def test_each_motion_takes_place_on_its_own_ground(tmp_path):
    job = JOB | {"count": 6, "draw": [{"key": "surface[0].friction", "one_of": [0.4, 0.7]}]}
    drawn = prowl.batch(job, tmp_path / "library", workers=2, progress=False)
    frictions = drawn.index["surface[0].friction"].to_pylist()
    assert set(frictions) == {0.4, 0.7}
    with gymnasium.make("prowl/TrackMotion-v0", library=drawn.folder) as made:
        for index, friction in enumerate(frictions):
            made.reset(options={"motion": index})
            ground = made.unwrapped._now.plant.model.geom_friction[:, 0]
            assert friction in ground


def test_motions_of_several_robots_are_no_dataset(tmp_path):
    robots = [str(prowl.read_robot(name).path) for name in ("go2", "hyq")]
    (tmp_path / "still.toml").write_text(
        f'robot = "{robots[0]}"\n[[phase]]\ncontacts = "all"\nduration_s = 0.5\n[cost]\njoint_acceleration = 0.001\n'
    )
    task = str(tmp_path / "still.toml")
    job = {"task": task, "count": 8, "seed": 2, "draw": [{"key": "robot", "one_of": robots}]}
    mixed = prowl.batch(job, tmp_path / "library", workers=2, progress=False)
    kept = mixed.index.filter(mixed.index["kept"])
    assert set(kept["robot"].to_pylist()) == set(robots)
    with pytest.raises(prowl.InputError, match="motions of robots with other joints"):
        mixed.write("mjlab", tmp_path / "out")
