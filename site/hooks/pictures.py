"""Pictures made from plans (site/pictures) become part of the page, so that their text takes the page's colour, light or dark.
They are in the folder that PROWL_SITE_PICTURES names."""

import html
import os
import pathlib
import re

from mkdocs.structure.files import File

IMAGE = re.compile(r'<img alt="(?P<alt>[^"]*)" src="(?:\.\./)*pictures/(?P<name>[\w-]+)\.svg"\s*/?>')


def on_files(files, config):
    for path in sorted(_folder().glob("*.svg")):
        files.append(File.generated(config, f"pictures/{path.name}", abs_src_path=str(path)))
    return files


def on_page_content(content, page, config, files):
    def replace(match):
        svg = (_folder() / f"{match['name']}.svg").read_text(encoding="utf-8")
        svg = svg[svg.index("<svg") :]
        return svg.replace(
            "<svg", f'<svg role="img" aria-label="{html.escape(html.unescape(match["alt"]))}" class="picture"', 1
        )

    return IMAGE.sub(replace, content)


def _folder() -> pathlib.Path:
    return pathlib.Path(os.environ["PROWL_SITE_PICTURES"])
