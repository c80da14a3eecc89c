"""Malicious files, each given to the real prowl: one clear message and exit status 2, within a second and 500 MB.

bad_input_test.py PROWL [WORDS OF A CASE'S NAME]
"""

import json
import pathlib
import sys
import tempfile
import unittest

import bad_plans
import bad_robots
import bad_tasks
from bad_input_support import CONTROL, SOUND, check, run


class BadInput(unittest.TestCase):
    def check_all(self, cases):
        checked = 0
        for case in cases:
            if not all(word in case.name for word in sys.argv[2:]):
                continue
            with self.subTest(case.name.encode("ascii", "backslashreplace").decode()):
                found, _ = check(case)
                self.assertFalse(found, "\n".join(found))
            checked += 1
        return checked

    def test_robots(self):
        self.assertGreater(self.check_all(bad_robots.cases()), 100)

    def test_tasks(self):
        self.assertGreater(self.check_all(bad_tasks.cases()), 100)

    def test_plans(self):
        with tempfile.TemporaryDirectory() as folder:
            plans = bad_plans.Plans(bad_plans.make_sound(pathlib.Path(folder)))
            self.assertGreater(self.check_all(plans.cases()), 100)
            self.assertGreater(self.check_all(plans.every_leaf()), 100)

    def test_html_in_names_is_text_in_a_report(self):
        script = "<script>alert(1)</script>"
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            for file, text in SOUND.items():
                (folder / file).write_text(text.replace('"small"', f'"{script}"').replace('"stand"', f'"{script}"'))
            run(("plan", "task.toml", "--out", "plan"), folder)
            answer = run(("report", "plan"), folder)
            self.assertEqual(answer.status, 0, answer.error)
            page = (folder / "plan/report.html").read_text()
            self.assertNotIn(script, page)
            self.assertIn("\\u003cscript>alert(1)", page)

    def test_texts_of_a_plan_do_not_speak_to_the_terminal(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            plans = bad_plans.Plans(bad_plans.make_sound(folder))
            plan = bad_plans.changed(plans.plan, ("hints",), ["\x1b[2Jhint"])
            (folder / "plan/plan.json").write_text(plan)
            answer = run(("check", "plan"), folder)
            self.assertIn("\\x1b[2Jhint", answer.out)
            self.assertIsNone(CONTROL.search(answer.out))
            self.assertEqual(json.loads(run(("check", "plan", "--json"), folder).out)["hints"], ["\x1b[2Jhint"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
