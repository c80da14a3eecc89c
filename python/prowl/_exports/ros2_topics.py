"""A motion as messages on ROS 2 topics: in a file (mcap.py), or live (_foxglove.py)."""

from __future__ import annotations

from typing import Protocol


class Topics(Protocol):
    """Takes messages of ROS 2 as dicts."""

    def add(self, topic: str, message_type: str, latched: bool = False) -> None:
        """Declares a topic. `latched`: late subscribers get its last message."""

    def write(self, topic: str, nanoseconds: int, message: dict) -> None: ...


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


def contacts_of(motion: dict) -> dict[str, tuple[str, str]]:
    """Frame and topic of each contact."""
    links = [link["name"] for link in motion["links"]]
    return {
        contact: (contact_frame(contact, links), topic) for contact, topic in contact_topics(motion["contacts"]).items()
    }


def add_topics(topics: Topics, contacts: dict[str, tuple[str, str]]) -> None:
    topics.add("/robot_description", "std_msgs/String", latched=True)
    topics.add("/tf_static", "tf2_msgs/TFMessage", latched=True)
    topics.add("/tf", "tf2_msgs/TFMessage")
    topics.add("/joint_states", "sensor_msgs/JointState")
    topics.add("/odom", "nav_msgs/Odometry")
    for _, topic in contacts.values():
        topics.add(topic, "geometry_msgs/WrenchStamped")


def write_start(topics: Topics, motion: dict, in_parent: list, urdf: str, now: int = 0) -> None:
    """`now`: time [ns]."""
    topics.write("/robot_description", now, {"data": urdf})
    held = [
        transform(now, link["parent"], link["name"], placement[:3], placement[3:])
        for link, placement in zip(motion["links"], in_parent)
        if link["fixed"]
    ]
    topics.write("/tf_static", now, {"transforms": held})


def write_sample(
    topics: Topics, motion: dict, in_parent: list, world: str, contacts: dict[str, tuple[str, str]], i: int
) -> None:
    """Writes sample i. `in_parent`: placements of the links in their parents. `contacts`: contacts_of(motion)."""
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
