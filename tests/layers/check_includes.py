#!/usr/bin/env python3
"""Checks who includes whom under prowl/: the table of docs/architecture.md.

Usage: check_includes.py SOURCE_DIR [INTERNAL_HEADER...]. Prints one line for each include that is not allowed; exit
status 1 if there is one. Internal headers are those that show a library of the table below, by themselves or through
another header; they are not installed, and all of them must be named.
"""

import re
import sys
from pathlib import Path

# layer: the layers below it that it may include; itself and prowl/error.hpp it always may.
ALLOWED = {
    "model": set(),
    "dynamics": {"model"},
    "motion": {"model", "dynamics"},
    "nlp": set(),
    "solvers": {"nlp"},
    # Of dynamics neither: the certificate must not share the projection with the planner.
    "trajectory": {"model", "motion"},
    "transcription": {"model", "dynamics", "motion", "trajectory", "nlp"},
    "formulations": {"model", "dynamics", "motion", "trajectory", "nlp", "transcription"},
    "feasibility": {"model", "dynamics", "motion", "trajectory", "nlp"},
    "tracker": set(),  # nor prowl/error.hpp: it goes on the robot
    "tracking": {"model", "dynamics", "motion", "trajectory", "tracker"},
    "estimation": {"model", "dynamics"},
    # Of dynamics nothing: an independent judge.
    "simulation": {"model", "motion", "trajectory", "tracker", "estimation"},
    # After prowl/plan, which it solves with.
    "diagnosis": {".", "model", "dynamics", "motion", "trajectory", "nlp", "transcription", "feasibility"},
    "io": None,  # what it needs
    "starter": {"model", "dynamics", "motion", "io"},
    ".": None,  # prowl/plan
}

# Library, by a pattern of its headers: where it may be included.
LIBRARIES = {
    "Pinocchio": (r"pinocchio/", {"model", "dynamics", "trajectory"}),
    "Ipopt": (r"Ip[A-Z]\w*\.(hpp|h)|IpoptConfig\.h|coin-or/", {"solvers"}),
    "Fatrop": (r"fatrop/|blasfeo", {"solvers"}),
    "Uno": (r"uno/", {"solvers"}),
    "toml++": (r"toml\+\+/|toml\.hpp", {"io"}),
    "nlohmann": (r"nlohmann/", {"io"}),
    "tinyxml2": (r"tinyxml2\.h", {"model", "io"}),
    "MuJoCo": (r"mujoco/", {"simulation"}),
    "urdfdom": (r"urdf_parser/|urdf_model/|console_bridge/", {"model"}),
    "Assimp": (r"assimp/", {"io"}),
    "meshoptimizer": (r"meshoptimizer\.h", {"io"}),
    "CLI11": (r"CLI/", set()),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def layer_of(path):
    parts = Path(path).parts  # prowl, layer, file
    return parts[1] if len(parts) > 2 else "."


def violations(root, internal_headers=()):
    """One line for each include under root/prowl that the tables above do not allow."""
    files = {}
    for path in sorted((root / "prowl").rglob("*")):
        if path.suffix in (".hpp", ".cpp"):
            files[path.relative_to(root).as_posix()] = INCLUDE.findall(path.read_text(encoding="utf-8"))
    if not files:
        return [f"{root}/prowl: no source files, nothing was checked"]
    found = []
    for name, includes in files.items():
        if layer_of(name) not in ALLOWED:
            found.append(f"{name}: layer {layer_of(name)} is not in the table")
            continue
        for include in includes:
            if not is_allowed(layer_of(name), include):
                found.append(f"{name}: {include} is not for {layer_of(name)}")
    return found + headers_that_show_libraries(files, internal_headers) + solvers_in_two_files(files)


def is_allowed(layer, include):
    if include.startswith("prowl/"):
        allowed = ALLOWED[layer]
        if include == "prowl/error.hpp":
            return layer != "tracker"
        return allowed is None or layer_of(include) in allowed | {layer}
    library = library_of(include)
    return library is None or layer in LIBRARIES[library][1]


def library_of(include):
    return next((name for name, (pattern, _) in LIBRARIES.items() if re.match(pattern, include)), None)


def headers_that_show_libraries(files, internal_headers):
    def shown(name, seen):
        """The library that whoever includes this file needs, or None."""
        for include in files.get(name, []):
            if include in seen:
                continue
            seen.add(include)
            library = library_of(include) or shown(include, seen)
            if library:
                return library
        return None

    showing = {name: shown(name, set()) for name in files if name.endswith(".hpp")}
    found = [
        f"{name}: shows {library} and is not an internal header"
        for name, library in showing.items()
        if library and name not in internal_headers
    ]
    return found + [
        f"{name}: does not show a library, is no internal header" for name in internal_headers if not showing.get(name)
    ]


def solvers_in_two_files(files):
    found = []
    for solver in ("Ipopt", "Fatrop", "Uno"):
        users = [name for name, includes in files.items() if any(library_of(i) == solver for i in includes)]
        if len(users) > 1:
            found.append(f"{', '.join(users)}: {solver} is to be included in one file only")
    return found


if __name__ == "__main__":
    lines = violations(Path(sys.argv[1]), sys.argv[2:])
    print("\n".join(lines) or "every include is allowed")
    sys.exit(1 if lines else 0)
