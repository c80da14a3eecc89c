"""Runs prowl on a malicious input, with limits, and says what of its answer is not as docs/reliability.md promises.

A case is what to change of a sound folder (a small robot, a task, a plan), what to run in it and what the message must hold.
"""

import dataclasses
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile

PROWL = pathlib.Path(sys.argv[1]).resolve()
MOST_SECONDS = 1.0  # of processor time: a machine with other work to do must not fail the test
MOST_BYTES = 500e6  # resident
MOST_MESSAGE = 4000  # bytes: a screen or so
UNEXPECTED = 1
WALL_SECONDS = 20  # whatever takes longer hangs
# What is not to be seen on a terminal: control characters but tab and line end, of 7 and 8 bits, and marks that turn text round.
CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")

URDF = """<?xml version="1.0"?>
<robot name="small">
  <link name="base">
    <inertial><mass value="10"/><inertia ixx="0.2" ixy="0" ixz="0" iyy="0.3" iyz="0" izz="0.4"/></inertial>
    <visual><geometry><box size="0.3 0.2 0.1"/></geometry></visual>
  </link>
  <link name="leg">
    <inertial><mass value="1"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"/></inertial>
  </link>
  <link name="foot"/>
  <joint name="hip" type="revolute">
    <parent link="base"/><child link="leg"/><origin xyz="0 0.1 0" rpy="0 0 0"/><axis xyz="1 0 0"/>
    <limit lower="-0.5" upper="1.5" velocity="10" effort="50"/>
  </joint>
  <joint name="ankle" type="fixed"><parent link="leg"/><child link="foot"/><origin xyz="0 0 -0.5"/></joint>
</robot>
"""
ROBOT = """name = "small"
urdf = "robot.urdf"
contact = [{ name = "toe", frame = "foot", radius_m = 0.02 }]
[nominal.joints]
hip = 0.1
"""
TASK = """name = "stand"
robot = "robot.toml"
[[surface]]
name = "floor"
[[phase]]
name = "stand"
contacts = "all"
duration_s = 0.5
intervals = 5
[cost]
joint_velocity = 0.1
[tracking]
step_s = 0.002
"""
SOUND = {"robot.urdf": URDF, "robot.toml": ROBOT, "task.toml": TASK}


@dataclasses.dataclass
class Case:
    """`files`: name to text, bytes or what makes something else at that path; `says`: in the message, all of them."""

    name: str
    files: dict
    command: tuple
    says: tuple
    status: int | None = 2  # None: any, but that of a mistake in Prowl
    folder: pathlib.Path | None = None  # of a plan, copied to "plan" first

    def make(self, root):
        for name, content in SOUND.items():
            (root / name).write_text(content)
        if self.folder:
            shutil.copytree(self.folder, root / "plan")
        for name, content in self.files.items():
            path = root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if callable(content):
                path.unlink(missing_ok=True)
                content(path)
            else:
                path.write_bytes(content if isinstance(content, bytes) else content.encode())


@dataclasses.dataclass
class Answer:
    status: int
    out: str
    error: str
    seconds: float
    bytes: float
    hung: bool = False


def limit():
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))  # far above the limit that is checked: saves the machine
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def run(command, folder):
    with open(folder / ".out", "wb") as out, open(folder / ".err", "wb") as err:
        process = subprocess.Popen(
            [PROWL, *command],
            cwd=folder,
            stdout=out,
            stderr=err,
            stdin=subprocess.DEVNULL,
            preexec_fn=limit,
            env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
        )
        signal.signal(signal.SIGALRM, lambda *_: process.kill())
        signal.alarm(WALL_SECONDS)
        _, status, used = os.wait4(process.pid, 0)
        hung = signal.alarm(0) == 0
        process.returncode = os.waitstatus_to_exitcode(status)
    decode = lambda name: (folder / name).read_bytes().decode("utf-8", "surrogateescape")  # noqa: E731
    return Answer(
        process.returncode, decode(".out"), decode(".err"), used.ru_utime + used.ru_stime, 1024.0 * used.ru_maxrss, hung
    )


def faults(case, answer):
    """What is wrong with the answer, in words; none if it is as promised."""
    if answer.hung:
        return [f"still running after {WALL_SECONDS} s"]
    if answer.status < 0:
        return [f"killed by signal {-answer.status}: {answer.error[-300:]!r}"]
    found = []
    text = answer.error + answer.out
    if answer.status != case.status and (case.status is not None or answer.status == UNEXPECTED):
        found.append(f"status {answer.status}, not {case.status}: {text[:300]!r}")
    refused = case.status == 2 or case.status is None and answer.status == 2
    if refused and not answer.error.startswith("prowl: "):
        found.append(f"begins with {answer.error[:60]!r}, not with 'prowl: '")
    if refused and answer.error.count("\nprowl: "):
        found.append("more than one message")
    if re.search("^(Error|Warning): ", answer.error, re.MULTILINE):
        found.append(f"a library speaks: {answer.error[:200]!r}")
    for said in case.says:
        if said not in text:
            found.append(f"does not say {said!r}: {text[:300]!r}")
    if control := CONTROL.search(text) or re.search("[\udc80-\udcff]", text):
        found.append(f"a control character at {text[max(0, control.start() - 30) : control.end()]!r}")
    if len(text.encode("utf-8", "surrogateescape")) > MOST_MESSAGE and refused:
        found.append(f"{len(text)} characters: {text[:100]!r}")
    if answer.seconds > MOST_SECONDS and refused:
        found.append(f"{answer.seconds:.2f} s of processor time")
    if answer.bytes > MOST_BYTES:
        found.append(f"{answer.bytes / 1e6:.0f} MB")
    return found


def check(case):
    with tempfile.TemporaryDirectory() as name:
        root = pathlib.Path(name)
        case.make(root)
        answer = run(case.command, root)
        return faults(case, answer), answer


def replaced(text, old, new):
    """`text` with its first `old` replaced; it must be there, or the case checks nothing."""
    assert old in text, old
    return text.replace(old, new, 1)
