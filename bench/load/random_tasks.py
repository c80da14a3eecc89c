"""Random tasks: a shipped robot that stands on a slope and takes its base somewhere and back. Standard library only."""

import math
import pathlib
import random
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Robot, its shipped task, and how far its base goes at most [m].
ROBOTS = [("hyq", "crouch", 0.20), ("anymal_c", "crouch", 0.15), ("solo12", "crouch", 0.08), ("go2", "crouch", 0.10)]


MOVING = 0.5  # part of the tasks whose base moves at the start, in any direction
SPEED, SPIN = 0.3, 0.5  # of the base then [m/s, rad/s]


def arrow(source: random.Random, length: float) -> list[float]:
    direction = [source.gauss(0.0, 1.0) for _ in range(3)]
    return [length * x / math.hypot(*direction) for x in direction]


def folder(robot: str) -> pathlib.Path:
    """That the paths in its tasks are relative to."""
    return ROOT / "tasks" / robot


def draw(source: random.Random) -> tuple[str, dict]:
    """Robot, and a task of its own as the document of a task file: goal, slope, friction, time and the motion at the start are drawn."""
    robot, shipped, reach = source.choice(ROBOTS)
    document = tomllib.loads((folder(robot) / f"{shipped}.toml").read_text(encoding="utf-8"))
    slope, heading = math.radians(source.uniform(0.0, 15.0)), source.uniform(-math.pi, math.pi)
    normal = [math.sin(slope) * math.cos(heading), math.sin(slope) * math.sin(heading), math.cos(slope)]
    document["surface"] = [{"name": "ground", "normal": normal, "friction": source.uniform(0.2, 1.0)}]
    document["start"] = {"on": "ground"}
    if source.random() < MOVING:
        document["start"] |= {
            "base_linear_velocity_mps": arrow(source, SPEED),
            "base_angular_velocity_radps": arrow(source, SPIN),
        }
    duration = source.uniform(0.8, 3.0)
    document["phase"][0]["duration_s"] = duration
    there, back = document["goal"]
    there |= {
        "time_s": 0.5 * duration,
        "base_displacement_m": [
            *(source.uniform(-0.5 * reach, 0.5 * reach) for _ in range(2)),
            source.uniform(-reach, 0.2 * reach),
        ],
        "base_rpy_rad": [source.uniform(-0.2, 0.2) for _ in range(3)],
    }
    back["time_s"] = duration
    return robot, document
