"""Every Python example of README and docs/ runs as it is written, each page from top to bottom in a folder of its own."""

import importlib.util
import webbrowser

import matplotlib
import pytest

import prowl
from documentation import GIVEN, ROOT, examples

matplotlib.use("Agg")

PAGES = examples()
#: Modules that Prowl does without, and that examples use.
OPTIONAL = {"prowl.snopt.solve": "pydrake", "import mujoco": "mujoco"}


def is_installed(module: str) -> bool:
    """As a package with code: mujoco-core leaves a folder of that name without any."""
    spec = importlib.util.find_spec(module)
    return spec is not None and spec.origin is not None


def is_left_out(block) -> bool:
    """Whether the page says that it is not run, or this machine lacks what it is about."""
    reason = block.remarked("not run")
    assert reason != "", f"{block.place}: not run, but no reason is given"
    missing = [name for use, name in OPTIONAL.items() if use in block.text and not is_installed(name)]
    if reason or missing:
        print(f"{block.place}: not run: {reason or 'without ' + ', '.join(missing)}")
    return bool(reason or missing)


@pytest.mark.filterwarnings("ignore:no simulation")
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_examples_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for folder in ("robots", "tasks"):
        (tmp_path / folder).symlink_to(ROOT / folder)
    monkeypatch.setattr(webbrowser, "open", lambda address: True)
    names: dict = {}
    exec(compile(GIVEN, "given", "exec"), names)
    names["plan"].write("out/hyq_crouch")  # what the commands of the page have made
    names["simulation"].write("out/hyq_crouch")
    prowl.export("out/hyq_crouch", "mujoco")
    for block in PAGES[page]:
        if not is_left_out(block):
            lines = "\n" * block.line + block.text  # so that errors name the line of the page
            exec(compile(lines, str(page), "exec"), names)


def test_the_first_pages_have_examples():
    assert {"README.md", "docs/python.md"} <= {str(page.relative_to(ROOT)) for page in PAGES}
    assert "solve" in prowl.__all__
