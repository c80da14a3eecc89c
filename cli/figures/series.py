"""What the figures show, from the files of a plan: read, put side by side, written as tables."""

import csv
import json
import pathlib

import numpy as np
from scipy.spatial.transform import Rotation

Table = dict[str, np.ndarray]  # columns by name, in order
AXES = ("x", "y", "z")


def read_table(path: pathlib.Path) -> Table:
    """A CSV of numbers with a heading."""
    with open(path, newline="", encoding="utf-8") as file:
        names = next(csv.reader(file))
        values = np.loadtxt(file, delimiter=",", ndmin=2)
    return {name: values[:, i] for i, name in enumerate(names)}


def write_table(path: pathlib.Path, table: Table) -> None:
    with open(path, "w", encoding="utf-8") as file:
        file.write(",".join(table) + "\n")
        np.savetxt(file, np.column_stack(list(table.values())), fmt="%.9g", delimiter=",")


class Plan:
    """A plan's folder, and the tables that `prowl figures` made of it with the robot's model."""

    def __init__(self, folder: pathlib.Path, tables: pathlib.Path):
        self.tables = tables
        record = json.loads((folder / "plan.json").read_text(encoding="utf-8"))
        self.title = f"{record['problem']['robot']}, {record['name']}"
        self.joints: list[str] = record["problem"]["joints"]
        self.phase_names = [phase["name"] for phase in record["problem"]["phases"]]
        self.nodes = read_table(folder / "trajectory.csv")
        self.limits = read_table(tables / "torque_limits.csv")
        self.contact_acceleration = read_table(tables / "contact_acceleration.csv")
        self.contacts = [name[len("contact_") :] for name in self.nodes if name.startswith("contact_")]
        self.gains = read_table(tables / "gains.csv") if (tables / "gains.csv").exists() else None
        self.simulated = read_table(folder / "simulate.csv") if (folder / "simulate.csv").exists() else None
        self.simulation = json.loads((folder / "simulate.json").read_text(encoding="utf-8")) if self.simulated else None
        with open(tables / "legs.csv", newline="", encoding="utf-8") as file:
            leg_of = {row["joint"]: int(row["leg"]) for row in csv.DictReader(file)}
        self.legs = [[j for j in self.joints if leg_of[j] == leg] for leg in sorted(set(leg_of.values()))]
        self.limit_curves = self._read_limit_curves()

    def _read_limit_curves(self) -> dict[str, np.ndarray]:
        """By joint: positions and limits, 2 rows; without such joints, the file may be missing."""
        points: dict[str, list[tuple[float, float]]] = {}
        if not (self.tables / "limit_curves.csv").exists():
            return {}
        with open(self.tables / "limit_curves.csv", newline="", encoding="utf-8") as file:
            for row in csv.DictReader(file):
                points.setdefault(row["joint"], []).append((float(row["position_rad"]), float(row["limit_Nm"])))
        return {joint: np.array(rows).T for joint, rows in points.items()}

    def phases(self) -> list[tuple[str, float, float]]:
        """Name, start and end [s]."""
        time, phase = self.nodes["time_s"], self.nodes["phase"]
        return [(name, time[phase == p][0], time[phase == p][-1]) for p, name in enumerate(self.phase_names)]

    def settings(self) -> str:
        """What the simulation was, on one line."""
        if not self.simulation:
            return "planned motion only: not simulated yet"
        options = self.simulation["options"]
        result = "success" if self.simulation["success"] else "FAILED"
        loop = f"{'open' if options['open_loop'] else 'closed'} loop"
        if self.simulation["engine"] == "rollout":
            rate = options["control_rate_Hz"]
            offset = any(options["base_offset_m"] + options["base_offset_rad"])
            return ", ".join(
                [
                    "rollout of the projected dynamics",
                    loop,
                    f"control at {rate:g} Hz" if rate else "continuous control",
                    *(["base off at the start"] if offset else []),
                    result,
                ]
            )
        parts = [
            f"MuJoCo, {loop}",
            "true state"
            if options["perfect_state"]
            else f"estimated state, sensor noise × {options['noise']['scale']:g}",
            f"delay {1e3 * options['delay_s']:g} ms",
            f"seed {options['seed']}",
        ]
        if options["mass_scale"] != 1:
            parts.append(f"masses × {options['mass_scale']:g}")
        if options["friction"] is not None:
            parts.append(f"friction {options['friction']:g}")
        if options["pushes"]:
            parts.append(f"{len(options['pushes'])} push(es)")
        parts.append(result)
        return ", ".join(parts)


