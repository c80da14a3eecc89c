"""What prowl export writes of a step of HyQ, with feet that lift and land: every file read back by somebody else's reader and held
against trajectory.csv, simulate.csv and the URDF.

    exports_test.py PROWL ROBOTS_DATA
"""

import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import mujoco
import numpy as np
from exports_support import ROOT, Urdf, columns, of_seven, placement, read_csv, read_mcap, rotation, run_or_fail, xyz

AXES = "xyz"
TWIST = [f"base_{c}_{unit}" for c, unit in zip(("vx", "vy", "vz", "wx", "wy", "wz"), ["mps"] * 3 + ["radps"] * 3)]
POSE = ["base_px_m", "base_py_m", "base_pz_m", "base_qx", "base_qy", "base_qz", "base_qw"]


class Exports(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.plan = pathlib.Path(cls.folder.name) / "a plan; with 'odd' name"
        run_or_fail("plan", ROOT / "tasks/hyq/step.toml", "--out", cls.plan)
        run_or_fail("simulate", cls.plan, "--record-rate", 200)
        run_or_fail("export", cls.plan, "--format", "csv,json,npz,mcap,joint-trajectory,mujoco")
        cls.out = cls.plan / "exports"
        run_or_fail(
            "export", cls.plan, "--format", "json,npz,mcap,joint-trajectory,mujoco", "--simulation", "--rate", 50
        )
        cls.json = json.loads((cls.plan / "plan.json").read_text())
        cls.joints = cls.json["problem"]["joints"]
        cls.nodes = read_csv(cls.plan / "trajectory.csv")
        cls.contacts = [name.removeprefix("contact_") for name in cls.nodes if name.startswith("contact_")]
        cls.urdf = Urdf(cls.json["urdf"]["text"])

    def quantities(self, table) -> dict[str, np.ndarray]:
        """q, v, a, tau, f of a table with the columns of trajectory.csv."""
        rates = [
            n.replace("mps", "mps2").replace("radps", "radps2").replace("_v", "_a").replace("_w", "_dw") for n in TWIST
        ]
        names = {
            "q": POSE + [f"q_{j}_rad" for j in self.joints],
            "v": TWIST + [f"v_{j}_radps" for j in self.joints],
            "a": rates + [f"a_{j}_radps2" for j in self.joints],
            "tau": [f"tau_{j}_Nm" for j in self.joints],
        }
        result = {name: columns(table, parts) for name, parts in names.items()}
        result["f"] = np.stack([columns(table, [f"f_{c}_{axis}_N" for axis in AXES]) for c in self.contacts], axis=1)
        return result

    def links_in_world(self, q: np.ndarray) -> dict[str, np.ndarray]:
        base, angles = of_seven(q[:7]), dict(zip(self.joints, q[7:]))
        return {link: self.urdf.in_world(link, base, angles) for link in self.urdf.links}

    def test_csv_at_the_nodes_is_trajectory_csv(self):
        self.assertEqual((self.out / "motion.csv").read_bytes(), (self.plan / "trajectory.csv").read_bytes())

    def test_csv_at_a_rate_lies_between_the_nodes(self):
        out = self.plan.with_name("rate")
        run_or_fail("export", self.plan, "--format", "csv", "--rate", 123, "--out", out)
        rows, gains = read_csv(out / "motion.csv"), read_csv(out / "gains.csv")
        end = self.nodes["time_s"][-1]
        np.testing.assert_allclose(rows["time_s"][:-1], np.arange(len(rows["time_s"]) - 1) / 123, atol=1e-12)
        self.assertEqual(rows["time_s"][-1], end)
        np.testing.assert_array_equal(gains["time_s"], rows["time_s"])
        self.assertGreater(len(set(rows["phase"])), 2)
        for phase in set(rows["phase"]):
            of_rows, of_nodes = rows["phase"] == phase, self.nodes["phase"] == phase
            for joint in self.joints:
                expected = np.interp(
                    rows["time_s"][of_rows], self.nodes["time_s"][of_nodes], self.nodes[f"tau_{joint}_Nm"][of_nodes]
                )
                np.testing.assert_allclose(rows[f"tau_{joint}_Nm"][of_rows], expected, atol=1e-9)

    def test_npz_is_the_trajectory(self):
        with np.load(self.out / "motion.npz", allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        expected = self.quantities(self.nodes)
        np.testing.assert_array_equal(arrays["t"], self.nodes["time_s"])
        np.testing.assert_array_equal(arrays["phase"], self.nodes["phase"])
        for name, values in expected.items():
            np.testing.assert_array_equal(arrays[name], values, name)
        np.testing.assert_array_equal(
            arrays["in_contact"], columns(self.nodes, [f"contact_{c}" for c in self.contacts]) == 1
        )
        self.assertEqual(arrays["joints"].tolist(), self.joints)
        self.assertEqual(arrays["contacts"].tolist(), self.contacts)
        self.assertEqual(arrays["phases"].tolist(), [p["name"] for p in self.json["problem"]["phases"]])
        self.assertEqual((str(arrays["robot"]), str(arrays["motion"]), bool(arrays["good"])), ("HyQ", "plan", True))
        for p, phase in enumerate(self.json["problem"]["phases"]):
            self.assertEqual(
                [c for c, held in zip(self.contacts, arrays["phase_contacts"][p]) if held], phase["contacts"]
            )
        nv = 6 + len(self.joints)
        self.assertEqual(arrays["K"].shape, (len(arrays["t"]), len(self.joints), 2 * nv))
        gains = read_csv(self.out / "gains.csv")
        names = [f"{joint}:{column}" for joint in self.joints for column in arrays["K_names"]]
        self.assertEqual(list(gains), ["time_s", "phase", *names])
        np.testing.assert_array_equal(arrays["K"].reshape(len(arrays["t"]), -1), columns(gains, names))
        self.assertGreater(np.abs(arrays["K"]).max(), 1.0)

    def test_json_places_links_as_the_urdf_says(self):
        motion = json.loads((self.out / "motion.json").read_text())
        samples = motion["samples"]
        links = {link["name"]: link for link in motion["links"]}
        self.assertEqual(set(links), set(self.urdf.links))
        for name, link in links.items():
            self.assertEqual((link["parent"], link["fixed"]), (self.urdf.parent(name), self.urdf.fixed(name)))
        q = self.quantities(self.nodes)["q"]
        np.testing.assert_array_equal(samples["q"], q)
        for i in range(0, len(q), 7):
            world = self.links_in_world(q[i])
            for link, seven in zip(motion["links"], samples["link_placement"][i]):
                np.testing.assert_allclose(of_seven(seven), world[link["name"]], atol=1e-9, err_msg=link["name"])
            for contact, point in zip(motion["contacts"], samples["contact_position_m"][i]):
                np.testing.assert_allclose(point, world[contact][:3, 3], atol=1e-9)  # of HyQ: the links' origins

    def test_json_tells_contacts_and_forces(self):
        motion = json.loads((self.out / "motion.json").read_text())
        samples, end = motion["samples"], 0.0
        for p, phase in enumerate(motion["phases"]):
            self.assertEqual(phase["start_s"], end)
            end = phase["end_s"]
            self.assertEqual([c["contact"] for c in phase["contacts"]], self.json["problem"]["phases"][p]["contacts"])
            self.assertEqual({c["surface"] for c in phase["contacts"]}, {s["name"] for s in motion["surfaces"]})
        self.assertEqual(end, self.nodes["time_s"][-1])
        np.testing.assert_array_equal(samples["force_N"], self.quantities(self.nodes)["f"])
        held = np.array(samples["in_contact"])
        self.assertFalse(held.all())
        self.assertTrue(np.all(np.array(samples["force_N"])[~held] == 0))
        # A foot that stands has its ball on the floor.
        height = np.array(samples["contact_position_m"])[:, :, 2]
        self.assertLess(np.abs(height[held] - 0.02175).max(), 1e-3)
        self.assertGreater(height[~held].max(), 0.05)
        self.assertEqual(len(motion["components"]["q"]), len(samples["q"][0]))
        self.assertEqual(motion["components"]["a"][3:6], ["base_dwx_radps2", "base_dwy_radps2", "base_dwz_radps2"])

    def check_mcap(self, path, motion, times):
        topics, summary, metadata = read_mcap(path)
        types = {topic: messages[0][0] for topic, messages in topics.items()}
        self.assertEqual(
            types,
            {
                "/robot_description": "std_msgs/msg/String",
                "/tf_static": "tf2_msgs/msg/TFMessage",
                "/tf": "tf2_msgs/msg/TFMessage",
                "/joint_states": "sensor_msgs/msg/JointState",
                "/odom": "nav_msgs/msg/Odometry",
                **{f"/contacts/{c}": "geometry_msgs/msg/WrenchStamped" for c in self.contacts},
            },
        )
        self.assertEqual(metadata["prowl"]["robot"], "HyQ")
        self.assertEqual({c.message_encoding for c in summary.channels.values()}, {"cdr"})
        self.assertEqual(topics["/robot_description"][0][2].data, self.json["urdf"]["text"])
        samples = {name: np.array(values) for name, values in motion["samples"].items() if values is not None}
        stamps = np.round(1e9 * times).astype(np.int64)
        for topic in ("/tf", "/joint_states", "/odom", *(f"/contacts/{c}" for c in self.contacts)):
            self.assertEqual([log_time for _, log_time, _ in topics[topic]], stamps.tolist())
        # At a switch of phases the later one's, of two samples at one time.
        index = [int(np.flatnonzero(samples["time_s"] == t)[-1]) for t in times]
        held = {t.child_frame_id: t for t in topics["/tf_static"][0][2].transforms}
        for k, i in enumerate(index):
            state, odometry = topics["/joint_states"][k][2], topics["/odom"][k][2]
            self.assertEqual(state.header.stamp.sec * 10**9 + state.header.stamp.nanosec, stamps[k])
            self.assertEqual(state.name, self.joints)
            np.testing.assert_array_equal(state.position, samples["q"][i][7:])
            np.testing.assert_array_equal(state.velocity, samples["v"][i][6:])
            np.testing.assert_array_equal(state.effort, samples["tau"][i])
            pose, twist = odometry.pose.pose, odometry.twist.twist
            self.assertEqual((odometry.header.frame_id, odometry.child_frame_id), ("world", motion["links"][0]["name"]))
            np.testing.assert_array_equal(
                xyz(pose.position) + xyz(pose.orientation) + [pose.orientation.w], samples["q"][i][:7]
            )
            np.testing.assert_array_equal(xyz(twist.linear) + xyz(twist.angular), samples["v"][i][:6])
            for c, contact in enumerate(self.contacts):
                wrench = topics[f"/contacts/{contact}"][k][2]
                self.assertEqual(wrench.header.frame_id, f"contact_{contact}")
                np.testing.assert_array_equal(xyz(wrench.wrench.force), samples["force_N"][i][c])
                self.assertEqual(xyz(wrench.wrench.torque), [0, 0, 0])
            if k % 10 == 0:
                self.check_transforms(
                    topics["/tf"][k][2].transforms, held, samples["q"][i], samples["contact_position_m"][i]
                )

    def check_transforms(self, moving, held, q, contacts):
        """Along the tree from the world, every link is where the URDF puts it, and every contact frame is there with world axes."""
        tree = {**held, **{t.child_frame_id: t for t in moving}}
        self.assertFalse(set(held) & {t.child_frame_id for t in moving})

        def in_world(frame: str) -> np.ndarray:
            if frame == "world":
                return np.eye(4)
            t = tree[frame].transform
            return in_world(tree[frame].header.frame_id) @ of_seven(
                xyz(t.translation) + xyz(t.rotation) + [t.rotation.w]
            )

        for link, expected in self.links_in_world(q).items():
            np.testing.assert_allclose(in_world(link), expected, atol=1e-9, err_msg=link)
        for contact, position in zip(self.contacts, contacts):
            np.testing.assert_allclose(in_world(f"contact_{contact}"), placement(position, np.eye(3)), atol=1e-12)
        self.assertEqual(len(tree), len(self.urdf.links) + len(self.contacts))

    def test_mcap_plays_the_plan(self):
        motion = json.loads((self.out / "motion.json").read_text())
        self.check_mcap(self.out / "motion.mcap", motion, np.unique(self.nodes["time_s"]))

    def test_mcap_plays_the_simulation(self):
        motion = json.loads((self.out / "simulated_motion.json").read_text())
        self.check_mcap(self.out / "simulated_motion.mcap", motion, np.array(motion["samples"]["time_s"]))

    def test_mcap_definitions_lead_to_no_unknown_type(self):
        _, summary, _ = read_mcap(self.out / "motion.mcap")
        for schema in summary.schemas.values():
            self.assertEqual(schema.encoding, "ros2msg")
            text = schema.data.decode()
            known = {line.removeprefix("MSG: ") for line in text.splitlines() if line.startswith("MSG: ")}
            used = {line.split()[0].split("[")[0] for line in text.splitlines() if line and line[0] not in "=M"}
            self.assertEqual({u for u in used if "/" in u}, known, schema.name)

    def test_joint_trajectory_is_what_ros_wants(self):
        message = json.loads((self.out / "joint_trajectory.json").read_text())
        self.assertEqual(message["joint_names"], self.joints)
        last = {t: i for i, t in enumerate(self.nodes["time_s"])}  # of two at one time the later phase's
        expected, points = self.quantities(self.nodes), message["points"]
        self.assertEqual(len(points), len(last))
        times = [p["time_from_start"]["sec"] + 1e-9 * p["time_from_start"]["nanosec"] for p in points]
        self.assertTrue(np.all(np.diff(times) > 0))
        np.testing.assert_allclose(times, list(last), atol=1e-9)
        for point, i in zip(points, last.values()):
            self.assertTrue(0 <= point["time_from_start"]["nanosec"] < 10**9)
            np.testing.assert_array_equal(point["positions"], expected["q"][i][7:])
            np.testing.assert_array_equal(point["velocities"], expected["v"][i][6:])
            np.testing.assert_array_equal(point["accelerations"], expected["a"][i][6:])
            np.testing.assert_array_equal(point["effort"], expected["tau"][i])

    def test_keyframes_are_in_mujocos_conventions(self):
        """That MuJoCo loads them with the model, and bodies move as they should, is what tests/plan_folder/mujoco_keyframes_test.cpp tests."""
        keys = ElementTree.parse(self.out / "mujoco_keyframes.xml").getroot()
        self.assertEqual(keys.find("include").get("file"), "mujoco_model.xml")
        expected = self.quantities(self.nodes)
        found = list(keys.iter("key"))
        self.assertEqual(len(found), len(self.nodes["time_s"]))
        self.assertEqual(len({key.get("name") for key in found}), len(found))
        for key, t, q, v, tau in zip(found, self.nodes["time_s"], expected["q"], expected["v"], expected["tau"]):
            numbers = {name: np.array(key.get(name).split(), dtype=float) for name in ("time", "qpos", "qvel", "ctrl")}
            self.assertEqual(numbers["time"], t)
            np.testing.assert_array_equal(numbers["qpos"], [*q[:3], q[6], *q[3:6], *q[7:]])
            np.testing.assert_allclose(numbers["qvel"][:3], rotation(q[3:7]) @ v[:3], atol=1e-9)
            np.testing.assert_array_equal(numbers["qvel"][3:], v[3:])
            np.testing.assert_array_equal(numbers["ctrl"], tau)

    def test_mujoco_file_shows_the_robot_in_all_keyframes(self):
        model, bare = (
            mujoco.MjModel.from_xml_path(str(self.out / name)) for name in ("mujoco.xml", "mujoco_keyframes.xml")
        )
        self.assertEqual(model.nkey, len(self.nodes["time_s"]))
        self.assertGreater(model.nmesh, 0)
        self.assertEqual(bare.nmesh, 0)
        masses = ElementTree.fromstring(self.json["urdf"]["text"]).iterfind("link/inertial/mass")
        self.assertAlmostEqual(model.body_mass.sum(), sum(float(mass.get("value")) for mass in masses), places=9)
        shown = model.geom_group == 2
        self.assertEqual(np.count_nonzero(shown), model.ngeom - bare.ngeom)
        self.assertFalse(np.any(model.geom_contype[shown]) or np.any(model.geom_conaffinity[shown]))
        expected = self.quantities(self.nodes)
        np.testing.assert_array_equal(model.key_qpos, expected["q"][:, [0, 1, 2, 6, 3, 4, 5, *range(7, 19)]])
        np.testing.assert_array_equal(model.key_ctrl, expected["tau"])
        ends = []
        for each in (model, bare):  # visuals change no bit of the motion
            data = mujoco.MjData(each)
            mujoco.mj_resetDataKeyframe(each, data, model.nkey // 2)
            mujoco.mj_step(each, data, 100)
            ends.append(data.qpos.copy())
        np.testing.assert_array_equal(*ends)

    def test_simulation_is_the_true_motion(self):
        rows = read_csv(self.plan / "simulate.csv")
        with np.load(self.out / "simulated_motion.npz", allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        self.assertEqual(str(arrays["motion"]), "simulation")
        self.assertNotIn("a", arrays)
        self.assertNotIn("K", arrays)
        self.assertGreater(arrays["t"][-1], self.nodes["time_s"][-1], "it goes on standing")
        index = np.searchsorted(rows["time_s"], arrays["t"])
        np.testing.assert_array_equal(rows["time_s"][index], arrays["t"])
        self.assertLess(len(index), len(rows["time_s"]) / 3)
        true = [f"true_{name}" for name in POSE] + [f"true_q_{j}_rad" for j in self.joints]
        np.testing.assert_allclose(arrays["q"], columns(rows, true)[index], atol=1e-8)
        np.testing.assert_array_equal(arrays["tau"], columns(rows, [f"tau_{j}_Nm" for j in self.joints])[index])
        touch = columns(rows, [f"touch_{c}" for c in self.contacts])[index] == 1
        np.testing.assert_array_equal(arrays["in_contact"], touch)
        self.assertFalse(touch.all())
        points = json.loads((self.out / "simulated_joint_trajectory.json").read_text())["points"]
        self.assertEqual({len(p["accelerations"]) for p in points}, {0}, "ROS reads an empty list as not given")
        keys = ElementTree.parse(self.out / "simulated_mujoco_keyframes.xml").getroot()
        self.assertTrue((self.out / keys.find("include").get("file")).exists())
        simulated = mujoco.MjModel.from_xml_path(str(self.out / "simulated_mujoco.xml"))
        np.testing.assert_array_equal(simulated.key_time, [float(key.get("time")) for key in keys.iter("key")])

    def test_same_input_same_files(self):
        again = self.plan.with_name("again")
        run_or_fail("export", self.plan, "--format", "json,npz,mcap,mujoco", "--out", again)
        for path in again.iterdir():
            self.assertEqual(path.read_bytes(), (self.out / path.name).read_bytes(), path.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
