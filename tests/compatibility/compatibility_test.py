"""What commit 0f26b62 wrote still works, and what it named is still there: README.md in this folder.

compatibility_test.py PROWL
"""

import copy
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
import unittest

import cases
import names

KEPT = pathlib.Path(__file__).parent / "0f26b62"
REFERENCE = json.loads((KEPT / "reference.json").read_text())
PROWL = sys.argv[1] if len(sys.argv) > 1 else "prowl"

CHOICES_OF_KEYS = {  # a line of a kept task file, with each of its choices
    ("step", 'friction_model = "{}"'): ("pyramid", "cone"),
    ("step", 'steps = "{}"'): ("equal", "free"),
    ("step", 'torque_reference = "{}"'): ("static", "zero"),
    ("step", 'reference = "{}"'): ("start", "goal"),
    ("gait", 'kind = "{}"'): ("walk", "trot", "pace", "bound"),
}

CHANGED_ON_PURPOSE = {
    "diagnose_changes": {"status": "infeasible"},  # a solve that failed names the limits that conflict
    "simulate_case": {"exit_status": 0, "success": True},  # sweeps draw from other ranges: case 5 is another world
}
CHANGED_COSTS = {"plan_gait": 1.0028}  # over those of 0f26b62: each held foot carries a fifth of its even load


def missing(old, new) -> list[str]:
    return sorted(set(old) - set(new))


