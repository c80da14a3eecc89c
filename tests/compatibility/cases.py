"""Command lines that use every verb and every option of the commit whose files are kept, and what came of them."""

import json
import os
import pathlib
import shutil
import signal
import subprocess
from dataclasses import dataclass, field

import names


@dataclass(frozen=True)
class Case:
    """`command` without the options that all have. `copy`: a folder that the command may write into, (from, to)."""

    name: str
    command: str
    copy: tuple[str, str] | None = None
    serves: bool = False  # until it is interrupted

    @property
    def verb(self) -> str:
        words = self.command.split()
        return " ".join(words[:2]) if words[0] == "new" else words[0]


@dataclass
class Outcome:
    facts: dict  # exit status, and what of the JSON on stdout has to be the same again
    names: dict[str, set[str]] = field(default_factory=dict)  # by kind: "plan --json", "plan.json", "trajectory.csv"


CASES = [
    Case("robot", "robot robot.toml"),
    Case("robot_frames", "robot robot.toml --frames"),
    *(Case(f"phases_{task}", f"plan tasks/{task}.toml --print-phases") for task in ("step", "gait", "free_steps")),
    Case(
        "plan",
        "plan tasks/crouch.toml --out got/plan --dt 0.05 --threads 2 --max-time 60 --max-iterations 100 --tolerance 1e-6"
        " --report --one-mesh",
    ),
    *(
        Case(f"plan_{solver}", f"plan tasks/crouch.toml --intervals 12 --solver {solver} --no-gains --out got/{solver}")
        for solver in ("riccati", "fatrop", "ipopt", "ipopt-spral", "uno")
    ),
    *(
        Case(f"plan_{kind}", f"plan tasks/crouch.toml --intervals 12 --hessian {kind} --no-gains --out got/{kind}")
        for kind in ("exact", "gauss-newton")
    ),
    Case("plan_refined", "plan tasks/crouch.toml --intervals 12 --refine draft --out got/refined"),
    *(Case(f"plan_{task}", f"plan tasks/{task}.toml --out got/{task}") for task in ("step", "gait", "free_steps")),
    Case("plan_infeasible", "plan tasks/too_far.toml --out got/too_far"),
    Case("plan_wrong", "plan tasks/wrong.toml --out got/wrong"),
    Case("warm_start", "plan tasks/crouch.toml --warm-start out/crouch --intervals 40 --no-gains --out got/warm"),
    Case(
        "checkpoint",
        "plan tasks/crouch.toml --checkpoint got/so_far --checkpoint-every 0 --max-iterations 3 --out got/unfinished",
    ),
    Case("resume_checkpoint", "plan tasks/crouch.toml --resume checkpoint --no-gains --out got/resumed"),
    Case("resume_unfinished", "plan tasks/crouch.toml --resume out/unfinished --no-gains --out got/resumed_again"),
    *(Case(f"check_{plan}", f"check out/{plan}") for plan in ("crouch", "unfinished", "rollout")),
    Case("diagnose", "diagnose tasks/too_far.toml --max-time 60"),
    Case("diagnose_changes", "diagnose tasks/weak.toml --max-time 60"),
    Case(
        "simulate",
        "simulate got/simulated --engine mujoco --record-rate 20 --report --noise 0.5 --delay 1 --bandwidth 200 --mass 1.01"
        " --friction 0.7 --push 0.2 0 0.2 0 --push-duration 0.1 --step 0.0005 --seed 3",
        copy=("out/crouch", "got/simulated"),
    ),
    Case("simulate_perfect", "simulate got/perfect --perfect-state", copy=("out/crouch", "got/perfect")),
    Case("simulate_case", "simulate got/case --case 5", copy=("out/crouch", "got/case")),
    Case("simulate_open_loop", "simulate got/open --open-loop", copy=("out/crouch", "got/open")),
    Case(
        "simulate_rollout",
        "simulate got/rollout --engine rollout --base-offset-m 0.005 0 0 --base-offset-rad 0 0.01 0 --control-rate 500",
        copy=("out/crouch", "got/rollout"),
    ),
    Case(
        "sweep",
        "sweep got/swept --n 2 --seed 4 --mass-spread 0.05 --push-impulse 1 --push-impulse-on-two-feet 0.5 --breakdown 0",
        copy=("out/crouch", "got/swept"),
    ),
    Case("sweep_breakdown", "sweep got/broken --n 1 --breakdown 1", copy=("out/crouch", "got/broken")),
    Case(
        "sweep_open_loop", "sweep got/swept_open --n 1 --breakdown 0 --open-loop", copy=("out/crouch", "got/swept_open")
    ),
    *(
        Case(
            f"compare_{name}",
            f"compare tasks/crouch.toml {options} --intervals 4 --max-iterations 2 --out got/compare_{name}",
        )
        for name, options in {
            "dynamics": "--formulation inverse,forward,kkt,centroidal --solver ipopt --max-time 60 --tolerance 1e-6",
            "all_dynamics": "--formulation all --solver ipopt",
            "rules": "--transcription trapezoid,hermite-simpson,hermite-simpson-separated,rk4 --formulation forward --solver ipopt",
            "all_rules": "--transcription all --formulation forward --solver ipopt",
            "contacts": "--contact stabilised,distance,distance-5mm,distance-velocity,distance-velocity-acceleration --solver ipopt",
            "all_contacts": "--contact all --solver ipopt",
            "orientations": "--orientation se3,euler --solver ipopt --guess smooth",
            "all_orientations": "--orientation all --solver ipopt --guess straight",
            "solvers": "--solver riccati,fatrop,ipopt,ipopt-spral,uno --hessian exact --python python3",
            "all_solvers": "--solver all --hessian gauss-newton",
        }.items()
    ),
    Case(
        "compare_snopt", "compare tasks/crouch.toml --solver snopt --snopt-library nowhere.so --out got/compare_snopt"
    ),
    Case("figures", "figures out/crouch --out got/figures --joint lf_kfe"),
    Case("report", "report out/crouch --out got/report.html"),
    Case("report_rollout", "report out/rollout --out got/report_rollout.html"),
    Case(
        "view",
        "view tasks/crouch.toml --solver riccati --intervals 12 --one-mesh --out got/viewed --port 0",
        serves=True,
    ),
    Case("view_plan", "view out/crouch", serves=True),
    Case("export", "export out/crouch --format csv,json,npz,mcap,joint-trajectory,mujoco --rate 20 --out got/exports"),
    Case("export_simulation", "export out/crouch --simulation --format json,npz,mcap --out got/exports_simulation"),
    Case("new_robot", "new robot package://quad/urdf/quad.urdf --out got/new_robot.toml --force"),
    *(
        Case(f"new_{kind}", f"new task robot.toml --kind {kind} --out got/new_{kind}.toml --force")
        for kind in ("hold", "stand", "crouch", "step")
    ),
    Case("plan_new", "plan new/crouch.toml --no-gains --out got/planned_new"),
    Case("doctor", "doctor"),
    *(Case(f"completion_{shell}", f"completion {shell}") for shell in ("bash", "zsh", "fish")),
]


