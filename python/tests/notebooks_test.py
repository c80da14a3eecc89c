"""The notebooks run as they are written; what they claim they assert."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

NOTEBOOKS = sorted((Path(__file__).parent.parent / "notebooks").glob("*.py"))


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_it_runs(notebook, tmp_path):
    environment = {**os.environ, "MPLBACKEND": "Agg", "BROWSER": "true"}
    result = subprocess.run([sys.executable, notebook], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert "# %%" in notebook.read_text(), "no cells: not a notebook for jupytext"


def test_there_are_four():
    assert [path.stem for path in NOTEBOOKS] == ["first_plan", "motion_library", "own_robot", "plan_to_controller"]
