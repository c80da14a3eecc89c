import pytest

import prowl


@pytest.fixture(scope="session")
def crouch() -> prowl.Plan:
    """HyQ's crouch, solved once."""
    return prowl.solve(prowl.read_task("hyq/crouch"), progress=False)


@pytest.fixture(scope="session")
def hyq() -> prowl.Robot:
    return prowl.read_robot("hyq")
