"""The site builds without a warning, no link in it leads nowhere, and it asks no other computer for anything.

site_test.py PROWL ROBOTS_DATA
"""

import html.parser
import pathlib
import re
import shutil
import subprocess
import sys
import unittest
import urllib.parse

ROOT = pathlib.Path(__file__).parents[2]
command = robots = None


class Page(html.parser.HTMLParser):
    """Names that links may go to, links, and what the browser loads by itself."""

    def __init__(self, path: pathlib.Path):
        super().__init__()
        self.path, self.names, self.links, self.loads = path, set(), [], []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        entries = dict(attributes)
        self.names |= {entries[key] for key in ("id", "name") if entries.get(key)}
        if tag == "a" and entries.get("href"):
            self.links.append(entries["href"])
        elif tag == "link" and entries.get("rel") not in ("canonical", "prev", "next"):
            self.loads.append(entries.get("href"))
        elif entries.get("src"):
            self.loads.append(entries["src"])


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.out = pathlib.Path(command).parents[1] / "site"
        build = subprocess.run(
            [sys.executable, ROOT / "site" / "build.py", "--prowl", command, "--out", cls.out, "--package-dir", robots],
            capture_output=True,
            text=True,
        )
        if build.returncode != 0:
            raise AssertionError(f"the site does not build:\n{build.stdout}{build.stderr}")
        cls.pages = {path: Page(path) for path in sorted(cls.out.rglob("*.html"))}

    def test_every_page_of_docs_is_there(self):
        for page in (ROOT / "docs").glob("*.md"):
            self.assertIn(self.out / f"{page.stem}.html", self.pages)
        self.assertIn(self.out / "api" / "classprowl_1_1ForwardDynamics.html", self.pages)

    def test_links_lead_somewhere(self):
        followed, broken = 0, []
        for page in self.pages.values():
            for link in page.links:
                target = urllib.parse.urlsplit(link)
                if target.scheme or target.netloc or link.startswith("javascript:"):
                    continue
                if target.fragment == "nested-classes":  # Doxygen's own, of classes whose nested ones are private
                    continue
                path = (page.path.parent / urllib.parse.unquote(target.path)).resolve() if target.path else page.path
                other = self.pages.get(path)
                followed += 1
                if not path.exists() or (
                    target.fragment and other and urllib.parse.unquote(target.fragment) not in other.names | {"__top"}
                ):
                    broken.append(f"{page.path.relative_to(self.out)}: {link}")
        self.assertGreater(followed, 1000)
        self.assertEqual(broken, [], f"{len(broken)} links lead nowhere")

    def test_nothing_comes_from_the_network(self):
        own = 0
        for page in self.pages.values():
            for load in page.loads:
                if load.startswith(("data:", "javascript:")):
                    continue
                self.assertNotRegex(load, r"^(https?:)?//", page.path)
                self.assertTrue((page.path.parent / load.split("?")[0].split("#")[0]).exists(), f"{page.path}: {load}")
                own += 1
        self.assertGreater(own, 1000)
        for style in self.out.rglob("*.css"):
            self.assertNotRegex(
                style.read_text(encoding="utf-8"), r"url\(['\"]?(https?:)?//|@import ['\"](https?:)?//", style
            )

    def test_equations_and_pictures_are_part_of_the_pages(self):
        text = (self.out / "theory.html").read_text(encoding="utf-8")
        self.assertGreater(len(re.findall(r'class="equation-block"><span class="katex', text)), 10)
        for page in self.pages:
            if page.is_relative_to(self.out / "api") or page.is_relative_to(self.out / "source"):
                continue
            self.assertNotIn('class="arithmatex"', page.read_text(encoding="utf-8"), page)
        concepts = (self.out / "concepts.html").read_text(encoding="utf-8")
        self.assertGreaterEqual(concepts.count('<svg role="img" aria-label='), 3)

    def test_in_a_browser(self):
        node = ROOT / ".venv" / "bin" / "node"
        pictures = self.out.with_name("site-pictures")
        shutil.rmtree(pictures, ignore_errors=True)  # those of pages that are gone
        run = subprocess.run(
            [node, pathlib.Path(__file__).with_name("browse.mjs"), self.out, pictures], capture_output=True, text=True
        )
        self.assertEqual(run.returncode, 0, f"{run.stdout}{run.stderr}")
        self.assertGreaterEqual(len(list(pictures.glob("*.png"))), 12)


if __name__ == "__main__":
    command, robots = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1])
