"""What stands in the place of Prowl's motion and gains gives its torques: here Prowl's own, in Crocoddyl's form.

crocoddyl_tracker_test.py COMMAND PACKAGES
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import numpy as np  # noqa: E402
import pinocchio  # noqa: E402
from crocoddyl_tracker import replace_motion, sampled  # noqa: E402
from prowl import integrate, read_plan  # noqa: E402

command = packages = None


class InThePlaceOfProwls(unittest.TestCase):
    def test_motion_and_gains_give_the_same_torques(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch) / "out"
            task = ROOT / "tasks/hyq/rear.toml"  # its base turns
            subprocess.run(
                [command, "plan", task, "--out", folder, "--package-dir", packages], check=True, capture_output=True
            )
            before = read_plan(folder).tracker
            names = before.joint_names
            nu = len(names)
            order = list(reversed(range(nu)))  # another order of joints
            velocity = [*range(6), *(6 + i for i in order)]
            gains = before.K.copy()
            for k, q in enumerate(before.q):
                gains[k][:, :3] = gains[k][:, :3] @ pinocchio.XYZQUATToSE3(q[:7]).rotation
            q = before.q[:, [*range(7), *(7 + i for i in order)]]
            last = [*np.flatnonzero(np.diff(before.t) > 0.0), len(before.t) - 1]  # of two samples where phases meet
            solved = {
                "time": before.t,
                "states": np.hstack([q, before.v[:, velocity]]),
                "torques": before.tau[:, order],
                "gains": gains[:, order][:, :, [*velocity, *(6 + nu + i for i in velocity)]],
                "joints": np.array(names)[order],
            }
            nodes = {name: array if name == "joints" else array[last] for name, array in solved.items()}
            replace_motion(folder / "tracker.bin", sampled(before, names, nodes))
            after = read_plan(folder).tracker
            random = np.random.default_rng(1)
            for k in range(10, len(before.t) - 1, 50):
                self.assertEqual(np.diff(before.t[k - 1 : k + 2]).min() > 0.0, True, "where phases meet: choose others")
                q = integrate(before.q[k], 0.02 * random.standard_normal(6 + nu))
                v = before.v[k] + 0.1 * random.standard_normal(6 + nu)
                t = before.t[k]
                np.testing.assert_allclose(after.torque(t, q, v), before.torque(t, q, v), atol=1e-9)
                self.assertEqual(after.contacts(t), before.contacts(t))


if __name__ == "__main__":
    packages, command = sys.argv.pop(), sys.argv.pop()
    unittest.main()
