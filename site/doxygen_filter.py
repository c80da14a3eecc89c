"""Prepares one header for Doxygen: a page of docs/ named in a comment becomes a link to it on the site, which lies one folder
above the headers' pages; what looks like markup, as the elements of a URDF, is text.

    doxygen_filter.py HEADER
"""

import pathlib
import re
import sys

PAGE = re.compile(r"docs/([a-z-]+)\.md(#[\w-]+)?")


def link(match: re.Match) -> str:
    return f'<a href="../{match[1]}.html{match[2] or ""}">docs/{match[1]}</a>'


path = pathlib.Path(sys.argv[1])
for line in path.read_text(encoding="utf-8").splitlines():
    if path.suffix == ".md":
        print(line)
        continue
    code, mark, comment = line.partition("///")
    behind = "<" if comment.startswith("<") else ""  # ///< stands behind what it is about
    print(code + mark + behind + PAGE.sub(link, comment[len(behind) :].replace("<", r"\<")))
