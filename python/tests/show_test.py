"""What a plan shows: the page, the plot, and what a notebook makes of it."""

import html
import json
import re
import sys
import types
import webbrowser
from pathlib import Path

import matplotlib
import numpy as np
import pytest

import prowl

matplotlib.use("Agg")

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def simulation(crouch) -> prowl.Simulation:
    return prowl.simulate(crouch)


def data_of(page: str) -> dict:
    """The JSON that the page replays."""
    text = re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert text, "no data in the page"
    return json.loads(text[1])


def test_report_of_a_folder_is_that_of_the_command(crouch, simulation, tmp_path, command):
    crouch.write(tmp_path / "plan")
    simulation.write(tmp_path / "plan")
    command("report", tmp_path / "plan", "--out", tmp_path / "command.html")
    done = prowl.report(tmp_path / "plan")
    assert done.file == str(tmp_path / "plan/report.html") and done.has_simulation and done.warnings == []
    page = Path(done.file).read_bytes()
    assert len(page) == done.size > 100_000
    assert page == (tmp_path / "command.html").read_bytes()


def test_report_of_a_plan_in_memory(crouch, simulation, tmp_path):
    alone = prowl.report(crouch, tmp_path / "new/alone.html")
    assert not alone.has_simulation
    data = data_of(Path(alone.file).read_text())
    assert data["robot"] == "HyQ" and data["simulation"] is None and data["gains"] is not None
    both = prowl.report(crouch, tmp_path / "both.html", simulation=simulation)
    shown = data_of(Path(both.file).read_text())
    assert both.has_simulation and shown["simulation"] is not None and shown["simulation_json"]["success"]
    with pytest.raises(prowl.InputError, match="^out: need a file"):
        prowl.report(crouch)


def test_show_opens_the_page_in_a_browser(crouch, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda address: opened.append(address) or True)
    crouch.show()
    (address,) = opened
    file = Path(address.removeprefix("file://"))
    assert data_of(file.read_text())["robot"] == "HyQ"
    file.unlink()


def test_show_says_where_the_page_is_without_a_browser(crouch, monkeypatch):
    monkeypatch.setattr(webbrowser, "open", lambda address: False)
    with pytest.warns(UserWarning, match="^no browser here; open .* in one") as told:
        crouch.show()
    file = Path(str(told[0].message).split()[4])
    assert file.is_file()
    file.unlink()


def test_show_puts_the_page_below_the_cell_of_a_notebook(crouch, simulation, monkeypatch):
    shown = []
    display = types.ModuleType("IPython.display")
    display.display = shown.append
    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    assert crouch.show(simulation, height=500) is None
    (frame,) = shown
    text = frame._repr_html_()
    assert text.startswith("<iframe srcdoc=") and text.endswith("</iframe>") and "height:500px" in text
    assert text.count("<") == 2, "the page is in one attribute"
    assert data_of(html.unescape(re.search('srcdoc="([^"]*)"', text)[1]))["simulation"] is not None
    with pytest.raises(prowl.InputError, match="^height: 5 is not allowed"):
        crouch.show(height=5)


def test_plot_draws_the_arrays(crouch, simulation):
    figure = crouch.plot()
    base, forces, torques, shares = figure.axes
    np.testing.assert_array_equal(base.lines[2].get_ydata(), crouch.q[:, 2])
    assert [line.get_label() for line in forces.lines] == crouch.robot.contact_names
    np.testing.assert_array_equal(forces.lines[1].get_ydata(), crouch.f[:, 1, 2])
    drawn = {line.get_label() for line in torques.lines}
    assert len(drawn) == 4 and all(name.endswith("kfe_joint") for name in drawn), "HyQ's knees work hardest"
    (check,) = [check for check in crouch.certificate.checks if check.name == "joint torque"]
    assert shares.lines[0].get_ydata().max() == pytest.approx(100 * check.worst, rel=0.02)
    assert matplotlib.rcParams["axes.grid"] is False, "settings of the caller stay"
    with_simulation = crouch.plot(simulation)
    assert len(with_simulation.axes[2].lines) == 8
    assert with_simulation.axes[0].get_xlim()[1] >= simulation.t[-1]


