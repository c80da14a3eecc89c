"""Writes docs/reference.md: the keys of task, robot, job and script files, and the options of every verb.

    write.py PROWL FILE_KEYS [--out docs/reference.md]

PROWL is the command, whose --help is read. FILE_KEYS is the program of file_keys.cpp. scripts/reference builds both.
"""

import argparse
import json
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).parents[2]
COLUMN = 30  # where descriptions begin in --help
HEAD = """# Reference

<!-- Written by scripts/reference: do not edit. -->

All keys of task, robot, job and script files, and all options of the command. What a table cannot explain is on the pages
[task file](task-file.md), [robot file](robot-file.md), [libraries](batch.md), [online control](mpc.md) and [command line](command-line.md).

Any other key is an error, and the message names the nearest key. Numbers are finite and at most 1e9 in size; angles are in
radians. Names have at most 200 printable ASCII characters without `,` `"` `'` and `\\`, and no space at either end.
"""


def cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;")


def table(columns: list[str], rows: list[list[str]]) -> str:
    lines = [columns, ["---"] * len(columns), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


def key_tables(keys: list[dict]) -> str:
    text = ""
    for name in dict.fromkeys(key["table"] for key in keys):
        of_table = [key for key in keys if key["table"] == name]
        columns = ["type", "unit", "default", "meaning"] + ["formula"] * any(key["formula"] for key in of_table)
        rows = [[f"`{key['name']}`", *(cell(key[column]) for column in columns)] for key in of_table]
        heading = f"`{name}`" if name else "Top level"
        text += f"\n### {heading}\n\n" + table(["key", "type and range", *columns[1:]], rows)
    return text


def help_of(prowl: str, *verb: str) -> str:
    return subprocess.run([prowl, *verb, "--help"], capture_output=True, text=True, check=True).stdout


def entries(text: str) -> list[tuple[str, str, str]]:
    """(heading, signature, description) of each line of the lists in --help: a description may begin on the line below, and go
    on over several."""
    found, heading = [], ""
    for line in text.split("\nExamples:")[0].splitlines():
        if re.fullmatch(r"[A-Z][\w ]*:", line):
            heading = line.rstrip(":")
        elif line.startswith(" " * COLUMN) and found:
            found[-1][2].append(line.strip())
        elif heading and line.startswith("  "):
            beside = line[COLUMN - 2 : COLUMN] == "  " and line[COLUMN : COLUMN + 1].strip()
            signature = line[:COLUMN] if beside else line
            found.append((heading, signature.strip(), [line[COLUMN:].strip()] if beside else []))
    return [(heading, signature, " ".join(lines)) for heading, signature, lines in found]


def described(signature: str, description: str) -> list[str]:
    """The cells of an option: its choices in the description; not what it excludes, nor what its check says of a range."""
    signature = re.sub(r" (Excludes|Needs):.*| REQUIRED| x \d+$", "", signature)
    name, _, check = signature.partition(":")
    if choices := re.match(r"\{([^}]*)\}(.*)", check):
        name += re.sub(r" x \d+$", "", choices[2])
        names = choices[1].split(",")
        if not all(re.search(rf"\b{choice}\b", description) for choice in names):
            description += "; choices: " + ", ".join(names)
    description = re.sub(r"default:? /\S+", "default: that of the installation", description)  # a path of this machine
    description = re.sub(r"\bdocs/([\w-]+\.md)(#[\w-]+)?", r"[\1](\1\2)", cell(description))
    return [f"`{name.strip().replace('|', ' or ')}`", description]


def verb_section(prowl: str, verb: tuple[str, ...]) -> str:
    text = help_of(prowl, *verb)
    listed = entries(text)
    verbs = [signature for heading, signature, _ in listed if heading == "Subcommands"]
    if verbs:
        return "".join(verb_section(prowl, (*verb, below)) for below in verbs)
    lines = text.splitlines()
    purpose = " ".join(lines[: next(k for k, line in enumerate(lines) if line.startswith("Usage:"))]).strip()
    rows, last = [], ""
    for heading, signature, description in listed:
        if signature.startswith("-h,--help"):
            continue
        if heading not in ("Options", "Positionals", last):
            rows.append([f"**{heading}**", ""])
        last = heading
        rows.append(described(signature, description))
    exit_status = text.partition("Exit status: ")[2].partition("\n\n")[0]
    return (
        f"\n### `prowl {' '.join(verb)}`\n\n{purpose}.\n\n{table(['argument or option', 'meaning'], rows)}"
        f"\nExit status: {' '.join(exit_status.split())}\n"
    )


def page(prowl: str, file_keys: str) -> str:
    keys = json.loads(subprocess.run([file_keys], capture_output=True, text=True, check=True).stdout)
    text = HEAD
    for kind in ("task", "robot", "job", "script"):
        text += f"\n## {kind.capitalize()} file\n" + key_tables(keys[kind])
    text += "\n## Command line\n\n`prowl VERB --help` shows the same with examples.\n"
    for heading, verb, _ in entries(help_of(prowl)):
        if heading == "Subcommands":
            text += verb_section(prowl, (verb,))
    return text


def main() -> None:
    parser = argparse.ArgumentParser(description="writes docs/reference.md")
    parser.add_argument("prowl", help="the prowl command")
    parser.add_argument("file_keys", help="the program of file_keys.cpp")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "reference.md")
    arguments = parser.parse_args()
    arguments.out.write_text(page(arguments.prowl, arguments.file_keys), encoding="utf-8")


if __name__ == "__main__":
    main()
