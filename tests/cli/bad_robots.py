"""Malicious robots: the URDF, and the robot file that names it."""

import os

from bad_input_support import ROBOT, URDF, Case, replaced

ROBOT_COMMAND = ("robot", "robot.toml")
ESCAPE = "\x1b[2J\x1b]0;owned\x07"
INERTIAL = '<inertial><mass value="1"/><inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>'


def link(name, parent, kind="revolute", joint=None):
    limit = '<limit lower="-1" upper="1" velocity="1" effort="1"/>'
    return (
        f'<link name="{name}">{INERTIAL}</link><joint name="{joint or "j_" + name}" type="{kind}"><parent link="{parent}"/>'
        f'<child link="{name}"/>{limit}</joint>'
    )


def with_more(text):
    return replaced(URDF, "</robot>", text + "</robot>")


def urdf(name, text, *says, status=2):
    return Case("urdf: " + name, {"robot.urdf": text}, ROBOT_COMMAND, says, status)


def damaged(name, old, new, *says, status=2):
    return urdf(name, replaced(URDF, old, new), *(("robot.urdf:",) if status else ()), *says, status=status)


def robot(name, old, new, *says, status=2):
    return Case("robot: " + name, {"robot.toml": replaced(ROBOT, old, new)}, ROBOT_COMMAND, says, status)


def entities(declarations, use):
    return f'<?xml version="1.0"?><!DOCTYPE r [{declarations}]>' + replaced(
        URDF, '<?xml version="1.0"?>\n', ""
    ).replace('name="small"', f'name="{use}"', 1)


BOMB = '<!ENTITY a0 "ha">' + "".join(f'<!ENTITY a{i} "{f"&a{i - 1};" * 10}">' for i in range(1, 12))
MEGABYTE = "x" * 1_000_000