def torques(plan: Plan) -> Table:
    """Of each joint [N m]: planned (nan after the plan's end) with its limits, and as simulated: feedforward and feedback,
    at the time at which they act, and what the joint gave. Without a simulation, the plan at its nodes."""
    nodes, sim = plan.nodes, plan.simulated
    if sim is None:
        table = {"time_s": nodes["time_s"]}
        for joint in plan.joints:
            table |= {
                f"plan_{joint}_Nm": nodes[f"tau_{joint}_Nm"],
                **{f"{side}_{joint}_Nm": plan.limits[f"{side}_{joint}_Nm"] for side in ("lower", "upper")},
            }
        return table
    time = sim["time_s"]
    delay = plan.simulation["options"].get("delay_s", 0.0)  # a rollout has none
    planned = lambda t, column: np.interp(time, t, column, right=np.nan)  # noqa: E731
    acting = lambda column: np.interp(time, time + delay, column)  # noqa: E731
    table = {"time_s": time}
    for joint in plan.joints:
        table |= {
            f"plan_{joint}_Nm": planned(nodes["time_s"], nodes[f"tau_{joint}_Nm"]),
            **{
                f"{side}_{joint}_Nm": planned(plan.limits["time_s"], plan.limits[f"{side}_{joint}_Nm"])
                for side in ("lower", "upper")
            },
            **{f"{kind}_{joint}_Nm": acting(sim[f"{kind}_{joint}_Nm"]) for kind in ("feedforward", "feedback")},
            f"tau_{joint}_Nm": sim[f"tau_{joint}_Nm"],
        }
    return table


def base_error(plan: Plan) -> Table:
    """Simulated against planned base and estimate against truth: difference of positions in the world [m], and the
    rotation from the first to the second as a vector in the base frame of the first [rad]: plan to truth, truth to estimate."""
    sim = plan.simulated
    table = {"time_s": sim["time_s"]}
    for name, before, after in (("error", "ref", "true"), ("estimate_error", "true", "seen")):
        for axis in AXES:
            table[f"{name}_p{axis}_m"] = sim[f"{after}_base_p{axis}_m"] - sim[f"{before}_base_p{axis}_m"]
        orientation = {
            kind: Rotation.from_quat(np.column_stack([sim[f"{kind}_base_q{c}"] for c in "xyzw"]))
            for kind in (before, after)
        }
        turn = (orientation[before].inv() * orientation[after]).as_rotvec()
        table |= {f"{name}_r{axis}_rad": turn[:, i] for i, axis in enumerate(AXES)}
    return table


def joint_error(plan: Plan) -> Table:
    """Of each joint [rad]: simulated less planned position, and estimate less truth."""
    sim = plan.simulated
    table = {"time_s": sim["time_s"]}
    for joint in plan.joints:
        table[f"error_{joint}_rad"] = sim[f"true_q_{joint}_rad"] - sim[f"ref_q_{joint}_rad"]
        table[f"estimate_error_{joint}_rad"] = sim[f"seen_q_{joint}_rad"] - sim[f"true_q_{joint}_rad"]
    return table


def torque_over_position(plan: Plan) -> dict[str, dict[str, np.ndarray]]:
    """By joint with a limit over its position, by series: time [s], position [rad], torque [N m], 3 rows."""
    table = {}
    for joint in plan.limit_curves:
        columns = {"plan": (plan.nodes, "")} | ({"simulation": (plan.simulated, "true_")} if plan.simulated else {})
        table[joint] = {
            series: np.array([source["time_s"], source[f"{prefix}q_{joint}_rad"], source[f"tau_{joint}_Nm"]])
            for series, (source, prefix) in columns.items()
        }
    return table


def write_torque_over_position(path: pathlib.Path, table: dict[str, dict[str, np.ndarray]]) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["joint", "series", "time_s", "position_rad", "torque_Nm"])
        for joint, by_series in table.items():
            for series, rows in by_series.items():
                writer.writerows([joint, series, *(f"{x:.9g}" for x in row)] for row in rows.T)
