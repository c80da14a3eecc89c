"""What a person sees in a terminal: colours unless NO_COLOR, lines as wide as the terminal, a help that can be read.

Usage: terminal_test.py PROWL PACKAGE_DIR
"""

import fcntl
import os
import pathlib
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
import threading
import unittest

PROWL, PACKAGE_DIR = sys.argv[1:3]
ROOT = pathlib.Path(__file__).resolve().parents[2]
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")
GREEN, YELLOW, RED, END = "\x1b[32m", "\x1b[33m", "\x1b[31m", "\x1b[0m"


class Terminal:
    """Runs a command with stdout in a pseudo-terminal, as a shell in a window does; stderr goes nowhere."""

    def __init__(self, columns: int = 100, **environment: str) -> None:
        self.columns = columns
        self.environment = {key: value for key, value in os.environ.items() if key != "NO_COLOR"}
        self.environment |= {"TERM": "xterm-256color", **environment}

    def run(self, *arguments: str, errors: bool = False) -> tuple[int, str]:
        ours, theirs = pty.openpty()
        fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 40, self.columns, 0, 0))
        process = subprocess.Popen(
            [PROWL, *arguments],
            cwd=ROOT,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=theirs,
            stderr=theirs if errors else subprocess.DEVNULL,
        )
        # The last lines can be lost when all writers close: a mark after them says that all are read.
        end = threading.Thread(target=lambda: (process.wait(), os.write(theirs, b"\0")))
        end.start()
        text = b""
        while not text.endswith(b"\0"):
            text += os.read(ours, 65536)
        end.join()
        os.close(theirs)
        os.close(ours)
        return process.returncode, text[:-1].decode().replace("\r\n", "\n")


class TerminalTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.folder = tempfile.TemporaryDirectory()
        cls.out = str(pathlib.Path(cls.folder.name) / "out")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.folder.cleanup()

    def plan(self, terminal: Terminal, *options: str) -> str:
        arguments = ("plan", "tasks/hyq/crouch.toml", "--no-gains", "--out", self.out, "--package-dir", PACKAGE_DIR)
        return terminal.run(*arguments, *options)[1]

    def test_a_plan_has_colours(self) -> None:
        text = self.plan(Terminal())
        meaning = "(good for simulation; certified: error < 1e-6)"
        self.assertIn(f"certificate: {GREEN}passed{END}, grade: {YELLOW}draft{END} {meaning}\n", text)
        self.assertRegex(text, re.escape(f"  {GREEN}pass{END}") + "\n")
        self.assertRegex(text, r"HyQ crouches \d+ cm and stands up again in 2.00 s; planned in [0-9.]+ s.")
        self.assertRegex(ESCAPE.sub("", text), r"Largest torque: \d+ % of its limit at \w+_joint.")
        failed = self.plan(Terminal(), "--intervals", "10")
        self.assertRegex(failed, r"certificate: \x1b\[.*31mFAILED\x1b\[0m")
        self.assertRegex(failed, r"  \x1b\[[0-9;m\x1b]*31mFAIL\x1b\[0m\n")

    def test_none_with_no_color_in_a_dumb_terminal_or_a_pipe(self) -> None:
        self.assertNotIn("\x1b", self.plan(Terminal(NO_COLOR="1")))
        self.assertNotIn("\x1b", self.plan(Terminal(TERM="dumb")))
        self.assertIn("\x1b", self.plan(Terminal(NO_COLOR="")), "an empty NO_COLOR is none: https://no-color.org")
        piped = subprocess.run([PROWL, "check", self.out, "--package-dir", PACKAGE_DIR], capture_output=True, text=True)
        self.assertEqual(piped.returncode, 0, piped.stderr)
        self.assertNotIn("\x1b", piped.stdout + piped.stderr)

    def test_colours_change_no_text(self) -> None:
        coloured = Terminal().run("check", self.checked(), "--package-dir", PACKAGE_DIR)[1]
        plain = Terminal(NO_COLOR="1").run("check", self.checked(), "--package-dir", PACKAGE_DIR)[1]
        self.assertIn("\x1b", coloured)
        self.assertEqual(ESCAPE.sub("", coloured), plain)

    def checked(self) -> str:
        if not pathlib.Path(self.out).exists():
            self.plan(Terminal())
        return self.out

    def test_errors_and_notes_are_coloured(self) -> None:
        status, text = Terminal().run("plan", "nothing.toml", errors=True)
        self.assertEqual(status, 2)
        self.assertRegex(text, r"^\x1b\[[0-9;m\x1b]*31mprowl:\x1b\[0m nothing.toml: no such file")
        text = Terminal().run(
            "plan",
            "tasks/hyq/crouch.toml",
            "--threads",
            "250",
            "--out",
            self.out,
            "--package-dir",
            PACKAGE_DIR,
            errors=True,
        )[1]
        self.assertIn(f"{YELLOW}note:{END} --threads 250: this machine has {os.cpu_count()} core", text)

    def test_takes_the_width_of_the_terminal(self) -> None:
        longest = {}
        for columns in (60, 80, 140):
            text = self.plan(Terminal(columns, NO_COLOR="1"))
            lines = [line for line in text.splitlines() if " " in line.strip() and self.out not in line]
            longest[columns] = max(map(len, lines))
            self.assertLessEqual(longest[columns], columns, text)
            checked = Terminal(columns, NO_COLOR="1").run("check", self.out, "--package-dir", PACKAGE_DIR)[1]
            self.assertRegex(checked, r"\n  joint torque .* pass\n")
            self.assertLessEqual(
                max(len(line) for line in checked.splitlines() if self.out not in line), columns, checked
            )
        self.assertGreater(longest[140], 80)

    def test_names_are_cut_where_they_say_least(self) -> None:
        text = self.plan(Terminal(80, NO_COLOR="1"), "--intervals", "12")
        self.assertIn("local integration error", text)
        self.assertNotRegex(text, r"\.\.\w* of ")

    def test_help_is_for_the_screen(self) -> None:
        for columns in (60, 80, 120):
            text = Terminal(columns, NO_COLOR="1").run("plan", "--help")[1]
            listed = text.split("\nExamples:")[0]
            for line in listed.splitlines():
                if "{" not in line and not re.search(r" --\S+$", line):  # choices are one word; no line begins with --
                    self.assertLessEqual(len(line), max(columns, 62), line)
        for group in ("Options", "Mesh", "Solver", "Output"):
            self.assertIn(f"\n{group}:\n", text)
        self.assertLess(text.index("--intervals"), text.index("--solver"))
        self.assertLess(text.index("\nMesh:"), text.index("--intervals"))
        for noise in ("Excludes", "Needs", "NUMBER", "INT in"):
            self.assertNotIn(noise, text)
        self.assertIn("\x1b[1mMesh:\x1b[0m", Terminal().run("plan", "--help")[1])

    def test_help_of_every_verb_is_in_groups_and_without_noise(self) -> None:
        groups = {
            "plan": ["Options", "Mesh", "Solver", "Output"],
            "view": ["Options", "Mesh", "Solver", "Output"],
            "compare": ["Options", "Compared", "Solver", "Output"],
            "simulate": ["Options", "MuJoCo", "Rollout", "Output"],
            "sweep": ["Options", "Perturbations", "Output"],
            "mpc": ["Options", "World", "Pages", "Benchmark", "Output"],
            "completion": ["Options"],
        }
        terminal = Terminal(80, NO_COLOR="1")
        listed = terminal.run("--help")[1].partition("\nSubcommands:\n")[2].partition("\n\n")[0]
        verbs = re.findall(r"^  (\w+) ", listed, re.MULTILINE)
        self.assertGreater(len(verbs), 12)
        for verb in [[verb] for verb in verbs if verb != "new"] + [["new", "robot"], ["new", "task"]]:
            text = terminal.run(*verb, "--help")[1]
            with self.subTest(verb=verb):
                for noise in ("Excludes", "Needs", "NUMBER", " INT", "UINT", "FLOAT", "TEXT", "(existing)", " in ["):
                    self.assertNotIn(noise, text)
                headings = re.findall(r"^([A-Z]\w+):$", text, re.MULTILINE)
                self.assertEqual(
                    [name for name in headings if name not in ("Positionals", "Examples")],
                    groups.get(verb[0], ["Options", "Output"]),
                )
                examples = text.partition("\nExamples:\n")[2].partition("\n\n")[0]
                for line in text.replace(examples, "").splitlines():
                    if "{" not in line and not re.search(r" --\S+$", line):
                        self.assertLessEqual(len(line), 80, line)

    def test_alone_prints_the_help(self) -> None:
        status, text = Terminal(NO_COLOR="1").run()
        self.assertEqual(status, 2)
        self.assertEqual(text, Terminal(NO_COLOR="1").run("--help")[1])
        self.assertIn("\nSubcommands:\n", text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
