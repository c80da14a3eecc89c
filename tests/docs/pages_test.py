"""The documentation's pages as text: each is in the navigation, what they name in the code exists, what they show is from files
that are built and run.

    pages_test.py
"""

import pathlib
import re
import sys
import tomllib
import unittest

import pymdownx.slugs

sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "site"))
from page_blocks import ROOT, blocks, pages, prose  # noqa: E402
from code_names import CODE_LINK, defining_line, linked_name, repository_file  # noqa: E402

LANGUAGES = {"sh", "text", "toml", "cpp", "cmake", "json", "math", "python", "xml"}
SLUG = pymdownx.slugs.slugify(case="lower")
# A page as code and pages name it: docs/theory.md#rank, or ](theory.md#rank).
MENTION = re.compile(r"docs/(?P<page>[\w-]+\.md)(?:#(?P<anchor>[\w-]+))?")

# That name pages. Of report/ and site/ not what npm has put there.
FOLDERS = """prowl alternatives screen cli python tests fuzz tasks robots schema examples bench scripts report/src site
    docs""".split()


def anchors(page: pathlib.Path) -> set[str]:
    headings = re.findall(r"^#+ +(.*)$", prose(page), re.MULTILINE)
    return {SLUG(re.sub(r"[`*]|\]\([^)]*\)|\[", "", heading), "-") for heading in headings}


class Pages(unittest.TestCase):
    def test_each_is_in_the_navigation(self):
        listed = set(
            re.findall(r": ([\w/-]+\.md)$", (ROOT / "site" / "mkdocs.yml").read_text(encoding="utf-8"), re.MULTILINE)
        )
        found = {str(page.relative_to(ROOT / "docs")) for page in (ROOT / "docs").rglob("*.md")}
        self.assertGreater(len(found), 20)
        self.assertEqual(found - listed, set(), "pages that are not in nav of site/mkdocs.yml")

    def test_each_block_says_what_it_is(self):
        wrong = [
            f"{block.place}: '{block.language}'"
            for page in pages()
            for block in blocks(page)
            if block.language not in LANGUAGES
        ]
        self.assertEqual(
            wrong, [], f"blocks need a language, one of {', '.join(sorted(LANGUAGES))}; sh are commands that are run"
        )

    def test_code_that_is_linked_exists(self):
        names = 0
        for page in pages():
            for match in CODE_LINK.finditer(prose(page)) if page.parent.name == "docs" else ():
                with self.subTest(page=page.name, link=match[0]):
                    path = repository_file(ROOT, match["target"])
                    self.assertTrue(linked_name(match["text"]) is None or defining_line(path, match["text"]))
                    names += linked_name(match["text"]) is not None
        self.assertGreater(names, 30)

    def test_links_of_the_readme_lead_somewhere(self):
        links = re.findall(r"\]\(([^)\s]+)\)", prose(ROOT / "README.md"))
        self.assertGreater(len(links), 10)
        for link in links:
            path, _, anchor = link.partition("#")
            with self.subTest(link=link):
                self.assertTrue(link.startswith("https://") or (ROOT / path).exists())
                self.assertTrue(not anchor or anchor in anchors(ROOT / path))

    def test_pages_named_in_code_exist(self):
        mentions = 0
        for folder in FOLDERS:
            for path in sorted((ROOT / folder).rglob("*")):
                if (
                    not path.is_file()
                    or "node_modules" in path.parts
                    or path.suffix in (".png", ".pyc")
                    or path == pathlib.Path(__file__)
                ):
                    continue
                for match in MENTION.finditer(path.read_text(encoding="utf-8", errors="replace")):
                    mentions += 1
                    page = ROOT / "docs" / match["page"]
                    with self.subTest(file=str(path.relative_to(ROOT)), mention=match[0]):
                        self.assertTrue(page.exists())
                        self.assertTrue(not match["anchor"] or match["anchor"] in anchors(page))
        self.assertGreater(mentions, 20)

    def test_every_section_of_the_theory_says_where_it_is_in_the_code(self):
        sections = re.split(r"^## ", prose(ROOT / "docs" / "theory.md"), flags=re.MULTILINE)[1:]
        self.assertGreater(len(sections), 5)
        for section in sections:
            with self.subTest(section=section.splitlines()[0]):
                self.assertRegex(section, CODE_LINK)

    def test_cpp_is_from_files_that_are_built(self):
        shown = [block for page in pages() for block in blocks(page) if block.language == "cpp"]
        self.assertGreater(len(shown), 2)
        for block in shown:
            with self.subTest(block=block.place):
                source = block.remarked("part of")
                self.assertTrue(source, "say which file these lines are from: <!-- part of PATH -->")
                lines = lambda text: "\n".join(line.strip() for line in text.splitlines() if line.strip())  # noqa: E731
                self.assertIn(lines(block.text), lines((ROOT / source).read_text(encoding="utf-8")))

    def test_fragments_of_toml_are_toml(self):
        for page in pages():
            for block in blocks(page):
                if block.language == "toml" and block.remarked("fragment") is not None:
                    with self.subTest(block=block.place):
                        tomllib.loads(block.text)

    def test_all_requirements_pin_the_same(self):
        pins = {}
        for name in ("requirements.txt", "site/requirements.txt", "python/snopt-requirements.txt"):
            for line in (ROOT / name).read_text(encoding="utf-8").splitlines():
                if line and not line.startswith("#"):
                    package, _, version = line.partition("==")
                    self.assertTrue(version, f"{name}: {line} is not pinned exactly")
                    self.assertEqual(
                        pins.setdefault(package.lower().replace("_", "-"), version), version, f"{name}: {package}"
                    )


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
