"""The names that others rely on, as sets of strings: options and choices of `--help`, keys of JSON, columns of CSV, members of
exports, keys of task and robot files."""

import csv
import json
import pathlib
import re
import zipfile
from xml.etree import ElementTree

OPTION = re.compile(r"^ +(?:-\w,)?(--[a-z][a-z-]*)\b(.*)$")  # the line of --help that defines one
POSITIONAL = re.compile(r"^  (\w[\w-]*) .*REQUIRED")
CHOICES = re.compile(r":\{([^}]*)\}")


def of_help(text: str) -> set[str]:
    """ "--solver", and "--solver riccati" for each choice; of a positional argument the choices only, "shell bash"."""
    names = set()
    for line in text.split("\nExamples:")[0].splitlines():
        option = OPTION.match(line)
        if not (found := option or POSITIONAL.match(line)):
            continue
        names |= {option[1]} if option else set()
        if choices := CHOICES.search(line):
            names |= {f"{found[1]} {choice}" for choice in choices[1].split(",")}
    return names


def verbs_of_help(text: str) -> list[str]:
    """The verbs under "Subcommands:", in the order of --help."""
    _, _, listed = text.partition("\nSubcommands:\n")
    return re.findall(r"^  (\w+) ", listed.split("\n\n")[0], re.MULTILINE)


def of_json(value, path: str = "") -> set[str]:
    """ "certificate.checks[].name", for example."""
    if isinstance(value, dict):
        inside = {f"{path}.{key}".lstrip("."): entry for key, entry in value.items()}
        return set(inside).union(*(of_json(entry, key) for key, entry in inside.items()))
    if isinstance(value, list):
        return set().union(*(of_json(entry, f"{path}[]") for entry in value))
    return set()


def of_csv(text: str) -> set[str]:
    return set(next(csv.reader(line for line in text.splitlines() if not line.startswith("#"))))


def of_xml(text: str) -> set[str]:
    return {
        f"{element.tag}.{name}" for element in ElementTree.fromstring(text).iter() for name in ("", *element.attrib)
    }


def of_mcap(path: pathlib.Path) -> set[str]:
    from mcap.reader import make_reader

    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    return {f"{channel.topic} {summary.schemas[channel.schema_id].name}" for channel in summary.channels.values()}


def of_yaml(text: str) -> set[str]:
    return set(re.findall(r"^[ -]*(\w+):", text, re.MULTILINE))


def of_file(path: pathlib.Path) -> set[str]:
    """Of a file that Prowl wrote, by its extension; none of one that is not for programs."""
    read = {".json": lambda text: of_json(json.loads(text)), ".csv": of_csv, ".xml": of_xml, ".yaml": of_yaml}
    if path.suffix in read:
        return read[path.suffix](path.read_text())
    if path.suffix == ".npz":
        return set(zipfile.ZipFile(path).namelist())
    return of_mcap(path) if path.suffix == ".mcap" else set()


def of_toml(table: dict, path: str = "") -> set[str]:
    """ "goal.base_rpy_rad": the keys of a task or robot file, of all entries of a list of tables together."""
    names = set()
    for key, value in table.items():
        name = f"{path}.{key}".lstrip(".")
        names.add(name)
        for entry in value if isinstance(value, list) else [value]:
            if isinstance(entry, dict):
                names |= of_toml(entry, name)
    return names


def of_key_table(page: str) -> set[str]:
    """ "goal.base_rpy_rad": the table "All keys" that docs/task-file.md or docs/robot-file.md had at that commit."""
    rows = re.findall(r"^\| (\(top\)|`[\w.]+`) \| `(\w+)` \|", page.partition("## All keys")[2], re.MULTILINE)
    return {key if table == "(top)" else f"{table.strip('`')}.{key}" for table, key in rows}