def urdf_cases():
    chain = lambda n, kind: with_more("".join(link(f"l{i}", f"l{i - 1}" if i else "base", kind) for i in range(n)))  # noqa: E731
    yield urdf("entity bomb", entities(BOMB, "&a11;"), "robot.urdf:")
    yield urdf("external entity", entities('<!ENTITY a SYSTEM "file:///etc/passwd">', "&a;"), "robot.urdf:")
    yield urdf("a million elements deep", "<robot name='x'>" + "<a>" * 1_000_000, "robot.urdf:", "XML")
    yield urdf("400 elements deep", with_more("<a>" * 400 + "</a>" * 400), status=0)
    yield urdf("a million elements", with_more("<a/>" * 1_000_000), status=0)
    yield urdf("2 million elements", with_more("<a/>" * 2_000_000), "robot.urdf", "bytes")
    yield urdf("chain of 3000 fixed links", chain(3000, "fixed"), "robot.urdf:", "more than 1000 links")
    yield urdf(
        "star of 3000 links", with_more("".join(link(f"l{i}", "base") for i in range(3000))), "more than 1000 links"
    )
    yield urdf("chain of 500 moving links", chain(500, "revolute"), "more than 120 moving joints")
    yield urdf("cycle", with_more(link("a", "b") + link("b", "a")), "robot.urdf:", "loop")
    yield urdf("child of itself", with_more(link("a", "a")), "robot.urdf:")
    yield urdf(
        "two parents",
        with_more(link("a", "base") + '<joint name="again" type="fixed"><parent link="leg"/><child link="a"/></joint>'),
        "robot.urdf:",
        "already the child",
    )
    yield urdf("two roots", with_more('<link name="alone"/>'), "robot.urdf:", "alone")
    yield urdf(
        "many roots", with_more("".join(f'<link name="a{i:0150}"/>' for i in range(900))), "robot.urdf:", "exactly one"
    )
    yield urdf(
        "60000 joints",
        with_more("".join(link("leg", "base", joint=f"j{i}").split("</link>")[1] for i in range(10_000))),
        "robot.urdf:",
    )
    yield urdf("empty", "", "robot.urdf")
    yield urdf("binary", bytes(range(256)) * 100, "robot.urdf")
    yield urdf("UTF-16", URDF.encode("utf-16"), "robot.urdf")
    yield urdf("zeros", b"\0" * 100_000, "robot.urdf")
    yield urdf("a zero inside", URDF.replace("small", "sm\0all"), "robot.urdf")
    yield urdf("cut short", URDF[: len(URDF) // 2], "robot.urdf:", "XML")
    yield urdf("50 MB", URDF + " " * 50_000_000, "robot.urdf", "bytes")
    yield urdf("another XML", "<svg><script>alert(1)</script></svg>", "robot.urdf:1", "<robot")
    for value in (
        "nan",
        "inf",
        "-inf",
        "1e308",
        "1e-400",
        "0x1p3",
        "1,5",
        "",
        " ",
        "9" * 5000,
        ESCAPE,
        "<b>".replace("<", "&lt;"),
        MEGABYTE,
    ):
        short = value[:8].encode("unicode_escape").decode()
        yield damaged(f"mass {short}", 'mass value="1"', f'mass value="{value}"', "link 'leg'")
        yield damaged(f"origin {short}", 'xyz="0 0.1 0"', f'xyz="0 {value} 0"', "joint 'hip'")
        yield damaged(f"inertia {short}", 'ixx="0.02"', f'ixx="{value}"', "link 'leg'")
        yield (
            damaged(f"effort {short}", 'effort="50"', f'effort="{value}"', "joint 'hip'", status=2)
            if value != "1e308"
            else damaged("no limit to speak of", 'effort="50"', f'effort="{value}"', status=0)
        )
    for value in ("nan nan nan", "0 0 0", "inf 0 0", "1 0", MEGABYTE):
        yield damaged(f"axis {value[:8]}", 'axis xyz="1 0 0"', f'axis xyz="{value}"', "joint 'hip'")
    for value in ("nan 1 1", "1e308 1 1", "1 1", "abc", "-1 -1 -1", ESCAPE):
        yield damaged(
            f"box {value[:8].encode('unicode_escape').decode()}",
            'box size="0.3 0.2 0.1"',
            f'box size="{value}"',
            "link 'base'",
            "size",
        )
    for shape in (
        '<sphere radius="nan"/>',
        "<sphere/>",
        '<cylinder radius="1" length="-inf"/>',
        '<mesh filename="x.stl" scale="nan 1 1"/>',
        "<mesh/>",
    ):
        yield damaged(f"shape {shape}", '<box size="0.3 0.2 0.1"/>', shape, "link 'base'")
    for shape in (
        "<teapot/>",
        "",
        '<mesh filename="gone.stl"/>',
        '<mesh filename="file:///etc/passwd"/>',
        '<mesh filename="../../../etc/passwd"/>',
    ):
        yield damaged(f"left out: {shape}", '<box size="0.3 0.2 0.1"/>', shape, status=0)
    yield damaged(
        "colour nan",
        "</geometry></visual>",
        '</geometry><material name="m"><color rgba="nan 0 0 1"/></material></visual>',
        "link 'base'",
    )
    yield damaged("zero mass that moves", 'mass value="1"', 'mass value="0"')
    yield damaged("negative mass", 'mass value="1"', 'mass value="-1"', ">= 0")
    yield damaged(
        "inertia zero",
        'ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.001"',
        'ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"',
        "'hip' moves a body that has no inertia",
        "locked_joints",
    )
    yield damaged("inertia against the triangle", 'izz="0.001"', 'izz="1"', "triangle")
    yield damaged("inertia negative", 'ixx="0.02"', 'ixx="-0.02"', "all > 0")
    yield damaged("limits the wrong way", 'lower="-0.5"', 'lower="2.5"', "lower < upper")
    yield damaged("limits nan", 'lower="-0.5"', 'lower="nan"', "joint 'hip'")
    yield damaged("limits infinite", 'upper="1.5"', 'upper="inf"', "joint 'hip'")
    yield damaged("mimic nan", "<axis", '<mimic joint="hip" multiplier="nan"/><axis', "joint 'hip'", "multiplier")
    yield damaged("mimic of nothing", "<axis", "<mimic/><axis", "joint 'hip'", "joint")
    for mimic in ('joint="hip" multiplier="2"', 'joint="other"'):
        yield urdf(
            f"mimic {mimic}",
            replaced(URDF, "<axis", f"<mimic {mimic}/><axis"),
            "robot.toml:3",
            "'hip'",
            "copies another",
        )
    yield Case(
        "urdf: no moving joint",
        {
            "robot.urdf": replaced(URDF, 'type="revolute"', 'type="fixed"'),
            "robot.toml": ROBOT[: ROBOT.index("[nominal")],
        },
        ROBOT_COMMAND,
        ("0 joints",),
        0,
    )
    yield damaged("floating", 'type="revolute"', 'type="floating"', "joint 'hip'", "root link")
    yield damaged("continuous", 'type="revolute"', 'type="continuous"', "joint 'hip'", "revolute")
    yield damaged("unknown type", 'type="revolute"', f'type="{ESCAPE}"', "joint 'hip'")
    yield damaged("link twice", '<link name="foot"/>', '<link name="foot"/><link name="foot"/>', "line")
    yield damaged("joint twice", 'name="ankle"', 'name="hip"', "line")
    yield damaged("parent that is not there", 'parent link="base"', 'parent link="bas"', "did you mean 'base'")
    yield damaged("link and joint of one name", 'joint name="ankle"', 'joint name="foot"', status=0)
    yield damaged("joint named like Pinocchio's base", 'joint name="hip"', 'joint name="root_joint"', "root_joint")
    yield urdf("link named universe", URDF.replace('"base"', '"universe"'), "universe")
    for name in (
        "<script>alert(1)</script>".replace("<", "&lt;"),
        "&quot;",
        "&#27;[2J",
        "&#10;x",
        "a,b",
        "é",
        "\u202eabc",
        " x",
    ):
        yield damaged(f"link named {name}", 'link name="foot"', f'link name="{name}"')
        yield damaged(
            f"joint named {name}", 'joint name="ankle"', f'joint name="{name}"', status=0 if "script" in name else 2
        )
        yield damaged(f"robot named {name}", 'name="small"', f'name="{name}"', status=0)
    yield damaged("megabyte of a link's name", 'link name="foot"', f'link name="{MEGABYTE}"', "link")
    yield damaged("megabyte of a joint's name", 'joint name="ankle"', f'joint name="{MEGABYTE}"', "joint")
    yield damaged("megabyte of a parent's name", 'parent link="base"', f'parent link="{MEGABYTE}"', "joint 'hip'")
    yield damaged(
        "megabyte of an attribute nobody reads", '<link name="foot"/>', f'<link name="foot" x="{MEGABYTE}"/>', status=0
    )


def robot_file_cases():
    for uri, said in (
        ("/dev/zero", "file"),
        ("/etc", "file"),
        ("../" * 50 + "etc/passwd", "passwd"),
        ("file:///etc/passwd", "package://"),
        ("http://example.org/x.urdf", "package://"),
        ("package://a/../../../../../../etc/passwd", "leaves its package"),
        ("package://../etc", "leaves its package"),
        ("package://", "package://"),
        ("", "urdf"),
        ("robot.toml", "URDF"),
        ("a" * 100_000, "urdf"),
        ("\\u001b[2J.urdf", "urdf"),
        ("nul\\u0000.urdf", "urdf"),
    ):
        yield robot(f"urdf {uri[:30]}", "robot.urdf", uri, said)
    for name, make in (
        ("a pipe", os.mkfifo),
        ("a folder", os.mkdir),
        ("a link to itself", lambda p: os.symlink(p, p)),
        ("a link to /dev/zero", lambda p: os.symlink("/dev/zero", p)),
        ("a link to nothing", lambda p: os.symlink("gone", p)),
    ):
        yield Case(f"urdf is {name}", {"robot.urdf": make}, ROBOT_COMMAND, ("robot.urdf",))
        yield Case(f"robot file is {name}", {"robot.toml": make}, ROBOT_COMMAND, ("robot.toml",))
    yield Case("robot file is /dev/zero", {}, ("robot", "/dev/zero"), ("/dev/zero: not a file",))
    yield Case("robot file of 50 MB", {"robot.toml": ROBOT + "#" * 50_000_000}, ROBOT_COMMAND, ("robot.toml", "bytes"))
    yield Case("robot file, binary", {"robot.toml": bytes(range(256)) * 10}, ROBOT_COMMAND, ("robot.toml:1:",))
    yield Case("robot file, empty", {"robot.toml": ""}, ROBOT_COMMAND, ("robot.toml:", "missing"))
    yield robot("deep nesting", 'urdf = "robot.urdf"', "urdf = " + "[" * 200_000, "robot.toml:2:")
    yield robot("deep tables", 'urdf = "robot.urdf"', "urdf = " + "{a=" * 100_000, "robot.toml:2:")
    yield robot("deep dotted key", 'urdf = "robot.urdf"', "u" + ".a" * 100_000 + " = 1", "robot.toml:")
    yield robot("deep header", "[nominal.joints]", "[nominal" + ".a" * 100_000 + "]", "robot.toml:")
    yield robot("a list of 400000", 'name = "toe"', "name = [" + "0," * 400_000 + "]", "robot.toml:3:", "a list of")
    yield robot(
        "60000 keys",
        'name = "small"',
        'name = "small"\n' + "".join(f"k{i} = 1\n" for i in range(60_000)),
        "robot.toml:",
        "unknown key",
    )
    yield robot(
        "20000 contacts",
        "contact = [",
        "contact = [" + "".join(f'{{name="c{i}",frame="foot"}},' for i in range(20_000)),
        "robot.toml:3:",
        "at most",
    )
    yield robot(
        "90 contacts, one without a frame",
        "contact = [",
        "contact = [" + "".join(f'{{name="c{i}",frame="foot"}},' for i in range(90)) + '{name="x",frame="no"},',
        "robot.toml:3:",
        "contact[90].frame",
    )
    yield robot(
        "20000 nominal joints", "hip = 0.1", "".join(f"hip{i} = 0.1\n" for i in range(20_000)), "robot.toml:", "joint"
    )
    velocity, effort = replaced(URDF, 'velocity="', 'velocity="0" x="'), 'effort="0" y="'
    at = velocity.rindex('effort="')
    yield Case(
        "robot: a limit mended, another not, and 40000 joints that are not there",
        {
            "robot.urdf": velocity[:at] + effort + velocity[at + len('effort="') :],
            "robot.toml": replaced(
                ROBOT,
                "[nominal.joints]",
                "[limits.hip]\nvelocity_radps = 1\n[nominal.joints]\n" + "".join(f"j{i} = 0\n" for i in range(40_000)),
            ),
        },
        ROBOT_COMMAND,
        ("robot.toml:", "urdf:", "effort"),
    )
    yield robot(
        "5000 limits",
        "[nominal.joints]",
        "".join(f"[limits.h{i}]\n" for i in range(5000)) + "[nominal.joints]",
        "robot.toml:",
        "joint",
    )
    yield robot(
        "a torque curve of 100000",
        "[nominal.joints]",
        "[limits.hip]\ntorque_over_position = [" + ",".join(f"[{i},1]" for i in range(100_000)) + "]\n[nominal.joints]",
        "robot.toml:",
        "at most",
    )
    for value in ("nan", "inf", "-1", "1e308", "true", '"x"', "1979-05-27", "9" * 400):
        yield robot(f"radius {value[:8]}", "radius_m = 0.02", f"radius_m = {value}", "robot.toml:3:")
        yield (
            robot(f"hip {value[:8]}", "hip = 0.1", f"hip = {value}", "robot.toml:5:")
            if value != "-1"
            else robot("joint that is not there", "hip = 0.1", "hop = 0.1", "did you mean 'hip'")
        )
    for name in (
        '"\\u001b[2J"',
        '"<script>alert(1)</script>"',
        '"\\u202eabc"',
        '"é"',
        '"a\\nb"',
        f'"{MEGABYTE}"',
        '""',
        '"../x"',
    ):
        status = 0 if "script" in name or ".." in name else 2
        yield robot(f"named {name[:12]}", '"small"', name, status=status)
        yield robot(f"contact named {name[:12]}", '"toe"', name, status=status)
        yield robot(f"frame {name[:12]}", '"foot"', name, "robot.toml:3:")
        yield robot(f"key {name[:12]}", "[nominal.joints]\nhip", f"[nominal.joints]\n{name}", "robot.toml:")
        yield (
            robot(f"unknown key {name[:12]}", "urdf =", f"{name} = 1\nurdf =", "robot.toml:2:", "unknown key")
            if name != '""'
            else robot("no name", 'name = "small"', "", "missing")
        )
    yield robot("frame universe", '"foot"', '"universe"', "robot.toml:3:", "universe")
    yield robot("frame root_joint", '"foot"', '"root_joint"', "robot.toml:3:", "root_joint")
    yield robot(
        "package_dirs that is not there",
        'urdf = "robot.urdf"',
        'urdf = "robot.urdf"\npackage_dirs = ["nowhere"]',
        status=0,
    )
    yield robot(
        "20000 package_dirs",
        'urdf = "robot.urdf"',
        'urdf = "package://a/b"\npackage_dirs = [' + '".",' * 20_000 + "]",
        "robot.toml:",
        "at most",
    )
    yield Case(
        "--package-dir that is not there",
        {},
        (*ROBOT_COMMAND, "--package-dir", "nowhere"),
        ("--package-dir", "nowhere"),
    )


def cases():
    yield from urdf_cases()
    yield from robot_file_cases()
