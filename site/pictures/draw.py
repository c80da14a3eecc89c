"""Draws the pictures of the documentation from plans that it makes.

draw.py PROWL FOLDER [--package-dir DIR ...]
"""

import argparse
import pathlib
import tempfile

import style

style.use()
import concepts  # noqa: E402  after the choice of a backend
import formulations  # noqa: E402
import how_to  # noqa: E402
from plans import Planner  # noqa: E402

PICTURES = {
    "projection": concepts.projection,
    "phases": concepts.phases,
    "mesh": concepts.mesh,
    "margins": concepts.margins,
    "gains": how_to.gains,
    "orders": formulations.orders,
}


def main() -> None:
    parser = argparse.ArgumentParser(description="draws the pictures of the documentation")
    parser.add_argument("prowl", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--package-dir", action="append", default=[])
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as work:
        planner = Planner(arguments.prowl, pathlib.Path(work), arguments.package_dir)
        for name, picture in PICTURES.items():
            style.write(picture(planner), arguments.folder / f"{name}.svg")


if __name__ == "__main__":
    main()
