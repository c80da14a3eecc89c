"""Links from a page to a file of the repository, as [`Projector::compute`](../prowl/dynamics/projector.cpp): the site gets a
page with that file, and a link whose text is a name in it goes to the line where the name is defined."""

import pathlib
import re
import sys

from mkdocs.structure.files import File

sys.path.insert(0, str(pathlib.Path(__file__).parents[1]))
from code_names import CODE_LINK, defining_line, repository_file  # noqa: E402

LANGUAGES = {
    ".cpp": "cpp",
    ".hpp": "cpp",
    ".py": "python",
    ".toml": "toml",
    ".ts": "typescript",
    ".txt": "text",
    ".cmake": "cmake",
}
ROOT = pathlib.Path(__file__).parents[2]


def on_files(files, config):
    linked = set()
    for page in files.documentation_pages():
        text = pathlib.Path(page.abs_src_path).read_text(encoding="utf-8")
        linked |= {repository_file(ROOT, match["target"]) for match in CODE_LINK.finditer(text)}
    for path in sorted(linked):
        name = path.relative_to(ROOT)
        language = LANGUAGES.get(path.suffix, "text")
        source = path.read_text(encoding="utf-8").rstrip("\n")
        files.append(
            File.generated(
                config,
                f"source/{name}.md",
                inclusion=_not_in_nav(files),
                content=(
                    f"---\ntitle: {name}\nsearch:\n  exclude: true\nhide: [toc, navigation]\n---\n\n# {name}\n\n"
                    f'````` {{.{language} linenums="1"}}\n{source}\n`````\n'
                ),
            )
        )
    return files


def _not_in_nav(files):
    from mkdocs.structure.files import InclusionLevel

    return InclusionLevel.NOT_IN_NAV


def on_page_markdown(markdown, page, config, files):
    def replace(match):
        path = repository_file(ROOT, match["target"])
        line = defining_line(path, match["text"])
        anchor = f"#__codeline-0-{line}" if line else ""
        return f"[{match['text']}](source/{path.relative_to(ROOT)}.md{anchor})"

    return markdown if page.file.src_uri.startswith("source/") else CODE_LINK.sub(replace, markdown)
