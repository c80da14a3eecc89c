#!/usr/bin/env python3
"""Checks who includes whom: the table of docs/architecture.md.

Usage: check_includes.py SOURCE_DIR [INTERNAL_HEADER...]. Prints one line for each include that is not allowed and for
each allowance that no include uses; exit status 1 if there is one. Internal headers are those that show a library of
the table below, other than Eigen, by themselves or through another header; they are not installed, and all of them
must be named.
"""

import re
import sys
from pathlib import Path

# Folder: the folders that it may include, besides itself. A folder in one of these is part of it.
# prowl/error.hpp is for all but the tracker.
ALLOWED = {
    # The planner, in the order in which a plan goes through it. Each line may include lines above it only.
    "prowl/text": [],
    "prowl/files": ["prowl/text"],
    "prowl/kernels": [],
    "prowl/linear_algebra": ["prowl/kernels"],
    "prowl/model": ["prowl/text", "prowl/linear_algebra"],
    "prowl/dynamics": ["prowl/linear_algebra", "prowl/model"],
    "prowl/terms": ["prowl/model"],
    "prowl/motion": ["prowl/model", "prowl/dynamics", "prowl/terms"],
    "prowl/trajectory": ["prowl/model"],
    "prowl/nlp": [],  # knows no robots
    "prowl/mesh": ["prowl/motion", "prowl/trajectory", "prowl/nlp"],
    "prowl/guess": ["prowl/model", "prowl/dynamics", "prowl/trajectory", "prowl/mesh"],
    "prowl/transcription": [
        "prowl/linear_algebra",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
    ],
    "prowl/solvers": ["prowl/files", "prowl/linear_algebra", "prowl/nlp"],
    "prowl/feasibility": [
        "prowl/linear_algebra",
        "prowl/model",
        "prowl/dynamics",
        "prowl/terms",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
    ],
    "prowl/elastic": [
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
        "prowl/guess",
        "prowl/transcription",
    ],
    # Of dynamics and transcription nothing: the certificate reaches its verdict by another path.
    "prowl/certificate": ["prowl/model", "prowl/motion", "prowl/trajectory", "prowl/mesh"],
    # plan.cpp, refine.cpp: the flow.
    "prowl": [
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
        "prowl/guess",
        "prowl/transcription",
        "prowl/feasibility",
        "prowl/elastic",
        "prowl/certificate",
    ],
    "prowl/tracker": [],  # nor prowl/error.hpp: it goes on the robot
    "prowl/tracking": [
        "prowl/linear_algebra",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/tracker",
    ],
    "prowl/robust": [
        "prowl",
        "prowl/linear_algebra",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/tracking",
    ],
    "prowl/estimation": ["prowl/linear_algebra", "prowl/model", "prowl/dynamics"],
    # Of dynamics nothing: an independent judge. What runs on board the robot, the estimator, may use them.
    "prowl/mjcf": [],
    "prowl/simulation": [
        "prowl/text",
        "prowl/files",
        "prowl/mjcf",
        "prowl/model",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/tracker",
        "prowl/estimation",
    ],
    "prowl/diagnosis": [
        "prowl",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
        "prowl/guess",
        "prowl/transcription",
        "prowl/elastic",
        "prowl/feasibility",
        "prowl/certificate",
    ],
    # Online: a controller, and its robot in MuJoCo.
    "prowl/mpc": [
        "prowl/text",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/nlp",
        "prowl/transcription",
        "prowl/solvers",
    ],
    "prowl/online": [
        "prowl/text",
        "prowl/files",
        "prowl/model",
        "prowl/certificate",
        "prowl/simulation",
        "prowl/mpc",
        "prowl/task_file",
    ],
    # Files in, plans out.
    "prowl/task_file": [
        "prowl/text",
        "prowl/files",
        "prowl/model",
        "prowl/dynamics",
        "prowl/terms",
        "prowl/motion",
        "prowl/mesh",
        "prowl/nlp",
        "prowl/tracking",
        "prowl/simulation",
    ],
    "prowl/session": [
        "prowl/kernels",
        "prowl",
        "prowl/diagnosis",
        "prowl/model",
        "prowl/mesh",
        "prowl/solvers",
        "prowl/tracking",
        "prowl/robust",
        "prowl/simulation",
        "prowl/task_file",
    ],
    "prowl/plan_folder": [
        "prowl",
        "prowl/text",
        "prowl/files",
        "prowl/model",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
        "prowl/tracker",
        "prowl/tracking",
        "prowl/simulation",
        "prowl/task_file",
        "prowl/session",
    ],
    "prowl/report_page": [
        "prowl/files",
        "prowl/model",
        "prowl/mpc",
        "prowl/online",
        "prowl/trajectory",
        "prowl/solvers",
        "prowl/tracker",
        "prowl/robust",
        "prowl/plan_folder",
    ],
    "prowl/batch": ["prowl/files", "prowl/certificate", "prowl/task_file"],
    "prowl/starter": [
        "prowl/linear_algebra",
        "prowl/text",
        "prowl/files",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/task_file",
    ],
    # Beside the planner.
    "alternatives": [
        "prowl/files",
        "prowl/model",
        "prowl/dynamics",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mesh",
        "prowl/guess",
        "prowl/transcription",
        "prowl/certificate",
    ],
    "screen": [
        "prowl/simulation",
        "prowl/online",
        "prowl/files",
        "prowl/model",
        "prowl/motion",
        "prowl/trajectory",
        "prowl/mesh",
        "prowl/certificate",
        "prowl/elastic",
        "prowl/diagnosis",
        "prowl/task_file",
        "prowl/plan_folder",
    ],
    # The front ends.
    "cli/process": ["prowl", "prowl/session", "prowl/text"],
    "cli/screen": ["cli/process", "prowl/text", "prowl/files", "prowl/nlp", "prowl/session"],
    "cli/options": [
        "prowl/text",
        "cli/process",
        "cli/screen",
        "prowl",
        "prowl/files",
        "prowl/mesh",
        "prowl/transcription",
        "prowl/simulation",
        "prowl/task_file",
        "prowl/session",
        "prowl/plan_folder",
    ],
    "cli/verbs": [
        "cli/process",
        "cli/screen",
        "cli/options",
        "prowl",
        "prowl/files",
        "prowl/model",
        "prowl/motion",
        "prowl/guess",
        "prowl/solvers",
        "prowl/feasibility",
        "prowl/tracker",
        "prowl/tracking",
        "prowl/mjcf",
        "prowl/mpc",
        "prowl/online",
        "prowl/simulation",
        "prowl/task_file",
        "prowl/session",
        "prowl/plan_folder",
        "prowl/report_page",
        "prowl/starter",
        "alternatives",
        "screen",
    ],
    "cli": ["cli/process", "cli/screen", "cli/verbs", "prowl", "prowl/text", "prowl/session"],
    "python/src": [
        "prowl",
        "prowl/text",
        "prowl/files",
        "prowl/model",
        "prowl/dynamics",
        "prowl/trajectory",
        "prowl/nlp",
        "prowl/mpc",
        "prowl/online",
        "prowl/transcription",
        "prowl/solvers",
        "prowl/certificate",
        "prowl/tracker",
        "prowl/tracking",
        "prowl/robust",
        "prowl/simulation",
        "prowl/task_file",
        "prowl/session",
        "prowl/plan_folder",
        "prowl/batch",
        "prowl/report_page",
        "alternatives",
        "screen",
    ],
}
# Of these the files alone: each of their folders has a line of its own.
WITHOUT_FOLDERS = ["prowl", "cli"]
ROOTS = ["prowl", "alternatives", "screen", "cli", "python/src"]

