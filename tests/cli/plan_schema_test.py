"""plan.json of all kinds of plans against schema/plan.schema.json, and the schema against what is not a plan.

plan_schema_test.py PROWL ROBOTS_DATA
"""

import copy
import json
import pathlib
import sys
import tempfile
import unittest

from exports_support import ROOT, prowl
from jsonschema import Draft202012Validator

SCHEMA = json.loads((ROOT / "schema/plan.schema.json").read_text())


def objects(value, path=()):
    """All objects in a JSON value: path and keys. Of a list the first entry stands for all."""
    if isinstance(value, dict):
        yield path, list(value)
        for key, inside in value.items():
            yield from objects(inside, (*path, key))
    elif isinstance(value, list) and value:
        yield from objects(value[0], (*path, 0))


def shortened(value):
    """With the first entry of each list only: as good for a look at keys, and quick."""
    if isinstance(value, dict):
        return {key: shortened(inside) for key, inside in value.items()}
    return [shortened(entry) for entry in value[:1]] if isinstance(value, list) else value


def at(value, path):
    for key in path:
        value = value[key]
    return value


class PlanSchema(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        cls.work = pathlib.Path(cls.folder.name)
        cls.validator = Draft202012Validator(SCHEMA)
        too_far = cls.work / "too_far.toml"
        crouch = (ROOT / "tasks/hyq/crouch.toml").read_text().replace("../../robots", str(ROOT / "robots"))
        too_far.write_text(crouch.replace("[0, 0, -0.17]", "[0, 0, 1.5]"))
        cls.plans = {}
        for name, task, options, status in (
            ("crouch", ROOT / "tasks/hyq/crouch.toml", ["--intervals", 60], (0, 7)),
            ("gait", ROOT / "tasks/hyq/trot.toml", [], (0,)),
            (
                "unfinished",
                ROOT / "tasks/hyq/step.toml",
                ["--max-iterations", 2, "--one-mesh", "--intervals", 250],
                (6,),
            ),
            ("infeasible", too_far, [], (3,)),
            ("refined", ROOT / "tasks/hyq/step.toml", ["--refine"], (0,)),
        ):
            done = prowl("plan", task, *options, "--out", cls.work / name)
            if done.returncode not in status:
                raise AssertionError(f"{name}: {done.returncode}\n{done.stdout}{done.stderr}")
            cls.plans[name] = json.loads((cls.work / name / "plan.json").read_text())

    def faults(self, plan) -> list[str]:
        return [f"{error.json_path}: {error.message[:200]}" for error in self.validator.iter_errors(plan)]

    def test_is_a_schema(self):
        Draft202012Validator.check_schema(SCHEMA)
        self.assertEqual(SCHEMA["$schema"], "https://json-schema.org/draft/2020-12/schema")

    def test_plans_of_all_kinds_fit(self):
        for name, plan in self.plans.items():
            self.assertEqual(self.faults(plan), [], name)
        self.assertTrue(self.plans["gait"]["tracking"]["phases"])
        self.assertEqual(self.plans["crouch"]["overrides"], {"intervals": 60})
        self.assertEqual(self.plans["unfinished"]["status"], "iteration_limit")
        self.assertTrue(self.plans["infeasible"]["reasons"])
        self.assertEqual(self.plans["refined"]["problem"]["interpolation"], "hermite")
        uneven = [phase for phase in self.plans["refined"]["problem"]["phases"] if phase["shares"]]
        self.assertTrue(uneven)
        for phase in uneven:
            self.assertEqual(len(phase["shares"]), phase["intervals"])
            self.assertAlmostEqual(sum(phase["shares"]), 1.0, 12)

    def test_no_key_may_be_added_or_missing(self):
        optional = {("overrides",), ("versions",)}
        tried = 0
        for plan in map(shortened, (self.plans["gait"], self.plans["unfinished"])):
            for path, keys in objects(plan):
                if path == ("versions",):
                    continue  # any library
                more = copy.deepcopy(plan)
                at(more, path)["kee"] = 1
                self.assertTrue(self.faults(more), f"{path} with another key")
                for key in keys if path not in optional else ():
                    less = copy.deepcopy(plan)
                    del at(less, path)[key]
                    self.assertTrue(self.faults(less), f"{path} without {key}")
                    tried += 1
        self.assertGreater(tried, 150)

    def test_refuses_values_of_the_wrong_kind(self):
        for path, value in (
            ("schema_version", 3),
            ("schema_version", 11),
            ("status", "fine"),
            ("good", "yes"),
            ("certificate.grade", "A"),
            ("solver.iterations", -1),
            ("solver.iterations", 1.5),
            ("solver.hessian", "none"),
            ("solver.cost", "0"),
            ("problem.joints", "lf_haa_joint"),
            ("versions.prowl", 1),
            ("overrides.intervals", "60"),
        ):
            plan = shortened(self.plans["crouch"])
            *outer, last = path.split(".")
            at(plan, outer)[last] = value
            self.assertTrue(self.faults(plan), f"{path} = {value}")

    def test_documents_what_the_table_of_plan_directory_does(self):
        """Every key of the schema, in the page."""
        page = (ROOT / "docs/plan-directory.md").read_text()
        for path, keys in objects(self.plans["gait"]):
            if path[:1] in (("versions",), ("task_file",), ("robot_file",), ("urdf",)):
                continue
            for key in keys:
                self.assertIn(f"`{key}`", page, path)

    def test_the_command_reads_what_fits(self):
        for name, status in (
            ("crouch", (0, 7)),
            ("gait", (0,)),
            ("unfinished", (6,)),
            ("infeasible", (3, 7)),
            ("refined", (0,)),
        ):
            done = prowl("check", self.work / name)
            self.assertIn(done.returncode, status, name + done.stderr)

    def test_the_command_reads_the_version_before_and_tells_what_to_do_with_others(self):
        plan = copy.deepcopy(self.plans["crouch"])
        for key in ("hessian", "cpu_seconds", "evaluation", "convergence", "pivoted_stages"):
            del plan["solver"][key]
        for phase in plan["problem"]["phases"]:
            del phase["shares"]
        folder = self.work / "other version"
        folder.mkdir()
        (folder / "trajectory.csv").write_bytes((self.work / "crouch/trajectory.csv").read_bytes())
        for version, status, said in (
            (1, 0, ""),
            (2, 2, "cpu_seconds: missing"),
            (3, 2, "shares: missing"),
            (11, 2, "written by a newer Prowl"),
            (0, 2, "plan again with prowl plan"),
        ):
            plan["schema_version"] = version
            (folder / "plan.json").write_text(json.dumps(plan))
            done = prowl("check", folder)
            self.assertEqual(done.returncode in (0, 7), status == 0, f"{version}: {done.stderr}")
            self.assertEqual(done.returncode == 2, status == 2)
            self.assertIn(said, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
