"""Malicious files, each given to the real prowl: one clear message and exit status 2, within a second and 500 MB.

    bad_input_test.py PROWL [WORDS OF A CASE'S NAME]
"""
import pathlib
import sys
import tempfile
import unittest

import bad_plans
import bad_robots
import bad_tasks
from bad_input_support import check


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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