def test_plot_of_a_robot_without_limits_and_of_many_phases():
    figure = prowl.solve("hyq/step", gains=False).plot()
    assert figure.axes[0].patches, "phases are shaded"


def test_a_notebook_shows_result_cost_and_certificate_of_a_plan(crouch):
    text = crouch._repr_html_()
    assert text.count("<table") == text.count("</table>") == 3
    for word in ("HyQ, crouch", "good", "contact drift", "joint_acceleration", f"{crouch.cost:.5g}"):
        assert word in text, word
    assert "not good" not in text


def test_a_notebook_shows_what_fails():
    failed = prowl.solve(prowl.read_task("hyq/step", intervals=250, max_iterations=2), coarse_first=False)
    text = failed._repr_html_()
    assert "not good" in text and "iteration limit" in text and "<details open><summary>Certificate" in text
    rows = re.findall(r"<tr>(.*?)</tr>", failed.certificate._repr_html_())
    left, right = re.findall("<th style=[^>]*left[^>]*>([a-z]+)<", rows[0]), re.findall("<th>([a-z]+)<", rows[0])
    assert left == ["check", "where"] and right == ["worst", "limit", "time"], "headings are above their values"
    verdicts = ["FAIL" in row for row in rows[1:]]
    assert any(verdicts) and verdicts == sorted(verdicts, reverse=True), "failed checks come first"


def test_a_notebook_shows_a_simulation(crouch, simulation):
    assert "success" in simulation._repr_html_() and "no success" not in simulation._repr_html_()
    fallen = prowl.simulate(crouch, open_loop=True)
    text = fallen._repr_html_()
    assert "no success" in text and html.escape(fallen.failures[0]) in text


def test_names_from_files_become_no_markup(crouch):
    document = crouch.task.text.replace('name = "crouch"', 'name = "<b>&crouch"')
    assert "<b>&" in document
    task = prowl.parse_task(document, folder=crouch.task.path.parent, intervals=4)
    text = prowl.solve(task, gains=False)._repr_html_()
    assert "&lt;b&gt;&amp;crouch" in text and "<b>&crouch" not in text


def test_figures_and_exports_of_a_plan_in_memory(crouch, simulation, tmp_path):
    drawn = prowl.figures(crouch, simulation=simulation, out=tmp_path / "figures")
    assert "base_error" in drawn.names and drawn.plan is crouch
    assert sorted(path.name for path in (tmp_path / "figures").iterdir()) == drawn.files
    done = prowl.export(crouch, ["csv", "json"], out=tmp_path / "exports")
    assert done.plan is crouch and (tmp_path / "exports/motion.csv").read_text() == crouch.to_csv()
    run = prowl.export(crouch, "json", simulation=simulation, out=tmp_path / "exports")
    assert run.motion == "simulation" and run.samples == len(simulation)
    for function in (prowl.figures, lambda plan: prowl.export(plan, "csv")):
        with pytest.raises(prowl.InputError, match="^out: need a folder"):
            function(crouch)


def test_figures_of_a_plan_without_simulation_name_the_remedy(crouch, tmp_path):
    with pytest.warns(
        UserWarning, match=r"^no simulation: planned motion only(.|\n)*simulation=prowl.simulate\(plan\)"
    ):
        prowl.figures(crouch, out=tmp_path / "figures")


def test_a_simulation_beside_a_plan_that_was_read(crouch, simulation, tmp_path):
    crouch.write(tmp_path / "plan")
    plan = prowl.read_plan(tmp_path / "plan")
    assert plan.path == tmp_path / "plan" and crouch.path is None
    done = prowl.export(plan, "json", simulation=prowl.simulate(plan))
    assert done.folder == str(tmp_path / "plan/exports") and done.samples == len(simulation)
    assert not (tmp_path / "plan/simulate.csv").exists(), "the folder of the plan stays as it is"