# Library, by a pattern of its headers: the folders, or files, that may include it. The tracker has Eigen alone.
LIBRARIES = {
    "Eigen": (r"(unsupported/)?Eigen/", ["prowl", "alternatives", "python/src"]),
    "fmt": (r"fmt/", ["prowl", "alternatives", "screen", "cli", "python/src"]),
    "Boost": (
        r"boost/",
        [
            "prowl/files/base64.cpp",
            "prowl/nlp/thread_team.cpp",
            "prowl/certificate",
            "prowl/tracking",
            "prowl/simulation",
            "prowl/batch/job.cpp",
            "prowl/starter/sole.cpp",
            "cli/screen/progress_bar.hpp",
            "cli/verbs/view_server.cpp",
        ],
    ),
    "glibc": (r"sys/platform/", ["prowl/kernels/dense_kernels.cpp"]),
    "POSIX": (r"sys/", ["prowl/files", "cli"]),
    "Pinocchio": (r"pinocchio/", ["prowl/model", "prowl/dynamics", "prowl/certificate"]),
    "Ipopt": (r"Ip[A-Z]\w*\.(hpp|h)|IpoptConfig\.h|coin-or/", ["prowl/solvers/foreign/ipopt_solver.cpp"]),
    "Fatrop": (r"fatrop/|blasfeo", ["prowl/solvers/foreign/fatrop_solver.cpp"]),
    "Uno": (r"uno/", ["prowl/solvers/foreign/uno_solver.cpp"]),
    "MuJoCo": (r"mujoco/", ["prowl/mjcf", "prowl/simulation/mujoco_model.hpp"]),
    "toml++": (r"toml\+\+/|toml\.hpp", ["prowl/task_file", "prowl/batch"]),
    "nlohmann": (
        r"nlohmann/",
        ["prowl/files", "prowl/plan_folder", "prowl/report_page", "cli"],
    ),
    "tinyxml2": (r"tinyxml2\.h", ["prowl/model/urdf", "prowl/mjcf", "prowl/plan_folder"]),
    "urdfdom": (r"urdf_parser/|urdf_model/|console_bridge/", ["prowl/model/urdf"]),
    "Assimp": (r"assimp/", ["prowl/files/visual_mesh.cpp"]),
    "meshoptimizer": (r"meshoptimizer\.h", ["prowl/files/visual_mesh.cpp"]),
    "CLI11": (r"CLI/", ["cli"]),
    "nanobind": (r"nanobind/", ["python/src"]),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def folder_of(path):
    """The folder of the table that a file belongs to: the nearest one above it. None if there is none."""
    own = Path(path).parent.as_posix()
    for folder in Path(path).parents:
        name = folder.as_posix()
        if name in ALLOWED:
            return name if name == own or name not in WITHOUT_FOLDERS else None
    return None


def is_in(path, places):
    """Whether the file is one of these, or in one of these folders."""
    return any(path == place or path.startswith(place + "/") for place in places)


def includes_of_files(root):
    """Name of a file under the roots: what it includes."""
    files = {}
    for top in ROOTS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix in (".hpp", ".cpp"):
                files[path.relative_to(root).as_posix()] = INCLUDE.findall(path.read_text(encoding="utf-8"))
    return files


def violations(root, internal_headers=()):
    """One line for each include under the roots that the tables above do not allow."""
    files = includes_of_files(root)
    if not files:
        return [f"{root}: no source files, nothing was checked"]
    found = circles()
    for name, includes in files.items():
        folder = folder_of(name)
        if folder is None:
            found.append(f"{name}: its folder is not in the table")
            continue
        found += [f"{name}: {include} is not for {folder}" for include in includes if not is_allowed(name, include)]
    return found + headers_that_show_libraries(files, internal_headers)


def unused_allowances(root):
    """One line for each folder and library that the tables above allow and nothing includes."""
    files = includes_of_files(root).items()
    folders = {(folder_of(name), folder_of(include)) for name, includes in files for include in includes}
    libraries = [(library_of(include), name) for name, includes in files for include in includes]
    return [
        f"{folder}: the table allows {other}, which no file includes"
        for folder, others in ALLOWED.items()
        for other in others
        if (folder, other) not in folders
    ] + [
        f"{place}: the table allows {library}, which no file includes"
        for library, (_, places) in LIBRARIES.items()
        for place in places
        if not any(used == library and is_in(name, [place]) for used, name in libraries)
    ]


def circles():
    """Folders that the table lets include each other, directly or through others."""
    below = {folder: set(others) for folder, others in ALLOWED.items()}
    for _ in ALLOWED:
        for others in below.values():
            others.update(*(below[other] for other in list(others)))
    return [f"{folder}: the table lets it include itself through others" for folder in below if folder in below[folder]]


def is_allowed(name, include):
    folder, library = folder_of(name), library_of(include)
    if ".." in include.split("/"):
        return False  # the table goes by the folder that is written
    if folder == "prowl/tracker" and (include == "prowl/error.hpp" or library not in (None, "Eigen")):
        return False
    if library:
        return is_in(name, LIBRARIES[library][1])
    if "/" not in include:
        return True  # the standard library, the system, a file beside it
    return include == "prowl/error.hpp" or (is_in(include, ROOTS) and folder_of(include) in [folder, *ALLOWED[folder]])


def library_of(include):
    return next((name for name, (pattern, _) in LIBRARIES.items() if re.match(pattern, include)), None)


def headers_that_show_libraries(files, internal_headers):
    def shown(name, seen):
        """The library besides Eigen that whoever includes this file needs, or None."""
        for include in files.get(name, []):
            if include in seen:
                continue
            seen.add(include)
            library = library_of(include)
            if library in (None, "Eigen"):
                library = shown(include, seen)
            if library:
                return library
        return None

    installed = [name for name in files if name.endswith(".hpp") and name.startswith("prowl/")]
    showing = {name: shown(name, set()) for name in installed}
    found = [
        f"{name}: shows {library} and is not an internal header"
        for name, library in showing.items()
        if library and name not in internal_headers
    ]
    return found + [
        f"{name}: does not show a library, is no internal header" for name in internal_headers if not showing.get(name)
    ]


if __name__ == "__main__":
    source_dir = Path(sys.argv[1])
    lines = violations(source_dir, sys.argv[2:]) + unused_allowances(source_dir)
    print("\n".join(lines) or "every include is allowed, every allowance is used")
    sys.exit(1 if lines else 0)
