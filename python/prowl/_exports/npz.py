"""motion.npz: a motion as NumPy arrays."""

from __future__ import annotations

import io

import numpy as np


def arrays(motion: dict) -> dict[str, np.ndarray]:
    samples, phases, components = motion["samples"], motion["phases"], motion["components"]
    contacts = motion["contacts"]
    held = [[contact in (c["contact"] for c in phase["contacts"]) for contact in contacts] for phase in phases]
    result = {
        "format": np.array(motion["format"]),
        "robot": np.array(motion["robot"]),
        "task": np.array(motion["task"]),
        "motion": np.array(motion["motion"]),
        "good": np.array(motion["good"]),
        "t": np.array(samples["time_s"], dtype=float),
        "phase": np.array(samples["phase"], dtype=np.int64),
        "in_contact": np.array(samples["in_contact"], dtype=bool),
        "joints": np.array(motion["joints"], dtype=str),
        "contacts": np.array(contacts, dtype=str),
        "links": np.array([link["name"] for link in motion["links"]], dtype=str),
        "link_parents": np.array([link["parent"] or "" for link in motion["links"]], dtype=str),
        "phases": np.array([phase["name"] for phase in phases], dtype=str),
        "phase_start": np.array([phase["start_s"] for phase in phases], dtype=float),
        "phase_end": np.array([phase["end_s"] for phase in phases], dtype=float),
        "phase_contacts": np.array(held, dtype=bool),
    }
    for name, key in (
        ("q", "q"),
        ("v", "v"),
        ("a", "a"),
        ("tau", "tau"),
        ("f", "force_N"),
        ("contact_position", "contact_position_m"),
        ("link_placement", "link_placement"),
        ("K", "K"),
    ):
        if samples[key] is not None:
            result[name] = np.array(samples[key], dtype=float)
    for name, columns in components.items():
        if name in result:
            result[f"{name}_names"] = np.array(columns, dtype=str)
    return result


def write(motion: dict) -> bytes:
    """Content of the file. `motion`: motion.json as a dict."""
    file = io.BytesIO()
    np.savez_compressed(file, allow_pickle=False, **arrays(motion))
    return file.getvalue()
