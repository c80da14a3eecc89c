"""Names and numbers in the format of Prowl's tables."""

from __future__ import annotations


def gain_columns(joints: list[str]) -> list[str]:
    """Names, with units, of the 2 nv columns of a gain K (docs/tracking.md)."""

    def base(quantity: str, unit: str) -> list[str]:
        return [f"base_{quantity}{axis}_{unit}" for axis in "xyz"]

    positions = [*base("p", "Npm"), *base("r", "Nmprad"), *(f"q_{joint}_Nmprad" for joint in joints)]
    return [*positions, *base("v", "Nspm"), *base("w", "Nmsprad"), *(f"v_{joint}_Nmsprad" for joint in joints)]


def number(value: float) -> str:
    """All digits, as in trajectory.csv; integers without ".0"."""
    return repr(value).removesuffix(".0")
