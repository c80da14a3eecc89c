"""The gallery shows every shipped task, the page of examples each of them, the README a robot that moves, and scripts/pictures makes such pictures.

pictures_test.py PROWL ROBOTS_DATA
"""

import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from PIL import Image

ROOT = pathlib.Path(__file__).parents[2]
PICTURES = ROOT / "docs/pictures"
ENTRY = re.compile(
    r"!\[[^\]]+\]\(pictures/(?P<picture>[\w-]+\.webp)\)<br>\[[^\]]+\]\(\.\./(?P<task>tasks/\w+/\w+|examples/tasks/\w+)\.toml\)"
)
command = robots = None


def contrast(path: pathlib.Path) -> float:
    """Difference of the brightest and the darkest grey: 255 at most, next to 0 in a picture of nothing."""
    with Image.open(path) as picture:
        low, high = picture.convert("L").getextrema()
    return high - low


def size(path: pathlib.Path) -> tuple[int, int]:
    with Image.open(path) as picture:
        return picture.size


class Pictures(unittest.TestCase):
    def test_a_page_shows_every_shipped_task_and_another_every_example(self):
        for page, tasks, least in (("gallery", "tasks/*/*.toml", 20), ("examples", "examples/tasks/*.toml", 11)):
            with self.subTest(page=page):
                self.check_page(page, tasks, least)

    def check_page(self, page: str, tasks: str, least: int):
        text = (ROOT / f"docs/{page}.md").read_text("utf-8")
        shown = {match["task"]: match["picture"] for match in ENTRY.finditer(text)}
        shipped = {path.relative_to(ROOT).with_suffix("").as_posix() for path in ROOT.glob(tasks)}
        self.assertGreater(len(shipped), least)
        self.assertEqual(set(shown), shipped)
        for task, name in shown.items():
            with self.subTest(task=task):
                motion = task.replace("examples/tasks", "examples").removeprefix("tasks/")
                self.assertEqual(name, f"{motion.replace('/', '-')}.webp")
                self.assertEqual(size(PICTURES / name), (240, 180))
                self.assertGreater(contrast(PICTURES / name), 100)
        self.assertLess(sum((PICTURES / name).stat().st_size for name in shown.values()), 2e6)

    def test_the_readme_shows_robots_that_move(self):
        readme = (ROOT / "README.md").read_text("utf-8")
        names = re.findall(r"!\[[^\]]+\]\(docs/pictures/([\w-]+\.webp)\)", readme)
        self.assertEqual(names, ["trot.webp", "kick.webp"])
        for name in names:
            self.assertLess((PICTURES / name).stat().st_size, 3e6)
            with Image.open(PICTURES / name) as moving:
                self.assertGreater(moving.n_frames, 20)
                first = moving.convert("RGB").tobytes()
                moving.seek(moving.n_frames // 2)
                self.assertNotEqual(first, moving.convert("RGB").tobytes())
        self.assertLessEqual(len(readme.splitlines()), 120)

    def test_the_script_films_a_plan(self):
        with tempfile.TemporaryDirectory() as folder:
            run = subprocess.run(
                [sys.executable, ROOT / "scripts/pictures", "hyq/hold", "--prowl", command, "--out", folder]
                + ["--package-dir", robots],
                capture_output=True,
                text=True,
            )
            self.assertEqual(run.returncode, 0, run.stderr)
            (picture,) = pathlib.Path(folder).iterdir()
            self.assertEqual(picture.name, "hyq-hold.webp")
            self.assertEqual(size(picture), (240, 180))
            self.assertGreater(contrast(picture), 100, "the robot is not in the picture")

    def test_the_script_names_what_it_does_not_know(self):
        run = subprocess.run(
            [sys.executable, ROOT / "scripts/pictures", "hyq/fly", "--prowl", command], capture_output=True, text=True
        )
        self.assertEqual(run.returncode, 1)
        self.assertIn("unknown: hyq/fly; need some of", run.stderr)


if __name__ == "__main__":
    command, robots = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
