"""Malicious tasks. `prowl plan` is to refuse them before it solves anything."""

import os

from bad_input_support import TASK, Case, replaced
from bad_robots import ESCAPE, MEGABYTE

COMMAND = ("plan", "task.toml", "--out", "out")
PHASE = '[[phase]]\nname = "p{}"\ncontacts = "all"\nduration_s = 0.5\nintervals = {}\n'


def task(name, old, new, *says, status=2):
    command = COMMAND if status else (*COMMAND[:2], "--print-phases")
    return Case(
        "task: " + name,
        {"task.toml": replaced(TASK, old, new)},
        command,
        ("task.toml:", *says) if status else says,
        status,
    )


def with_more(name, text, *says):
    return task(name, "[cost]", text + "[cost]", *says)


def sizes():
    for value in (
        "0",
        "-1",
        "1000000000",
        "9223372036854775807",
        "99999999999999999999",
        "nan",
        "1e9",
        "5.5",
        '"5"',
        "[5]",
    ):
        yield task(f"intervals {value}", "intervals = 5", f"intervals = {value}", "task.toml:9:")
    for value in ("0", "-1", "nan", "inf", "1e308", "[2, 1]", "[0, 1]", "[1, nan]", "[]", '"long"'):
        yield task(f"duration {value}", "duration_s = 0.5", f"duration_s = {value}", "task.toml:8:")
    yield with_more("20000 phases", "".join(PHASE.format(i, 1) for i in range(13_000)), "at most")
    yield with_more(
        "900 phases, two of one name",
        "".join(PHASE.format(i, 1) for i in range(900)) + PHASE.format(899, 1),
        "already another",
    )
    yield with_more("1000 phases of 10000 intervals", "".join(PHASE.format(i, 10_000) for i in range(1000)), "at most")
    yield with_more(
        "1000 phases of free steps",
        "".join(PHASE.format(i, 200).replace("0.5", "[0.5, 1]") + 'steps = "free"\n' for i in range(1000)),
        "at most",
    )
    yield with_more(
        "9000 goals at one time", "[[goal]]\ntime_s = 0.5\nbase_displacement_m = [0, 0, 0]\n" * 9000, "at most"
    )
    yield with_more(
        "100 goals at one time",
        "[[goal]]\ntime_s = 0.5\nbase_displacement_m = [0, 0, 0]\n" * 100,
        "two goals at the same time",
    )
    yield task(
        "9000 goals on a fine mesh",
        "intervals = 5",
        "intervals = 10000\n"
        + "".join(
            f"[[goal]]\ntime_s = {0.5 * (i + 1) / 10000}\nbase_displacement_m = [0, 0, 0]\n" for i in range(9000)
        ),
        "at most",
    )
    yield task(
        "30000 surfaces",
        "[[surface]]",
        "".join(f'[[surface]]\nname = "s{i}"\n' for i in range(30_000)) + "[[surface]]",
        "at most",
    )
    yield task(
        "900 surfaces, two of one name",
        "[[surface]]",
        "".join(f'[[surface]]\nname = "s{i}"\n' for i in range(900)) + '[[surface]]\nname = "s7"\n[[surface]]',
        "already another",
    )
    yield task(
        "a patch of 60000 corners",
        "[[phase]]",
        "patch_m = [" + ",".join(f"[{i}, 0]" for i in range(60_000)) + "]\n[[phase]]",
        "at most",
    )
    yield task("a patch that is a line", "[[phase]]", "patch_m = [[0, 0], [1, 1], [2, 2]]\n[[phase]]", "task.toml:5")
    yield task("50000 contacts in a phase", '"all"', "[" + '"toe",' * 50_000 + "]", "task.toml:7")
    yield with_more(
        "50000 costs of a contact",
        '[[cost.contact_position]]\ncontact = "toe"\nreference_m = [0, 0, 0]\nweight = 1\n' * 9000,
        "task.toml",
    )
    yield task("a step of feedback of 1e-12", "step_s = 0.002", "step_s = 1e-12", "step_s")
    yield task("a step of feedback of 0", "step_s = 0.002", "step_s = 0", "step_s")
    for key, value in (
        ("strides", "1000000000"),
        ("stride_s", "1e9"),
        ("intervals_per_second", "1e9"),
        ("stride_length_m", "1e300"),
        ("kind", '"' + "x" * 100_000 + '"'),
    ):
        gait = {"kind": '"walk"', "strides": "1", "stride_s": "2", "stride_length_m": "0.1"} | {key: value}
        yield Case(
            f"task: gait {key}",
            {"task.toml": 'robot = "robot.toml"\n[gait]\n' + "".join(f"{k} = {v}\n" for k, v in gait.items())},
            COMMAND,
            ("task.toml:",),
        )


