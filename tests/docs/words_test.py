"""The documentation is short enough to be read: a limit on the words of all Markdown files together, and what counts them.

words_test.py
"""

import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).parents[2]
LIMIT = 26_000
NOT_COUNTED = {
    "CHANGELOG.md",
    "reference.md",
    "robots.md",
    "simulated-tasks.md",
    "online-benchmark.md",
}  # grows with every change; made from the code, by a script
TOLD = ["README.md", "docs/*.md", "cli", "screen", "prowl", "python/prowl", "python/src", "report/src"]  # read by users
STUMBLED = re.compile(
    r"processes want to run|has AVX2|\bin rest\b|step cubed|solved but for|once more to end|judged by other code"
)
sys.dont_write_bytecode = True
loader = importlib.machinery.SourceFileLoader("prose", str(ROOT / "scripts/prose"))
prose = importlib.util.module_from_spec(importlib.util.spec_from_loader("prose", loader))
loader.exec_module(prose)

PAGE = """# A heading of five words

Prowl plans. `prowl plan a.toml` writes
one folder, e.g. the [first one](start.md). **Then.** It checks it.

| a table | is no sentence |
|---|---|

- One item
- Another item of the list

```sh
a command. Not a sentence.
```
"""


class Words(unittest.TestCase):
    def test_there_are_not_too_many(self):
        counted = {
            page.relative_to(ROOT): prose.words(page) for page in prose.tracked_pages() if page.name not in NOT_COUNTED
        }
        self.assertGreater(len(counted), 20)
        longest = sorted(counted.items(), key=lambda entry: -entry[1])[:10]
        lines = "\n".join(f"{count:6} {name}" for name, count in longest)
        self.assertLessEqual(sum(counted.values()), LIMIT, f"the longest pages:\n{lines}")

    def test_what_readers_stumbled_over_is_gone(self):
        tracked = subprocess.run(["git", "ls-files", *TOLD], cwd=ROOT, check=True, capture_output=True, text=True)
        files = [ROOT / name for name in tracked.stdout.splitlines()]
        self.assertGreater(len(files), 300)
        for file in files:
            text = file.read_text(encoding="utf-8")
            shown = [text] if file.suffix == ".md" else re.findall(r'"(?:[^"\\\n]|\\.)*"', text)
            for line in shown:
                self.assertIsNone(STUMBLED.search(line), f"{file.relative_to(ROOT)}: {line[:200]}")
        self.assertTrue(STUMBLED.search("2; 0.2 processes want to run"))

    def test_sentences_are_those_of_paragraphs_and_lists(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.md"
            page.write_text(PAGE, encoding="utf-8")
            found = [sentence.replace(prose.JOINED, " ") for sentence in prose.sentences(page)]
            self.assertEqual(
                found,
                [
                    "Prowl plans.",
                    "`prowl plan a.toml` writes one folder, e.g. the first one.",
                    "**Then.",
                    "It checks it.",
                    "One item",
                    "Another item of the list",
                ],
            )
            self.assertEqual(prose.words(page), len(PAGE.split()))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
