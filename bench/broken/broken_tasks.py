"""Broken tasks: made from shipped ones by the changes of tasks.toml, and a diagnosis judged by the cause that is known."""

import json
import re
import subprocess
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def read_list() -> list[dict]:
    with (Path(__file__).parent / "tasks.toml").open("rb") as file:
        return tomllib.load(file)["broken"]


def replaced(text: str, old: str, new: str) -> str:
    if old not in text:
        raise ValueError(f"'{old}' is not in the file that is to be changed")
    return text.replace(old, new, 1)


def with_limits(robot: str, limits: dict, nominal: dict[str, float]) -> str:
    """The robot file's text with those limits of all joints whose names match; `nominal`: position of each joint."""
    matching = [joint for joint in nominal if re.fullmatch(limits["joints"], joint)]
    if not matching:
        raise ValueError(f"no joint is called {limits['joints']}")
    for joint in matching:
        keys = {key: value for key, value in limits.items() if key != "joints"}
        if "about_nominal_rad" in keys:
            range_ = keys.pop("about_nominal_rad")
            keys["position_rad"] = [round(nominal[joint] - range_, 6), round(nominal[joint] + range_, 6)]
        header = f"\n[limits.{joint}]"  # at the start of a line: comments speak of them, too
        if header not in robot:
            robot += f"{header}\n"
        before, after = robot.split(header, 1)
        section, bracket, rest = after.partition("\n[limits")
        for key, value in keys.items():
            section = re.sub(rf"\n{key} = .*", "", section).rstrip("\n") + f"\n{key} = {value}\n"
        robot = before + header + section + bracket + rest
    return robot


def with_mass(urdf: str, link: str, mass: float) -> str:
    changed, count = re.subn(
        rf'(<link name="{link}">.*?<mass value=")[^"]*(")', rf"\g<1>{mass}\g<2>", urdf, count=1, flags=re.S
    )
    if count != 1:
        raise ValueError(f"link {link} has no mass")
    return changed


def make(broken: dict, prowl: Path, folder: Path) -> Path:
    """Writes the broken task, with its robot, into the folder. Returns the task file."""
    source = ROOT / "tasks" / f"{broken['task']}.toml"
    task = source.read_text()
    robot_file = (source.parent / tomllib.loads(task)["robot"]).resolve()
    robot = robot_file.read_text()
    known = json.loads(
        subprocess.run([prowl, "robot", robot_file, "--json"], capture_output=True, text=True, check=True).stdout
    )
    task = re.sub(r'robot = ".*"', 'robot = "robot.toml"', task, count=1)
    for old, new in broken.get("edit", []):
        task = replaced(task, old, new)
    if "limits" in broken:
        nominal = dict(zip((joint["name"] for joint in known["joints"]), known["nominal_configuration"][7:]))
        robot = with_limits(robot, broken["limits"], nominal)
    if "mass" in broken:
        urdf = with_mass(Path(known["urdf"]).read_text(), broken["mass"]["link"], broken["mass"]["kg"])
        (folder / "robot.urdf").write_text(urdf)
        robot = re.sub(r'\nurdf = ".*"', '\nurdf = "robot.urdf"', robot, count=1)
    (folder / "robot.toml").write_text(robot)
    (folder / "task.toml").write_text(task)
    return folder / "task.toml"


def names(cause: dict) -> list[str]:
    """Several joints are one subject; a goal's has a comma, too."""
    return (
        cause["subject"].split(", ")
        if cause["kind"] in ("torque", "joint_velocity", "joint_position")
        else [cause["subject"]]
    )


def is_named(broken: dict, diagnosis: dict) -> bool:
    """Whether the first cause of the diagnosis is one of those that are true, and each joint that it names."""
    message = diagnosis.get("error", {}).get("message", "")
    cause = diagnosis.get("cause") or {}
    for true in broken["causes"]:
        if "message" in true:
            if re.search(true["message"], message):
                return True
        elif (
            cause.get("kind") == true["kind"]
            and true.get("phase", cause["phase"]) == cause["phase"]
            and all(re.search(true.get("subject", ""), name) for name in names(cause))
        ):
            return True
    return False
