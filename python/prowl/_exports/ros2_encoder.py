"""Encodes messages of ROS 2 as CDR; needs mcap-ros2-support."""

from __future__ import annotations

from collections.abc import Callable

from mcap_ros2._dynamic import serialize_dynamic

from .ros2_messages import definition, ros2_type


def encoder(message_type: str) -> Callable[[dict], bytes]:
    """Of messages "package/Name"."""
    name = ros2_type(message_type)
    return serialize_dynamic(name, definition(message_type))[name]
