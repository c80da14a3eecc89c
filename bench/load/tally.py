"""What became of the plans of many tasks, and what that says of Prowl: silence, exceptions and growing memory are failures."""

import collections
from collections.abc import Callable

from load.quantiles import quantiles

SETTLED = 50  # tasks, after which memory has to stay where it is
REFUSED = "refused before the solve"
GROWTH = 0.05


def why(plan) -> str:
    """In one line; "" if the plan does not say. The certificate is a reason for a solution only: no motion passes that is none."""
    if plan.reasons or plan.hints:
        return (list(plan.reasons) + list(plan.hints))[0]
    failed = [check.name for check in plan.certificate.checks if not check.passed]
    if failed:
        return "certificate: " + ", ".join(failed) if plan.status == "converged" else ""
    return plan.message  # passes, but its solver stopped short


def in_words(seconds: list[float]) -> str:
    return (
        ", ".join(f"{name} {value:.3f}" for name, value in zip(("median", "90 %", "99 %", "most"), quantiles(seconds)))
        or "-"
    )


class Tally:
    def __init__(self, diagnose: Callable[[object], str]) -> None:
        """diagnose: why a task has no plan, for those whose plan does not say; "" if it finds nothing."""
        self.diagnose = diagnose
        self.outcomes = collections.Counter()
        self.seconds: dict[str, list[float]] = {"solved": [], "not solved": []}
        self.silent: list[int] = []
        self.diagnosed: list[int] = []
        self.thrown: list[str] = []
        self.memory: list[int] = []
        self.opinions: dict[int, str] = {}

    def add(self, number: int, task, plan, seconds: float) -> str:
        reason = "" if plan.good else why(plan)
        outcome = (
            "good"
            if plan.good
            else REFUSED
            if plan.reasons
            else "converged, certificate failed"
            if plan.status == "converged"
            else plan.status
        )
        if not plan.good and not reason:
            reason = self.diagnose(task)
            (self.diagnosed if reason else self.silent).append(number)
        self.outcomes[outcome] += 1
        self.seconds["solved" if plan.good else "not solved"].append(seconds)
        return f"{outcome}: {reason}" if reason else outcome

    def add_opinion(self, number: int, solved: str) -> None:
        """Of a task without plan or proof: who solved it on a finer mesh, "" if no solver did."""
        self.opinions[number] = solved

    def feasible(self) -> str:
        solved = [number for number, who in self.opinions.items() if who]
        without = [number for number, who in self.opinions.items() if not who]
        good = self.outcomes["good"]
        return (
            f"{good} of {good + len(solved)} tasks that may have a motion, {100.0 * good / max(good + len(solved), 1):.1f} %; "
            f"{self.outcomes[REFUSED]} with a proof that they have none\n"
            f"solved on a finer mesh only: {solved}\nsolved by none: {without}"
        )

    def failures(self) -> list[str]:
        found = [f"task {number} failed and does not say why" for number in self.silent] + self.thrown
        if len(self.memory) > SETTLED:
            before, after = self.memory[SETTLED - 1], max(self.memory[-10:])
            if after > (1.0 + GROWTH) * before:
                found.append(f"memory grew from {before / 1e6:.1f} to {after / 1e6:.1f} MB")
        return found

    def report(self) -> None:
        total = sum(self.outcomes.values())
        for outcome, count in self.outcomes.most_common():
            print(f"{outcome:32} {count:5}  {100.0 * count / total:5.1f} %")
        if self.opinions:
            print(self.feasible())
        print(f"{'why: only a diagnosis says':32} {len(self.diagnosed):5}")
        for name, seconds in self.seconds.items():
            print(f"time of those {name:11} [s]  {in_words(seconds)}")
        if len(self.memory) > SETTLED:
            print(
                f"memory after {SETTLED} tasks {self.memory[SETTLED - 1] / 1e6:.1f} MB, at the end {self.memory[-1] / 1e6:.1f} MB"
            )
