"""docs/architecture.md tells one plan as a list of functions. This test traces a real `prowl plan --one-mesh` and compares.

    flow_test.py PROWL

The dynamic linker writes the trace: with LD_DEBUG=bindings and LD_BIND_NOT it prints a line for each call of a function with
external linkage in a shared library, and each folder of prowl/ is one such library.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROWL = pathlib.Path(sys.argv.pop(1)) if len(sys.argv) > 1 else ROOT / "build/bin/prowl"
PAGE = ROOT / "docs/architecture.md"
STEP = re.compile(r"^\d+\. `(?P<folder>[\w/.]+)`, `(?P<function>[\w:~]+)\(\)`", re.MULTILINE)
FIRST = "package_search"  # Before it, the command declares its options.
BINDING = re.compile(rb"binding file (\S+) \[0\] to (\S+) \[0\]: normal symbol `(\w+)'")

# Folders that are entered before their turn, and why.
EARLY = {
    "prowl/dynamics": "the start of a task file keeps its contacts where they are: fit_contacts()",
    "prowl/tracking": "the task file may change the weights of the feedback design: default_tracking_options()",
    "prowl/plan_folder": "a folder that cannot be written ends the command before the solve: check_plan_directory()",
    "prowl/kernels": "the record of a plan names the instruction set: dense_kernels()",
    "prowl/simulation": "the record of a plan names the version of MuJoCo: Physics::version()",
}
# Called all the time: by everything, and by solvers through Nlp.
ANY_TIME = {"prowl/model", "prowl/nlp"}


def steps():
    """(folder, function) of the page, in its order. prowl/plan.cpp is the folder prowl."""
    text = PAGE.read_text(encoding="utf-8").split("## One plan", 1)[1].split("\n## ", 1)[0]
    found = [(m["folder"], m["function"]) for m in STEP.finditer(text)]
    return [("prowl" if folder == "prowl/plan.cpp" else folder, function) for folder, function in found]


def folder_of(library):
    """The folder of a library or program: libprowl_mesh.so is prowl/mesh."""
    name = pathlib.Path(library).name
    if name == "prowl":
        return "cli"
    name = re.sub(r"^libprowl_(\w+)\.so.*$", r"\1", name)
    if name == "plan":
        return "prowl"
    return name if (ROOT / name).is_dir() else f"prowl/{name}"


def own_functions():
    """Mangled name: what it demangles to, of all functions that our libraries define; not those of templates and headers,
    of which any library has a copy."""
    symbols = []
    for library in PROWL.parent.parent.rglob("libprowl_*.so"):
        lines = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True)
        symbols += [line.split()[2] for line in lines.stdout.splitlines() if line.split()[1] == "T"]
    plain = subprocess.run(["c++filt"], check=True, capture_output=True, text=True, input="\n".join(symbols))
    return dict(zip((symbol.encode() for symbol in symbols), plain.stdout.splitlines()))


class Call:
    """One call, from a library to a function of another or of its own."""

    def __init__(self, caller, library, plain):
        self.caller, self.folder = folder_of(caller), folder_of(library)
        self.signature = plain.replace("[abi:cxx11]", "")
        self.function = re.sub(r"^prowl::", "", self.signature.split("(", 1)[0])
        self.is_constructor = re.search(r"\b(\w+)::\1\(", self.signature) is not None


def trace(*arguments):
    """Calls of our functions by `prowl plan`, in order."""
    functions, calls, known = own_functions(), [], {}
    environment = os.environ | {"LD_DEBUG": "bindings", "LD_BIND_NOT": "1", "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryDirectory() as out:
        command = [PROWL, "plan", *arguments, "--quiet", "--out", f"{out}/plan"]
        with subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE) as process:
            for line in process.stderr:
                text = line.partition(b"\t")[2]
                if text not in known:
                    found = BINDING.match(text)
                    is_ours = found and found[3] in functions
                    known[text] = Call(found[1].decode(), found[2].decode(), functions[found[3]]) if is_ours else None
                if known[text]:
                    calls.append(known[text])
    first = next(i for i, call in enumerate(calls) if call.function == FIRST)
    return calls[first:]


class OnePlan(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.calls = trace(ROOT / "tasks/hyq/hold.toml", "--one-mesh")

    def first_call(self, folder, function):
        """Place in the trace; a class stands for its constructor."""
        names = {function, f"{function}::{function.split('::')[-1]}"}
        for i, call in enumerate(self.calls):
            if call.folder == folder and call.function in names:
                return i
        self.fail(f"{folder}: {function}() is on the page and is not called")

    def test_functions_of_the_page_are_called_in_its_order(self):
        listed = [step for step in steps() if not step[0].startswith("cli")]
        self.assertGreater(len(listed), 15, "the list of the page was not found")
        places = [self.first_call(*step) for step in listed]
        for before, after, i, j in zip(listed, listed[1:], places, places[1:]):
            self.assertLess(i, j, f"{before} is called after {after}")

    def test_folders_are_entered_in_the_order_of_the_page(self):
        entered = list(dict.fromkeys(call.folder for call in self.calls if call.folder not in ANY_TIME))
        listed = list(dict.fromkeys(folder for folder, _ in steps() if folder not in ANY_TIME | {"cli/verbs"}))
        for folder in EARLY:
            self.assertIn(folder, entered, "an exception that is none")
            if folder in listed:
                self.assertLess(entered.index(folder), listed.index(folder), f"{folder}: an exception that is none")
        self.assertEqual([f for f in entered if f not in EARLY], [f for f in listed if f not in EARLY])

    def test_make_plan_has_one_caller(self):
        self.assertEqual([call.caller for call in self.calls if call.function == "make_plan"], ["prowl/session"])


class OnceAMesh(unittest.TestCase):
    def constructions(self, calls, name):
        return sum(call.is_constructor and call.function == f"{name}::{name}" for call in calls)

    def test_problem_schedule_and_mesh_are_made_once_a_mesh(self):
        text = (ROOT / "tasks/hyq/kneel.toml").read_text(encoding="utf-8")
        text = text.replace("../../robots", f"{ROOT}/robots").replace(
            "duration_s = 1.5", "duration_s = 1.5\nintervals = 60"
        )
        with tempfile.NamedTemporaryFile("w", suffix=".toml", encoding="utf-8") as two_meshes:
            two_meshes.write(text)
            two_meshes.flush()
            self.check(ROOT / "tasks/paper/step.toml", ("--one-mesh",), phases=3, meshes=1)
            self.check(two_meshes.name, (), phases=1, meshes=2)

    def check(self, task, options, phases, meshes):
        calls = trace(task, "--max-iterations", "1", *options)
        self.assertEqual(self.constructions(calls, "Transcription"), meshes)
        self.assertEqual(self.constructions(calls, "DiscreteProblem"), meshes)
        self.assertEqual(self.constructions(calls, "ContactSchedule"), meshes)
        self.assertEqual(self.constructions(calls, "PhaseMesh"), meshes * phases)


if __name__ == "__main__":
    unittest.main()