def prowl(*arguments, folder=None) -> subprocess.CompletedProcess:
    return subprocess.run(
        [PROWL, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=cases.MOST_SECONDS
    )


def kept_tables(pattern: str) -> list[dict]:
    return [tomllib.loads(path.read_text()) for path in sorted(KEPT.glob(pattern))]


def without(value, name: str):
    """A JSON value without the key of this name, "checks[].limit" for example."""
    first, _, rest = name.partition(".")
    key, lists = first.rstrip("[]"), first.count("[]")
    value = copy.copy(value)
    if not rest:
        del value[key]
        return value

    def inside(entry, depth):
        if depth:
            return [inside(each, depth - 1) for each in entry]
        return without(entry, rest) if isinstance(entry, dict) and name_is_in(entry, rest) else entry

    value[key] = inside(value[key], lists)
    return value


def name_is_in(value: dict, name: str) -> bool:
    return name.partition(".")[0].rstrip("[]") in value


class Compatibility(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.work = pathlib.Path(folder.name) / "work"
        shutil.copytree(KEPT, cls.work)
        cls.outcomes = {case.name: cases.run(case, PROWL, sys.executable, cls.work) for case in cases.CASES}
        cls.names = cases.names_by_kind(list(cls.outcomes.values()))

    def test_every_verb_option_and_choice_is_still_there(self):
        for verb, old in REFERENCE["options"].items():
            with self.subTest(verb=verb):
                help_text = prowl(*verb.split(), "--help")
                self.assertEqual(help_text.returncode, 0)
                gone = missing(old, names.of_help(help_text.stdout))
                self.assertEqual(gone, [])
        self.assertEqual(prowl("--version").returncode, 0)

    def test_every_name_in_json_csv_and_exports_is_still_there(self):
        for kind, old in REFERENCE["names"].items():
            with self.subTest(kind=kind):
                self.assertIn(kind, self.names)
                self.assertEqual(missing(old, self.names[kind]), [])

    def test_every_command_comes_to_the_same(self):
        self.assertEqual(missing(REFERENCE["facts"], self.outcomes), [])
        for name, old in REFERENCE["facts"].items():
            with self.subTest(case=name):
                new = self.outcomes[name].facts
                if "cost" in old:
                    # Since 0f26b62 a refined mesh has fewer nodes, so that the best torques on it cost a little more.
                    delta = 1e-2 if name == "plan_refined" else 1e-3
                    ratio = new.pop("cost") / old.pop("cost")
                    self.assertAlmostEqual(ratio, CHANGED_COSTS.get(name, 1.0), delta=delta)
                self.assertEqual(new, {**old, **CHANGED_ON_PURPOSE.get(name, {})})

    def test_every_key_is_in_a_file_that_was_read(self):
        tables = {"task": kept_tables("tasks/*.toml"), "robot": kept_tables("robot.toml")}
        for kind, keys in REFERENCE["keys"].items():
            found = set().union(*(names.of_toml(table) for table in tables[kind]))
            found |= {re.sub(r"^limits\.\w+\.", "limits.", name) for name in found}
            self.assertEqual(missing(keys, found), [], f"keys that no kept {kind} file has")
            self.assertGreater(len(keys), 15)

    def test_every_choice_of_a_key_is_read(self):
        for (task, line), choices in CHOICES_OF_KEYS.items():
            text = (KEPT / f"tasks/{task}.toml").read_text()
            for choice in choices:
                with self.subTest(line=line.format(choice)):
                    self.assertEqual(text.count("\n" + line.format(choices[0])), 1)
                    file = self.work / "tasks/choice.toml"
                    file.write_text(text.replace("\n" + line.format(choices[0]), "\n" + line.format(choice)))
                    done = prowl("plan", file, "--print-phases")
                    self.assertEqual(done.returncode, 0, done.stderr)

    def test_tracker_gives_the_same_torques(self):
        try:
            from tracker_torques import tracker_torques

            torques = tracker_torques(KEPT / "out/crouch/tracker.bin")
        except ImportError as error:
            self.skipTest(f"without the Python package: {error}")
        self.assertEqual(len(torques), len(REFERENCE["tracker"]))
        for new, old in zip(torques, REFERENCE["tracker"]):
            self.assertGreater(max(map(abs, old)), 1.0)
            for a, b in zip(new, old, strict=True):
                self.assertAlmostEqual(a, b, delta=1e-9 * max(map(abs, old)))


class TheTestItself(unittest.TestCase):
    """Without any single name it would fail."""

    def test_cases_use_every_option_and_choice(self):
        used = cases.options_used()
        choices = {name for _, name in used}
        for verb, old in REFERENCE["options"].items():
            for name in old:
                if not verb or name == "--help" or not name.startswith("--"):
                    continue
                with self.subTest(verb=verb, name=name):
                    self.assertIn(name, choices) if " " in name else self.assertIn((verb, name), used)

    def test_each_name_taken_away_is_missed(self):
        for old in (*REFERENCE["options"].values(), *REFERENCE["names"].values(), *REFERENCE["keys"].values()):
            for name in old:
                self.assertEqual(missing(old, set(old) - {name}), [name])

    def test_each_option_taken_out_of_the_help_is_missed(self):
        for verb in REFERENCE["options"]:
            text = prowl(*verb.split(), "--help").stdout
            for name in names.of_help(text):
                option, _, choice = name.partition(" ")
                line = re.search(rf"^ +(-\w,)?{re.escape(option)}\b(?!-).*$", text, re.MULTILINE)[0]
                shorter = re.sub(rf"([{{,]){re.escape(choice)}(?=[,}}]),?", r"\1", line) if choice else ""
                self.assertNotIn(name, names.of_help(text.replace(line, shorter)), line)

    def test_each_key_taken_out_of_a_plan_is_missed(self):
        plan = json.loads((KEPT / "out/crouch/plan.json").read_text())
        found = names.of_json(plan)
        self.assertGreater(len(found), 100)
        for name in found:
            gone = found - names.of_json(without(plan, name))
            self.assertIn(name, gone)
            self.assertTrue(all(re.match(rf"{re.escape(name)}(\.|\[|$)", other) for other in gone), gone)

    def test_each_column_taken_out_of_a_trajectory_is_missed(self):
        text = (KEPT / "out/crouch/trajectory.csv").read_text()
        columns = names.of_csv(text)
        for column in columns:
            self.assertEqual(columns - names.of_csv(re.sub(rf"(?<![\w]){column}(,|(?=\n))", "", text)), {column})

    def test_kept_files_have_the_names_of_the_lists(self):
        files = [path for path in KEPT.rglob("*") if path.is_file() and names.of_file(path)]
        kinds = {path.name for path in files} - {"reference.json"}
        self.assertGreaterEqual(
            kinds,
            {"plan.json", "trajectory.csv", "trajectory_uniform.csv", "simulate.json", "simulate.csv", "sweep.json"},
        )
        for path in files:
            if path.name != "reference.json":
                self.assertEqual(missing(names.of_file(path), REFERENCE["names"][path.name]), [], path)


if __name__ == "__main__":
    sys.argv[1:] = []
    unittest.main()
