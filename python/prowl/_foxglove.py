"""A run of run_online() live in Foxglove, whose Teleop panel commands the robot."""

from __future__ import annotations

import json
import time
from typing import TYPE_CHECKING

import numpy as np

from . import _prowl
from ._extras import needs
from ._exports import ros2_messages
from ._exports.ros2_topics import add_topics, contacts_of, world_frame, write_sample, write_start

if TYPE_CHECKING:
    import foxglove

RATE = 30.0  # of pictures [Hz]


class _Channels:
    """The topics of a server."""

    def __init__(self, context: foxglove.Context):
        self._context, self._channels = context, {}

    def add(self, topic: str, message_type: str, latched: bool = False) -> None:
        import foxglove

        from ._exports.ros2_encoder import encoder

        name, definition = ros2_messages.ros2_type(message_type), ros2_messages.definition(message_type)
        schema = foxglove.Schema(name=name, encoding="ros2msg", data=definition.encode())
        channel = foxglove.Channel(topic, message_encoding="cdr", schema=schema, context=self._context)
        self._channels[topic] = (channel, encoder(message_type))

    def write(self, topic: str, nanoseconds: int, message: dict) -> None:
        channel, encode = self._channels[topic]
        channel.log(encode(message), log_time=nanoseconds)


class Foxglove:
    """For run_online(watch=Foxglove(robot)): runs in real time and serves the robot to Foxglove at `url`
    until the end of a `with` statement.

    Topics as those of an MCAP file (docs/exports.md), without efforts. Messages geometry_msgs/Twist of clients, such
    as those of the panel Teleop, are commands. Needs foxglove-sdk and mcap-ros2-support. Raises InputError for a port
    that is taken.
    """

    def __init__(self, robot: _prowl.Robot, port: int = 8765) -> None:
        with needs("foxglove"):
            import foxglove

            from ._exports import ros2_encoder  # noqa: F401

        self._robot, self._dynamics = robot, _prowl.Dynamics(robot)
        self._wish, self._is_new, self._began, self._next = None, True, 0, 0.0
        self._links = [{"name": link.name, "parent": link.parent, "fixed": link.fixed} for link in robot.links]
        motion = {"links": self._links, "contacts": robot.contact_names}
        self._contacts = contacts_of(motion)
        self._world = world_frame([link["name"] for link in self._links])
        context = foxglove.Context()
        try:
            self._server = foxglove.start_server(
                name=f"Prowl: {robot.name}",
                port=port,
                context=context,
                capabilities=[foxglove.Capability.ClientPublish],
                supported_encodings=["json"],
                server_listener=self._listener(),
            )
        except Exception as error:
            raise _prowl.InputError(f"port {port}: {error}; name another") from error
        self._topics = _Channels(context)
        add_topics(self._topics, self._contacts)

    @property
    def url(self) -> str:
        return f"ws://127.0.0.1:{self._server.port}"

    def _listener(self) -> foxglove.ServerListener:
        """What the server calls, in a thread of its own."""
        import foxglove

        class Listener(foxglove.ServerListener):
            def on_subscribe(_, client: object, channel: object) -> None:
                self._is_new = True

            def on_message_data(_, client: object, client_channel_id: int, data: bytes) -> None:
                try:
                    twist = json.loads(data)
                    wish = twist["linear"]["x"], twist["linear"]["y"], twist["angular"]["z"]
                    self._wish = tuple(map(float, wish))
                except (ValueError, KeyError, TypeError):
                    return  # not a Twist

        return Listener()

    def __call__(self, moment: _prowl.OnlineMoment) -> None:
        if moment.t == 0.0:
            self._began, self._next = time.time_ns(), 0.0
        time.sleep(max(0.0, 1e-9 * self._began + moment.t - time.time()))
        wish, self._wish = self._wish, None
        if wish is not None:
            forward, left, turn = wish
            moment.command(forward, left, turn)
        if moment.t >= self._next:
            self._next += 1.0 / RATE
            self._publish(moment)

    def _publish(self, moment: _prowl.OnlineMoment) -> None:
        now = self._began + round(1e9 * moment.t)
        in_parent = self._robot.link_placements(moment.q[None], in_parent=True)[0]
        motion = {
            "links": self._links,
            "joints": self._robot.joint_names,
            "samples": {
                "time_s": [1e-9 * now],
                "q": [moment.q.tolist()],
                "v": [moment.v.tolist()],
                "tau": [[]],
                "force_N": [moment.f.tolist()],
                "contact_position_m": [self._contact_positions(moment.q)],
            },
        }
        if self._is_new:
            self._is_new = False
            write_start(self._topics, motion, in_parent, self._robot.urdf_text, now)
        write_sample(self._topics, motion, in_parent, self._world, self._contacts, 0)

    def _contact_positions(self, q: np.ndarray) -> list[list[float]]:
        return self._dynamics.contact_positions(q).tolist()

    def __enter__(self) -> Foxglove:
        return self

    def __exit__(self, *_: object) -> None:
        self._server.stop()
