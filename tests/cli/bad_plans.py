"""Malicious folders of plans: plan.json, trajectory.csv, tracker.bin and simulate.csv of a sound one, damaged."""

import json
import os
import pathlib
import struct
import subprocess

from bad_input_support import PROWL, SOUND, Case
from bad_robots import ESCAPE, MEGABYTE


def make_sound(root):
    """A folder with a plan of the small robot, finished or not."""
    for name, content in SOUND.items():
        (root / name).write_text(content)
    subprocess.run(
        [PROWL, "plan", "task.toml", "--out", "plan"],
        cwd=root,
        check=False,
        capture_output=True,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )
    assert (root / "plan/plan.json").exists()
    return root / "plan"


def leaves(node, path=()):
    """Paths of all values; of a list its first only."""
    entries = node.items() if isinstance(node, dict) else list(enumerate(node))[:1] if isinstance(node, list) else ()
    for key, value in entries:
        yield (*path, key)
        yield from leaves(value, (*path, key))


def changed(plan, path, value):
    """The JSON of the plan with `value` at the path."""
    root = json.loads(json.dumps(plan))
    node = root
    for key in path[:-1]:
        node = node[key]
    node[path[-1]] = value
    return json.dumps(root)


def sparse(size):
    """Makes a file of so many zeros that takes no space."""
    return lambda path: (path.touch(), os.truncate(path, size))


