"""motion.mcap: a motion as ROS 2 messages."""

from __future__ import annotations

import io

from mcap.well_known import SchemaEncoding
from mcap.writer import CompressionType, Writer
from mcap_ros2._dynamic import serialize_dynamic

from . import ros2_messages

CHUNK = 1 << 20  # [bytes]
# QoS with which rosbag2 republishes the last message to late subscribers: reliable, transient
# local.
LATCHED = """- history: 1
  depth: 1
  reliability: 1
  durability: 1
  deadline: {sec: 0, nsec: 0}
  lifespan: {sec: 0, nsec: 0}
  liveliness: 1
  liveliness_lease_duration: {sec: 0, nsec: 0}
  avoid_ros_namespace_conventions: false
"""


class Topics:
    """An MCAP file with one channel per topic. mcap_ros2.writer cannot set metadata of channels."""

    def __init__(self, file: io.BytesIO):
        self._writer = Writer(file, chunk_size=CHUNK, compression=CompressionType.ZSTD)
        self._writer.start(profile="ros2", library="prowl")
        self._encoders, self._schemas, self._channels, self._counts = {}, {}, {}, {}

    def add(self, topic: str, message_type: str, latched: bool = False) -> None:
        name = ros2_messages.ros2_type(message_type)
        if name not in self._schemas:
            definition = ros2_messages.definition(message_type)
            self._schemas[name] = self._writer.register_schema(name, SchemaEncoding.ROS2, definition.encode())
            self._encoders[name] = serialize_dynamic(name, definition)[name]
        metadata = {"offered_qos_profiles": LATCHED if latched else ""}
        channel = self._writer.register_channel(
            topic=topic, message_encoding="cdr", schema_id=self._schemas[name], metadata=metadata
        )
        self._channels[topic] = (channel, self._encoders[name])
        self._counts[topic] = 0

    def write(self, topic: str, nanoseconds: int, message: dict) -> None:
        channel, encode = self._channels[topic]
        self._writer.add_message(
            channel_id=channel,
            log_time=nanoseconds,
            publish_time=nanoseconds,
            sequence=self._counts[topic],
            data=encode(message),
        )
        self._counts[topic] += 1

    def finish(self, name: str, metadata: dict[str, str]) -> None:
        self._writer.add_metadata(name, metadata)
        self._writer.finish()


def header(nanoseconds: int, frame: str) -> dict:
    return {"stamp": {"sec": nanoseconds // 10**9, "nanosec": nanoseconds % 10**9}, "frame_id": frame}


def vector(values) -> dict:
    return dict(zip("xyz", values))


def quaternion(values) -> dict:
    return dict(zip("xyzw", values))


def transform(nanoseconds: int, parent: str, child: str, position, rotation=(0.0, 0.0, 0.0, 1.0)) -> dict:
    return {
        "header": header(nanoseconds, parent),
        "child_frame_id": child,
        "transform": {"translation": vector(position), "rotation": quaternion(rotation)},
    }


def contact_frame(contact: str, links: list[str]) -> str:
    """Frame name of a contact, different from all links."""
    name = f"contact_{contact}"
    while name in links:
        name += "_"
    return name


def contact_topics(contacts: list[str]) -> dict[str, str]:
    """Topic of each contact. ROS allows letters, digits and underscores in topic names, no digit first."""
    topics: dict[str, str] = {}
    for contact in contacts:
        name = "".join(c if c.isascii() and c.isalnum() else "_" for c in contact)
        name = f"_{name}" if name[:1].isdigit() else name
        while f"/contacts/{name}" in topics.values():
            name += "_"
        topics[contact] = f"/contacts/{name}"
    return topics


def world_frame(links: list[str]) -> str:
    return next(name for name in ("world", "map", "prowl_world") if name not in links)


def write_start(topics: Topics, motion: dict, in_parent: list, urdf: str) -> None:
    topics.write("/robot_description", 0, {"data": urdf})
    held = [
        transform(0, link["parent"], link["name"], placement[:3], placement[3:])
        for link, placement in zip(motion["links"], in_parent)
        if link["fixed"]
    ]
    topics.write("/tf_static", 0, {"transforms": held})


def write_sample(
    topics: Topics, motion: dict, in_parent: list, world: str, contacts: dict[str, tuple[str, str]], i: int
) -> None:
    """Writes sample i. `in_parent`: placements of the links in their parents. `contacts`: frame and topic of
    each."""
    samples = motion["samples"]
    q, v = samples["q"][i], samples["v"][i]
    now = round(1e9 * samples["time_s"][i])
    root = motion["links"][0]["name"]
    moving = [
        transform(now, link["parent"] or world, link["name"], placement[:3], placement[3:])
        for link, placement in zip(motion["links"], in_parent)
        if not link["fixed"]
    ]
    moving += [
        transform(now, world, frame, position)
        for (frame, _), position in zip(contacts.values(), samples["contact_position_m"][i])
    ]
    topics.write("/tf", now, {"transforms": moving})
    topics.write(
        "/joint_states",
        now,
        {
            "header": header(now, ""),
            "name": motion["joints"],
            "position": q[7:],
            "velocity": v[6:],
            "effort": samples["tau"][i],
        },
    )
    topics.write(
        "/odom",
        now,
        {
            "header": header(now, world),
            "child_frame_id": root,
            "pose": {"pose": {"position": vector(q[:3]), "orientation": quaternion(q[3:7])}, "covariance": [0.0] * 36},
            "twist": {"twist": {"linear": vector(v[:3]), "angular": vector(v[3:6])}, "covariance": [0.0] * 36},
        },
    )
    for (frame, topic), force in zip(contacts.values(), samples["force_N"][i]):
        wrench = {"force": vector(force), "torque": vector((0.0, 0.0, 0.0))}
        topics.write(topic, now, {"header": header(now, frame), "wrench": wrench})


def write(motion: dict, in_parent: list, indices: list[int], urdf: str) -> bytes:
    """Content of the MCAP file. `motion`: motion.json as a dict. `in_parent`: per sample, placements of the
    links in their parents. `indices`: of samples, one per time."""
    links = [link["name"] for link in motion["links"]]
    contacts = {
        contact: (contact_frame(contact, links), topic) for contact, topic in contact_topics(motion["contacts"]).items()
    }
    file = io.BytesIO()
    topics = Topics(file)
    topics.add("/robot_description", "std_msgs/String", latched=True)
    topics.add("/tf_static", "tf2_msgs/TFMessage", latched=True)
    topics.add("/tf", "tf2_msgs/TFMessage")
    topics.add("/joint_states", "sensor_msgs/JointState")
    topics.add("/odom", "nav_msgs/Odometry")
    for _, topic in contacts.values():
        topics.add(topic, "geometry_msgs/WrenchStamped")
    write_start(topics, motion, in_parent[indices[0]], urdf)
    for i in indices:
        write_sample(topics, motion, in_parent[i], world_frame(links), contacts, i)
    topics.finish("prowl", {key: str(motion[key]) for key in ("robot", "task", "motion", "good", "format")})
    return file.getvalue()
