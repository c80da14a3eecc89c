"""For the tests of prowl export: readers, and forward kinematics from the URDF alone."""

import csv
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

ROOT = pathlib.Path(__file__).parents[2]


def prowl(*arguments) -> subprocess.CompletedProcess:
    """The command, and the folder of the robots, are the arguments of the test."""
    return subprocess.run(
        [sys.argv[1], *map(str, arguments), "--package-dir", sys.argv[2]], capture_output=True, text=True
    )


def run_or_fail(*arguments) -> subprocess.CompletedProcess:
    done = prowl(*arguments)
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}")
    return done


def read_csv(path: pathlib.Path) -> dict[str, np.ndarray]:
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T))


def columns(table: dict[str, np.ndarray], names) -> np.ndarray:
    return np.column_stack([table[name] for name in names])


def rotation(quaternion) -> np.ndarray:
    """Of x y z w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def placement(position, turn) -> np.ndarray:
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = turn, position
    return result


def of_seven(values) -> np.ndarray:
    return placement(values[:3], rotation(values[3:]))


def about(axis, angle) -> np.ndarray:
    """Rodrigues."""
    k = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


class Urdf:
    """Just enough of one for forward kinematics."""

    def __init__(self, text: str):
        tree = ElementTree.fromstring(text)
        self.links = [link.get("name") for link in tree.iter("link")]
        self.joints = {
            joint.find("child").get("link"): joint for joint in tree.iter("joint") if joint.find("child") is not None
        }

    def parent(self, link: str):
        return self.joints[link].find("parent").get("link") if link in self.joints else None

    def fixed(self, link: str) -> bool:
        return link in self.joints and self.joints[link].get("type") == "fixed"

    def in_world(self, link: str, base: np.ndarray, angles: dict[str, float]) -> np.ndarray:
        if link not in self.joints:
            return base
        joint = self.joints[link]
        numbers = lambda tag, key, default: [float(x) for x in joint.find(tag).get(key, default).split()]  # noqa: E731
        origin = np.eye(4)
        if joint.find("origin") is not None:
            roll, pitch, yaw = numbers("origin", "rpy", "0 0 0")
            turn = about((0, 0, 1), yaw) @ about((0, 1, 0), pitch) @ about((1, 0, 0), roll)
            origin = placement(numbers("origin", "xyz", "0 0 0"), turn)
        move = np.eye(4)
        if joint.get("type") in ("revolute", "continuous"):
            axis = np.array(numbers("axis", "xyz", "1 0 0"))
            move[:3, :3] = about(axis / np.linalg.norm(axis), angles[joint.get("name")])
        return self.in_world(self.parent(link), base, angles) @ origin @ move


def read_mcap(path: pathlib.Path):
    """Topic: list of (schema name, log time, decoded message)."""
    topics: dict[str, list] = {}
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            topics.setdefault(channel.topic, []).append((schema.name, message.log_time, decoded))
        return topics, reader.get_summary(), {m.name: m.metadata for m in reader.iter_metadata()}


def xyz(value) -> list[float]:
    return [value.x, value.y, value.z]