def numbers():
    for value in ("nan", "inf", "1e308", "-1", "true", '"x"', "1979-05-27", "9" * 400, "[1, 2"):
        yield task(
            f"weight {value[:8]}",
            "joint_velocity = 0.1",
            f"joint_velocity = {value}",
            "" if value[:2] in ("[1", "99") else "joint_velocity",
        )
        yield task(
            f"friction {value[:8]}",
            'name = "floor"',
            f'name = "floor"\nfriction = {value}',
            "" if value[:2] in ("[1", "99") else "friction",
        )
    for value in ("[0, 0, 0]", "[nan, 0, 1]", "[1e308, 0, 1]", "[0, 1]", "1"):
        yield task(f"normal {value}", 'name = "floor"', f'name = "floor"\nnormal = {value}', "normal")
    for key, value in (
        ("tolerance", "nan"),
        ("tolerance", "0"),
        ("max_iterations", "-1"),
        ("max_iterations", "1e9"),
        ("max_time_s", "inf"),
        ("max_time_s", "nan"),
    ):
        yield task(f"{key} {value}", "[cost]", f"[solver]\n{key} = {value}\n[cost]", key)


def names_and_paths():
    for name in (
        '"\\u001b[2J"',
        '"<script>alert(1)</script>"',
        '"\\u202eabc"',
        '"a\\nb"',
        f'"{MEGABYTE}"',
        '""',
        '"../../x"',
    ):
        status = 0 if "script" in name or ".." in name else 2
        yield task(f"named {name[:12]}", '"stand"', name, status=status)
        yield task(f"phase named {name[:12]}", '[[phase]]\nname = "stand"', f"[[phase]]\nname = {name}", status=status)
        yield task(f"surface named {name[:12]}", '"floor"', name, status=status)
        yield task(f"contact {name[:12]}", '"all"', f"[{name}]", "task.toml:7")
        yield task(f"robot {name[:12]}", '"robot.toml"', name, "task.toml:2")
        yield with_more(f"key {name[:12]}", f"[[goal]]\n{name} = 1\n", "unknown key")
    for uri, said in (
        ("/dev/zero", "not a file"),
        ("/etc", "not a file"),
        ("..", "not a file"),
        ("../" * 50 + "etc/passwd", "passwd"),
        ("robot.urdf", "XML"),
        ("task.toml", "task file"),
        ("gone.toml", "no such file"),
        ("file:///etc/passwd", "no such file"),
        ("nul\\u0000.toml", ""),
    ):
        yield Case(f"task: robot {uri[:20]}", {"task.toml": replaced(TASK, "robot.toml", uri)}, COMMAND, (said,))
    for name, make in (
        ("a pipe", os.mkfifo),
        ("a folder", os.mkdir),
        ("a link to itself", lambda p: os.symlink(p, p)),
        ("a link to /dev/zero", lambda p: os.symlink("/dev/zero", p)),
    ):
        yield Case(f"task file is {name}", {"task.toml": make}, COMMAND, ("task.toml",))
        yield Case(f"robot of the task is {name}", {"robot.toml": make}, COMMAND, ("robot.toml",))
    yield Case("task file is /dev/zero", {}, ("plan", "/dev/zero"), ("/dev/zero: not a file",))
    yield Case("task file whose name has control characters", {}, ("plan", ESCAPE + ".toml"), ("no such file",))
    yield Case("task file, cut short", {"task.toml": TASK[:-30]}, COMMAND, ("task.toml:",))
    yield Case("task file, binary", {"task.toml": bytes(range(256)) * 10}, COMMAND, ("task.toml:1:",))
    yield Case("task file of 50 MB", {"task.toml": TASK + "#" * 50_000_000}, COMMAND, ("task.toml", "bytes"))
    yield task("deep nesting", "joint_velocity = 0.1", "joint_velocity = " + "[" * 200_000)
    yield task("60000 keys", "joint_velocity = 0.1", "".join(f"k{i} = 1\n" for i in range(60_000)), "unknown key")
    yield task(
        "60000 joints",
        "joint_velocity = 0.1",
        "joint_velocity = {" + ",".join(f"k{i} = 1" for i in range(60_000)) + "}",
        "joint",
    )


def cases():
    yield from sizes()
    yield from numbers()
    yield from names_and_paths()
