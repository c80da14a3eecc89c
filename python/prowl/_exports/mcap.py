"""motion.mcap: a motion as ROS 2 messages."""

from __future__ import annotations

import io

from mcap.well_known import SchemaEncoding
from mcap.writer import CompressionType, Writer

from . import ros2_messages
from .ros2_encoder import encoder
from .ros2_topics import add_topics, contacts_of, world_frame, write_sample, write_start

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


class FileTopics:
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
            self._encoders[name] = encoder(message_type)
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


def write(motion: dict, in_parent: list, indices: list[int], urdf: str) -> bytes:
    """Content of the MCAP file. `motion`: motion.json as a dict. `in_parent`: per sample, placements of the
    links in their parents. `indices`: of samples, one per time."""
    contacts = contacts_of(motion)
    file = io.BytesIO()
    topics = FileTopics(file)
    add_topics(topics, contacts)
    write_start(topics, motion, in_parent[indices[0]], urdf)
    for i in indices:
        write_sample(topics, motion, in_parent[i], world_frame([link["name"] for link in motion["links"]]), contacts, i)
    topics.finish("prowl", {key: str(motion[key]) for key in ("robot", "task", "motion", "good", "format")})
    return file.getvalue()
