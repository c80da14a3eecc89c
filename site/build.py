"""Builds the documentation site: pictures from plans, pages by MkDocs, C++ headers by Doxygen; any reference to something
that is not there ends it. Run by scripts/docs and by tests/docs.

    build.py --prowl PATH_OF_THE_COMMAND [--out build/site]
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys

SITE = pathlib.Path(__file__).parent
ROOT = SITE.parent
FROM_NPM = {
    "katex/dist/katex.min.css": "katex/katex.min.css",
    "katex/dist/fonts": "katex/fonts",
    "iframe-worker/shim/index.js": "iframe-worker.js",
}


def run(*command, **environment) -> None:
    result = subprocess.run([str(part) for part in command], cwd=ROOT, env={**os.environ, **environment})
    if result.returncode != 0:
        sys.exit(f"site: {pathlib.Path(command[0]).name} failed ({result.returncode})")


def copy_scripts(out: pathlib.Path) -> None:
    for source, target in FROM_NPM.items():
        path = SITE / "node_modules" / source
        if not path.exists():
            sys.exit("site: npm packages are missing; scripts/docs installs them")
        (out / "assets" / target).parent.mkdir(parents=True, exist_ok=True)
        (shutil.copytree if path.is_dir() else shutil.copy)(path, out / "assets" / target)


def document_headers(out: pathlib.Path, work: pathlib.Path) -> None:
    import doxygen_awesome_css

    style = pathlib.Path(doxygen_awesome_css.__file__).parent / "doxygen-awesome.css"
    doxygen = shutil.which("doxygen") or sys.exit("site: doxygen is missing; scripts/docs installs it")
    version = subprocess.run([doxygen, "--version"], capture_output=True, text=True, check=True).stdout.split()[0]
    light = (
        "HTML_COLORSTYLE = LIGHT\n" if tuple(map(int, version.split("."))) >= (1, 9, 5) else ""
    )  # the style sheet knows dark
    settings = work / "Doxyfile"
    settings.write_text(
        f'@INCLUDE = site/Doxyfile\nOUTPUT_DIRECTORY = "{out}"\n{light}'
        f'HTML_EXTRA_STYLESHEET = "{style}" site/theme/assets/headers.css\n'
    )
    run(doxygen, settings)


def main() -> None:
    parser = argparse.ArgumentParser(description="builds the documentation site")
    parser.add_argument("--prowl", type=pathlib.Path, required=True, help="the prowl command, for the pictures")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build" / "site")
    parser.add_argument("--package-dir", default=[], action="append", help="as of prowl")
    arguments = parser.parse_args()
    out = arguments.out.resolve()
    work = out.with_name(out.name + "-work")
    shutil.rmtree(work, ignore_errors=True)
    pictures = work / "pictures"
    pictures.mkdir(parents=True)

    packages = [part for folder in arguments.package_dir for part in ("--package-dir", folder)]
    run(sys.executable, SITE / "pictures" / "draw.py", arguments.prowl.resolve(), pictures, *packages)
    run(
        sys.executable,
        "-m",
        "mkdocs",
        "build",
        "--strict",
        "--quiet",
        "--config-file",
        SITE / "mkdocs.yml",
        "--site-dir",
        out,
        PROWL_SITE_PICTURES=str(pictures),
        NO_MKDOCS_2_WARNING="1",
    )
    (out / "404.html").unlink()  # its links are for a server
    copy_scripts(out)
    document_headers(out, work)
    print(f"site: {out / 'index.html'}")


if __name__ == "__main__":
    main()