class Plans:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.text = (folder / "plan.json").read_text()
        self.plan = json.loads(self.text)
        self.rows = (folder / "trajectory.csv").read_text()

    def case(self, name, files, *says, verb="check", status=2):
        return Case(
            "plan: " + name, {"plan/" + k: v for k, v in files.items()}, (verb, "plan"), says, status, self.folder
        )

    def json_cases(self):
        bad = lambda name, text, *says, **more: self.case(name, {"plan.json": text}, "plan.json", *says, **more)  # noqa: E731
        first = lambda text: self.text.replace("{", "{" + text + ",", 1)  # noqa: E731
        for size in (0, 1, 100, 1000, len(self.text) // 2, len(self.text) - 3):
            yield bad(f"plan.json cut at {size}", self.text[:size])
        yield bad("plan.json, binary", bytes(range(256)))
        yield bad("plan.json, a list", "[]")
        yield bad("plan.json, null", "null")
        yield bad("plan.json, 200 MB", self.text + " " * 200_000_000, "bytes")
        for depth in (1000, 1_000_000):
            yield bad(f"plan.json, {depth} deep", first('"x":' + "[" * depth + "]" * depth), "deep")
            yield bad(f"plan.json, objects {depth} deep", first('"x":' + '{"a":' * depth + "1" + "}" * depth), "deep")
            yield bad(
                f"plan.json, version {depth} deep",
                self.text.replace(
                    '"schema_version": ', '"schema_version": ' + "[" * depth + "]" * depth + ', "y": ', 1
                ),
                "deep",
            )
        yield bad("plan.json, 300000 keys", first(",".join(f'"k{i}":1' for i in range(300_000))), "keys")
        yield bad(
            "plan.json, 2000 objects of 1000 keys",
            first('"x":[' + ",".join(["{" + ",".join(f'"k{i}":1' for i in range(1000)) + "}"] * 2000) + "]"),
            "keys",
        )
        yield self.case(
            "plan.json, 9000 objects of 200 keys",
            {
                "plan.json": first(
                    '"x":[' + ",".join(["{" + ",".join(f'"k{i}":1' for i in range(200)) + "}"] * 9000) + "]"
                )
            },
            status=6 if json.loads(self.text)["status"] == "iteration_limit" else 3,
        )
        yield bad("plan.json, 9 million numbers", first('"x":[' + "0," * 9_000_000 + "0]"), "values")
        yield bad("plan.json, NaN", self.text.replace('"seconds": ', '"seconds": NaN, "s": ', 1))
        yield bad("plan.json, half a character", self.text.replace('"name": "', '"name": "\\ud800', 1))
        yield bad("plan.json, no UTF-8", self.text.encode().replace(b'"name": "', b'"name": "\xff\xfe', 1))
        for value in (None, "x", -1, 1e308, [], {}, [[]], True, MEGABYTE, ESCAPE):
            yield bad(
                f"schema_version {str(value)[:6]!r}", changed(self.plan, ("schema_version",), value), "schema_version"
            )
            yield bad(
                f"intervals {str(value)[:6]!r}",
                changed(self.plan, ("problem", "phases", 0, "intervals"), value),
                "intervals",
            )
        for value in (0, -1, 10_000_000, 1e9):
            yield bad(
                f"intervals {value}", changed(self.plan, ("problem", "phases", 0, "intervals"), value), "intervals"
            )
            yield self.case(
                f"overrides.intervals {value}", {"plan.json": changed(self.plan, ("overrides",), {"intervals": value})}
            )
        for path in (("task_file", "text"), ("robot_file", "text"), ("urdf", "text")):
            for value in ("", "x", ESCAPE, MEGABYTE, "[" * 100_000, "\0"):
                yield self.case(f"{'.'.join(path)} {value[:6]!r}", {"plan.json": changed(self.plan, path, value)})
        for path in (("task_file", "path"), ("robot_file", "path"), ("urdf", "path")):
            yield self.case(
                f"{'.'.join(path)} {ESCAPE!r}",
                {"plan.json": changed(self.plan, path, ESCAPE).replace("intervals = 5", "intervals = 0")},
            )

    def every_leaf(self):
        """Another type at every place: refused, or of no consequence."""
        for path in leaves(self.plan):
            for value in ({"a": 1}, ESCAPE):
                yield self.case(
                    f"{'.'.join(map(str, path))} is {str(value)[:4]!r}",
                    {"plan.json": changed(self.plan, path, value)},
                    status=None,
                )

    def file_cases(self):
        for name in ("plan.json", "trajectory.csv"):
            for kind, make in (
                ("a pipe", os.mkfifo),
                ("a folder", os.mkdir),
                ("a link to itself", lambda p: os.symlink(p, p)),
                ("a link to /dev/zero", lambda p: os.symlink("/dev/zero", p)),
                ("gone", lambda p: None),
            ):
                yield self.case(f"{name} is {kind}", {name: make}, name)
        for verb in ("simulate", "sweep"):
            yield Case(f"{verb} --seed -1", {}, (verb, "plan", "--seed", "-1"), ("--seed",), folder=self.folder)
        yield Case("plan is /dev", {}, ("check", "/dev"), ("plan.json",))
        yield Case("plan is /dev/zero", {}, ("check", "/dev/zero"), ("/dev/zero",))
        lines = self.rows.splitlines(keepends=True)
        bad = lambda name, text, *says: self.case(name, {"trajectory.csv": text}, "trajectory.csv", *says)  # noqa: E731
        yield bad("trajectory.csv, empty", "")
        yield bad("trajectory.csv, no last line", "".join(lines[:-1]), "rows")
        yield bad("trajectory.csv, cut short", self.rows[:-5])
        yield bad("trajectory.csv, lines without end", self.rows + "\n" * 100_000_000, "bytes")
        yield bad("trajectory.csv, a line of 50 MB", lines[0] + "1," * 25_000_000 + "\n", "bytes")
        yield bad("trajectory.csv, columns", ESCAPE + self.rows, "columns")
        for cell in ("nan", "inf", "1e999", "", ESCAPE, "x" * 3000, "0x1", " 1", "1e400"):
            rows = [*lines[:2], lines[2].rsplit(",", 1)[0] + "," + cell + "\n", *lines[3:]]
            yield bad(f"trajectory.csv, a cell {cell[:6]!r}", "".join(rows), "trajectory.csv:3")
        yield bad(
            "trajectory.csv, no quaternion",
            lines[0] + "".join(",".join(["0"] * (row.count(",") + 1)) + "\n" for row in lines[1:]),
            "quaternion",
        )

    def tracker_cases(self):
        bad = lambda name, data, *says: self.case(name, {"tracker.bin": data}, "tracker.bin", *says, verb="simulate")  # noqa: E731
        header = lambda *counts: b"PROWLTRK" + struct.pack("<6I", *counts)  # noqa: E731
        for size in (0, 7, 8, 40, 60):
            yield bad(f"tracker.bin of {size} bytes", (header(1, 1, 1, 1, 0, 100) + bytes(100))[:size])
        yield bad("tracker.bin, counts", header(1, *[0xFFFFFFFF] * 5) + struct.pack("<QQ", 0, 0xCBF29CE484222325))
        yield bad("tracker.bin, payload", header(1, 1, 1, 1, 0, 100) + struct.pack("<QQ", 1 << 63, 0))
        yield bad("tracker.bin, binary", bytes(range(256)) * 1000)
        yield bad("tracker.bin, a gigabyte", sparse((1 << 30) - 1))
        yield bad(
            "tracker.bin, a gigabyte with a header",
            lambda p: (
                p.write_bytes(header(1, 1, 1, 1, 0, 100) + struct.pack("<QQ", 800_000_000, 0)),
                os.truncate(p, 800_000_056),
            ),
        )
        yield bad("tracker.bin, 2 GB", sparse(2 << 30))
        for kind, make in (
            ("a pipe", os.mkfifo),
            ("a folder", os.mkdir),
            ("a link to /dev/zero", lambda p: os.symlink("/dev/zero", p)),
        ):
            yield bad(f"tracker.bin is {kind}", make)

    def simulation_cases(self):
        bad = lambda name, files, *says: self.case(name, files, *says, verb="report")  # noqa: E731
        yield bad("simulate.csv, lines", {"simulate.csv": "time_s\n" + "\n" * 1_000_000}, "simulate.csv")
        yield bad("simulate.csv, a header of a megabyte", {"simulate.csv": MEGABYTE + "\n1\n"}, "simulate.csv")
        yield bad("simulate.csv, a million columns", {"simulate.csv": "a," * 1_000_000 + "\n1\n"}, "simulate.csv")
        yield bad("simulate.csv, 600 MB", {"simulate.csv": sparse(600_000_000)}, "simulate.csv")
        yield bad("simulate.csv is a pipe", {"simulate.csv": os.mkfifo}, "simulate.csv")

    def cases(self):
        yield from self.json_cases()
        yield from self.file_cases()
        yield from self.tracker_cases()
        yield from self.simulation_cases()
