"""Fenced blocks of the documentation's pages, with what is said about them beside the page's text.

<!-- not run: takes an hour -->       before commands: CI leaves them out, for this reason
<!-- fragment -->                     before TOML: a part of a file
<!-- part of tests/x/main.cpp -->     before C++: these lines are in that file, which is built and run
```toml title="robots/mine.toml"      the commands that follow find this file
prowl plan ...   # exit status 7      a command that is to end with another status than 0
"""

import dataclasses
import pathlib
import re

ROOT = pathlib.Path(__file__).parents[1]
FENCE = re.compile(r"^(?P<indent> *)(?P<mark>`{3,})(?P<info>[^`]*)$")
COMMENT = re.compile(r"^\s*<!--\s*(?P<text>.*?)\s*-->\s*$")
TITLE = re.compile(r'title="([^"]+)"')


@dataclasses.dataclass
class Block:
    page: pathlib.Path
    line: int
    language: str
    title: str
    remark: str
    text: str

    @property
    def place(self) -> str:
        return f"{self.page.relative_to(ROOT)}:{self.line}"

    def remarked(self, key: str) -> str | None:
        """What the comment before the block says after `key`."""
        return self.remark.removeprefix(key).lstrip(": ").strip() if self.remark.startswith(key) else None


def pages() -> list[pathlib.Path]:
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def blocks(page: pathlib.Path) -> list[Block]:
    found, block, end, remark = [], None, "", ""
    for number, line in enumerate(page.read_text(encoding="utf-8").splitlines(), 1):
        if block:
            if line.strip() == end:
                found.append(block)
                block, remark = None, ""
            else:
                block.text += line[indent:] + "\n"
        elif fence := FENCE.match(line):
            language, _, rest = fence["info"].strip().partition(" ")
            title = TITLE.search(rest)
            block = Block(page, number, language, title[1] if title else "", remark, "")
            indent, end = len(fence["indent"]), fence["mark"]
        elif comment := COMMENT.match(line):
            remark = comment["text"]
        elif line.strip():
            remark = ""
    if block:
        raise ValueError(f"{block.place}: the block has no end")
    return found


def prose(page: pathlib.Path) -> str:
    """The page with its blocks blanked out; lines keep their numbers."""
    lines = page.read_text(encoding="utf-8").splitlines()
    for block in blocks(page):
        for k in range(block.line - 1, block.line + block.text.count("\n") + 1):
            lines[k] = ""
    return "\n".join(lines)
