import os
import subprocess
from collections.abc import Callable

import pytest

import prowl


@pytest.fixture(scope="session")
def crouch() -> prowl.Plan:
    """HyQ's crouch, solved once."""
    return prowl.solve(prowl.read_task("hyq/crouch"), progress=False)


@pytest.fixture(scope="session")
def hyq() -> prowl.Robot:
    return prowl.read_robot("hyq")


@pytest.fixture(scope="session")
def command() -> Callable[..., str]:
    """Runs the command of the same build; what it prints."""

    def run(*arguments: object) -> str:
        program = [os.environ["PROWL_COMMAND"], *map(str, arguments)]
        return subprocess.run(program, check=True, capture_output=True, text=True).stdout

    return run
