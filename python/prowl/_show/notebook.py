"""How a notebook shows what Prowl's functions return."""

from html import escape

from . import _prowl


def _certificate_table(certificate: _prowl.Certificate) -> str:
    head = (
        "<tr><th style='text-align:left'>check</th><th>worst</th><th>limit</th><th>time</th>"
        "<th style='text-align:left'>where</th><th></th></tr>"
    )
    rows = []
    for check in certificate.checks:
        unit = "" if check.unit == "-" else f" {check.unit}"
        cells = (
            f"<td style='text-align:left'>{escape(check.name)}</td>"
            f"<td>{check.worst:.3g}{escape(unit)}</td><td>{check.limit:.3g}{escape(unit)}</td><td>{check.time:.3f} s</td>"
            f"<td style='text-align:left'>{escape(check.where)}</td>"
            f"<td><b>{'pass' if check.passed else 'FAIL'}</b></td>"
        )
        rows.append(f"<tr>{cells}</tr>")
    verdict = f"{'passed' if certificate.passed else 'FAILED'}, grade {escape(certificate.grade)}"
    return f"<p>certificate: <b>{verdict}</b></p><table>{head}{''.join(rows)}</table>"


def show_as_tables() -> None:
    _prowl.Certificate._repr_html_ = _certificate_table
