"""HTML of Prowl's objects for notebooks."""

from __future__ import annotations

from html import escape

from .. import _prowl

LEFT = ' style="text-align:left"'
GOOD, BAD = "#1a7f37", "#cf222e"


def certificate_html(certificate: _prowl.Certificate) -> str:
    """Table of the checks, failed ones first."""
    checks = sorted(certificate.checks, key=lambda check: check.passed)
    rows = [
        [
            (check.name, LEFT),
            (_quantity(check.worst, check.unit), ""),
            (_quantity(check.limit, check.unit), ""),
            (f"{check.time:.2f} s", ""),
            (check.where, LEFT),
            _verdict(check.passed, "pass", "FAIL"),
        ]
        for check in checks
    ]
    verdict, style = _verdict(certificate.passed, "passed", "FAILED")
    head = f"<p>Certificate: <b{style}>{verdict}</b>, grade {escape(certificate.grade)}</p>"
    return head + _table(["check", "worst", "limit", "time", "where", ""], rows)


def plan_html(plan: _prowl.Plan) -> str:
    """Result, cost terms, and the folded certificate."""
    certificate = plan.certificate
    good, style = _verdict(plan.good, "good", "not good")
    failed = [check.name for check in certificate.checks if not check.passed]
    facts = [
        ("motion", f"{plan.duration:.3g} s, {len(plan)} nodes, {_counted(len(plan.task.phases), 'phase')}"),
        (
            "solver",
            f"{plan.solver}: {plan.status.replace('_', ' ')}, {plan.iterations} iterations, {plan.seconds:.2g} s",
        ),
        ("certificate", f"{certificate.grade}, {_counted(len(certificate.checks), 'check')}"),
        ("feedback gains", "none" if plan.tracker is None else f"{len(plan.tracker)} samples"),
    ]
    facts += [("failed", ", ".join(failed))] if failed else []
    facts += [("reason", text) for text in plan.reasons] + [("hint", text) for text in plan.hints]
    title = f"<p><b>{escape(plan.robot.name)}, {escape(plan.task.name)}</b>: <b{style}>{good}</b></p>"
    rows = [[(name, LEFT), (text, LEFT)] for name, text in facts]
    folded = f"<details{'' if certificate.passed else ' open'}><summary>Certificate</summary>{certificate_html(certificate)}</details>"
    return title + _table([], rows) + _cost_html(plan) + folded


def _cost_html(plan: _prowl.Plan) -> str:
    """Cost terms with bars, the largest first."""
    terms = sorted(plan.cost_terms.items(), key=lambda term: -term[1])
    largest = max((cost for _, cost in terms), default=0.0)
    total = sum(cost for _, cost in terms)
    rows = "".join(
        f"<tr><td{LEFT}>{escape(key)}</td><td>{cost:.4g}</td><td>{100 * cost / total if total > 0 else 0:.0f} %</td>"
        f'<td{LEFT}><div style="background:#0072B2;height:0.7em;width:'
        f'{120 * cost / largest if largest > 0 else 0:.0f}px"></div></td></tr>'
        for key, cost in terms
    )
    return f"<details open><summary>Cost {plan.cost:.5g}</summary><table>{rows}</table></details>"


def simulation_html(simulation: _prowl.Simulation) -> str:
    """Result and errors."""
    success, style = _verdict(simulation.success, "success", "no success")
    position, angle = simulation.base_position_error, simulation.base_angle_error
    facts = [
        ("end", f"{simulation.end}, {simulation.end_time:.3g} s"),
        ("base, position error", f"at most {100 * position.largest:.2g} cm, rms {100 * position.rms:.2g} cm"),
        ("base, angle error", f"at most {angle.largest:.2g} rad, rms {angle.rms:.2g} rad"),
        ("largest torque", f"{100 * simulation.largest_torque_share:.0f} % of the limit"),
        *(("failure", text) for text in simulation.failures),
    ]
    title = f"<p>Simulation of <b>{escape(simulation.plan.task.name)}</b>: <b{style}>{success}</b></p>"
    return title + _table([], [[(name, LEFT), (text, LEFT)] for name, text in facts])


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _quantity(value: float, unit: str) -> str:
    return f"{value:.3g}" if unit in ("-", "") else f"{value:.3g} {unit}"


def _verdict(passed: bool, yes: str, no: str) -> tuple[str, str]:
    """The word and its style."""
    return (yes if passed else no), f' style="color:{GOOD if passed else BAD}"'


def _table(head: list[str], rows: list[list[tuple[str, str]]]) -> str:
    """Cells with their styles; headings are aligned as the cells below."""
    styles = [style if style == LEFT else "" for _, style in rows[0]] if rows else [LEFT] * len(head)
    heading = "".join(f"<th{style}>{escape(name)}</th>" for name, style in zip(head, styles))
    body = "".join(
        "<tr>" + "".join(f"<td{style}>{escape(text)}</td>" for text, style in cells) + "</tr>" for cells in rows
    )
    return f"<table>{f'<tr>{heading}</tr>' if head else ''}{body}</table>"
