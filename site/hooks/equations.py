"""Equations are set while the site is built, by KaTeX (site/set_equations.mjs): pages need no script for them, and one that
does not parse ends the build."""

import html
import json
import pathlib
import re
import subprocess

SITE = pathlib.Path(__file__).parents[1]
NODE = SITE.parent / ".venv" / "bin" / "node"
EQUATION = re.compile(r'<(div|span) class="arithmatex">\\(\[|\()(.*?)\\(?:\]|\))</\1>', re.DOTALL)


def on_page_content(content, page, config, files):
    equations = [
        {"tex": html.unescape(match[3]).strip(), "display": match[2] == "["} for match in EQUATION.finditer(content)
    ]
    if not equations:
        return content
    run = subprocess.run(
        [NODE, SITE / "set_equations.mjs"], input=json.dumps(equations), capture_output=True, text=True
    )
    if run.returncode != 0:
        raise SystemExit(f"{page.file.src_uri}: {run.stderr.strip()}")
    done = iter(json.loads(run.stdout))

    def replace(match):
        tag = match[1]
        return f'<{tag} class="equation-{"block" if tag == "div" else "inline"}">{next(done)}</{tag}>'

    return EQUATION.sub(replace, content)
