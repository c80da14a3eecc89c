"""Names of the code in the documentation: what a link to a file of the repository means, and where a name is defined.
Used by the site and by tests/docs."""

import pathlib
import re

# [text](../path/to/file), where text is often a name in backticks. Links into docs/ have no "../".
CODE_LINK = re.compile(r"\[(?P<text>[^\]\n]+)\]\((?P<target>\.\./[^)\s#]+)\)")
IDENTIFIER = re.compile(r"`([A-Za-z_][\w:~]*)(?:\(.*\))?`")


def repository_file(root: pathlib.Path, target: str) -> pathlib.Path:
    """The file that a link of a page directly under docs/ goes to. FileNotFoundError if there is none."""
    path = (root / "docs" / target).resolve()
    if not path.is_file() or root not in path.parents:
        raise FileNotFoundError(f"link to {target}: no such file in the repository")
    return path


def linked_name(text: str) -> str | None:
    """The name that the text of a link shows, `prowl::Projector::compute` as "Projector::compute"; None if it is a path or words."""
    match = IDENTIFIER.fullmatch(text.strip())
    return match[1].removeprefix("prowl::") if match else None


def defining_line(path: pathlib.Path, text: str) -> int | None:
    """Number of the line of `path` that defines the name in the text of a link; None if it shows none. KeyError if the
    name is not in the file."""
    name = linked_name(text)
    if name is None:
        return None
    lines = path.read_text(encoding="utf-8").splitlines()
    last = re.escape(name.split("::")[-1])
    patterns = [
        rf"\b{re.escape(name)}\s*\(.*[{{,(:]\s*$",
        rf"\b(class|struct|enum class|def)\s+{last}\b(?!;)",
        rf"\b{last}\s*[({{=]",
        rf"\b{last}\b",
    ]
    for pattern in patterns:
        for number, line in enumerate(lines, 1):
            if not line.lstrip().startswith(("//", "#include")) and re.search(pattern, line):
                return number
    raise KeyError(f"{name} is not in {path.name}")