def options_of_all(verb: str, python: str) -> list[str]:
    """What each case has besides its own options."""
    if verb == "completion":
        return []
    always = ["--json", "--quiet"] if verb == "doctor" else ["--json", "--quiet", "--package-dir", "packages"]
    return [*always, "--python", python] if verb in ("figures", "export") else always


def options_used(python: str = "python3") -> set[tuple[str, str]]:
    """(verb, option), and (verb, "option choice"), of all cases."""
    used = set()
    for case in CASES:
        words = [*case.command.split(), *options_of_all(case.verb, python)]
        for here, word in enumerate(words):
            if not word.startswith("--"):
                continue
            used.add((case.verb, word))
            if here + 1 < len(words) and not words[here + 1].startswith("--"):
                used |= {(case.verb, f"{word} {choice}") for choice in words[here + 1].split(",")}
        if case.verb == "completion":
            used.add((case.verb, f"shell {words[1]}"))
    return used


def read_first_object(stream) -> dict:
    text = ""
    for line in stream:
        text += line
        if line == "}\n":
            break
    return json.loads(text)


MOST_SECONDS = 120  # of one command
FACTS = ("status", "good", "finished", "success", "solvable", "passes", "kind", "cases", "samples")


def facts_of(result: dict) -> dict:
    """What has to be the same again, where the result has it."""
    facts = {key: result[key] for key in FACTS if key in result}
    if "error" in result:
        facts["error"] = result["error"]["kind"]
    if result.get("finished"):
        facts |= {"cost": result["solver"]["cost"], "grade": result["certificate"]["grade"]}
    return facts


def run(case: Case, prowl: str, python: str, folder: pathlib.Path) -> Outcome:
    """In `folder`, which has the kept files."""
    if case.copy:
        shutil.copytree(folder / case.copy[0], folder / case.copy[1])
    command = [prowl, *case.command.split(), *options_of_all(case.verb, python)]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    process = subprocess.Popen(
        command, cwd=folder, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    result = {}
    if case.serves:
        result = read_first_object(process.stdout)
        process.send_signal(signal.SIGINT)
    try:
        stdout, stderr = process.communicate(timeout=MOST_SECONDS)
    except subprocess.TimeoutExpired:
        process.kill()
        raise
    if not case.serves and case.verb != "completion":
        try:
            result = json.loads(stdout)
        except json.JSONDecodeError as error:
            raise AssertionError(f"{' '.join(command)}: no JSON on stdout: {stdout}{stderr}") from error
    facts = facts_of(result) if case.serves else {"exit_status": process.returncode, **facts_of(result)}
    outcome = Outcome(facts, {f"{case.verb} --json": names.of_json(result)} if result else {})
    for written in result.get("written", []):
        if (path := folder / written).is_file():
            outcome.names.setdefault(kind_of(path), set()).update(names.of_file(path))
    return outcome


def kind_of(path: pathlib.Path) -> str:
    """Files whose name the caller chose are known by their extension."""
    return f"*{path.suffix}" if path.suffix in (".toml", ".html") else path.name


def names_by_kind(outcomes: list[Outcome]) -> dict[str, list[str]]:
    kinds = {}
    for outcome in outcomes:
        for kind, found in outcome.names.items():
            kinds.setdefault(kind, set()).update(found)
    return {kind: sorted(found) for kind, found in sorted(kinds.items())}
