"""Draws the figures of a plan: each function returns the files of one figure, by name."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
from collections.abc import Callable

import numpy as np
from matplotlib.lines import Line2D

from .._processes import die_with_parent
from . import style, tables

DEGREE = np.pi / 180
MOST_COLUMNS = 6
JA, JDOTV = r"$J\,a$", r"$-\dot{J}\,v$"
Files = dict[str, bytes]


def by_leg(shown: tables.Shown, row_height: float):
    """Small multiples: a row per leg, a panel per joint. Longer chains than MOST_COLUMNS (arms and head) take
    several rows. Joints of a column share their scale if all rows have the same length."""
    rows = [leg[i : i + MOST_COLUMNS] for leg in shown.legs for i in range(0, len(leg), MOST_COLUMNS)]
    columns = max(len(row) for row in rows)
    alike = all(len(row) == columns for row in rows)
    figure, grid = style.grid(
        len(rows),
        columns,
        max(7.0, min(3.4, 13 / columns) * columns),
        1.1 + row_height * len(rows),
        sharey="col" if alike else False,
    )
    panels = []
    for row, leg in zip(grid, rows):
        for axes, joint in zip(row, leg):
            axes.set_title(joint, loc="left")
            panels.append((axes, joint))
        for axes in row[len(leg) :]:
            axes.set_visible(False)
    for column in grid.T:
        lowest = [axes for axes in column if axes.get_visible()][-1]
        lowest.tick_params(labelbottom=True)
        lowest.set_xlabel("time [s]")
    return figure, grid, panels  # axes with their joints


def end_of(shown: tables.Shown) -> float:
    return float((shown.simulated if shown.simulated is not None else shown.nodes)["time_s"][-1])


def draw_torques(shown: tables.Shown) -> Files:
    table = tables.torques(shown)
    figure, grid, panels = by_leg(shown, 1.9)
    simulated = shown.simulated is not None
    for axes, joint in panels:
        axes.plot(shown.nodes["time_s"], shown.nodes[f"tau_{joint}_Nm"], color="0.72", lw=4, solid_capstyle="butt")
        if simulated:
            axes.plot(table["time_s"], table[f"tau_{joint}_Nm"], color=style.BLUE)
            axes.plot(table["time_s"], table[f"feedforward_{joint}_Nm"], color=style.VERMILLION, ls=style.DASHES[1])
            axes.plot(table["time_s"], table[f"feedback_{joint}_Nm"], color=style.GREEN, lw=0.9)
    limit_seen = False
    for axes, joint in panels:
        style.at_least(axes, 1.0)
        low, high = axes.get_ylim()  # limits appear only near torques; they do not set the scale
        for side in ("lower", "upper"):
            limit = shown.nodes[f"{side}_{joint}_Nm"]
            axes.plot(shown.nodes["time_s"], limit, color="black", lw=0.9, ls=style.DASHES[2])
            limit_seen = limit_seen or bool(np.any((limit > low) & (limit < high)))
    for row in grid:
        row[0].set_ylabel("torque [N m]")
    style.mark_phases(grid, shown.phases, end_of(shown))
    handles = [Line2D([], [], color="0.72", lw=4, label="planned")]
    if simulated:
        handles += [
            Line2D([], [], color=style.BLUE, label="simulated, at the joint"),
            Line2D([], [], color=style.VERMILLION, ls=style.DASHES[1], label="feedforward"),
            Line2D([], [], color=style.GREEN, label="feedback"),
        ]
    if limit_seen:
        handles.append(
            Line2D([], [], color="black", lw=0.9, ls=style.DASHES[2], label="limit, where torques come near")
        )
    return style.finish(
        figure, f"{shown.title}: joint torques", shown.settings(), handles, "torques", tables.rounded(table)
    )


def draw_contact_acceleration(shown: tables.Shown) -> Files:
    table = shown.contact_acceleration
    contacts = shown.contacts
    figure, grid = style.grid(len(contacts), 3, 10.5, 1.1 + 1.6 * len(contacts), sharey=True)
    for row, contact in zip(grid, contacts):
        for axes, axis in zip(row, tables.AXES):
            from_a, from_v = (table[f"{term}_{contact}_{axis}_mps2"] for term in ("Ja", "minus_Jdotv"))
            axes.plot(table["time_s"], from_a, color=style.SKY, lw=3.5, solid_capstyle="butt")
            axes.plot(table["time_s"], from_v, color="black", lw=0.9, ls=style.DASHES[1])
            axes.set_title(f"{contact}, {axis}: at most {style.largest(from_a - from_v):.2g} m/s² apart", loc="left")
        row[0].set_ylabel("[m/s²]")
    style.at_least(grid[0, 0], 0.01)
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    style.mark_phases(grid, shown.phases, float(shown.nodes["time_s"][-1]))
    handles = [
        Line2D([], [], color=style.SKY, lw=3.5, label=JA),
        Line2D([], [], color="black", lw=0.9, ls=style.DASHES[1], label=JDOTV),
    ]
    return style.finish(
        figure,
        f"{shown.title}: acceleration of the contacts, {JA} against {JDOTV}",
        "as planned, world axes, while the contact holds: there " + r"$J\,a + \dot{J}\,v = 0$",
        handles,
        "contact_acceleration",
        tables.exact(table),
    )


def draw_base_error(shown: tables.Shown) -> Files:
    table = tables.base_error(shown)
    figure, grid = style.grid(2, 2, 9.5, 5.6)
    rows = (("error", "simulated − planned"), ("estimate_error", "estimated − simulated"))
    for row, (name, what) in zip(grid, rows):
        for axes, kind, unit, scale, quantity in (
            (row[0], "p", "m", 1e3, "position [mm]"),
            (row[1], "r", "rad", 1 / DEGREE, "orientation [deg]"),
        ):
            values = np.array([table[f"{name}_{kind}{axis}_{unit}"] for axis in tables.AXES])
            for value, colour in zip(values, style.AXIS_COLOURS):
                axes.plot(table["time_s"], scale * value, color=colour, lw=1.1 if name == "error" else 0.7)
            worst = scale * np.max(np.linalg.norm(values, axis=0))
            axes.set_title(f"{what}: at most {worst:.2g} {'mm' if kind == 'p' else 'deg'}", loc="left")
            axes.set_ylabel(quantity)
            style.at_least(axes, 0.1 if kind == "p" else 0.01)
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    style.mark_phases(grid, shown.phases, end_of(shown))
    handles = [Line2D([], [], color=c, label=a) for a, c in zip(tables.AXES, style.AXIS_COLOURS)]
    return style.finish(
        figure,
        f"{shown.title}: errors of the base",
        shown.settings() + "\npositions in the world, orientation as a rotation vector",
        handles,
        "base_error",
        tables.rounded(table),
    )


def draw_joint_error(shown: tables.Shown) -> Files:
    table = tables.joint_error(shown)
    figure, grid, panels = by_leg(shown, 1.6)
    for axes, joint in panels:
        axes.plot(table["time_s"], table[f"estimate_error_{joint}_rad"] / DEGREE, color=style.ORANGE, lw=0.8)
        axes.plot(table["time_s"], table[f"error_{joint}_rad"] / DEGREE, color=style.BLUE)
    for axes, _ in panels:
        style.at_least(axes, 0.02)
    for row in grid:
        row[0].set_ylabel("angle [deg]")
    style.mark_phases(grid, shown.phases, end_of(shown))
    handles = [
        Line2D([], [], color=style.BLUE, label="simulated − planned"),
        Line2D([], [], color=style.ORANGE, lw=0.8, label="estimated − simulated"),
    ]
    return style.finish(
        figure, f"{shown.title}: errors of the joints", shown.settings(), handles, "joint_error", tables.rounded(table)
    )


def draw_gains(shown: tables.Shown) -> Files:
    names = [name for name in shown.gains if name not in ("time_s", "segment")]
    half = len(names) // 2
    groups = [
        ("base position [N m/m]", names[0:3]),
        ("base orientation [N m/rad]", names[3:6]),
        ("joint positions [N m/rad]", names[6:half]),
        ("base velocity [N m s/m]", names[half : half + 3]),
        ("base angular velocity [N m s/rad]", names[half + 3 : half + 6]),
        ("joint rates [N m s/rad]", names[half + 6 :]),
    ]
    legend_rows = -(-len(shown.joints) // 6)
    figure, grid = style.grid(2, 3, 11.5, 6.0 + 0.18 * legend_rows)
    for axes, (title, columns) in zip(grid.flat, groups):
        for i, column in enumerate(columns):
            if len(columns) == 3 and column.startswith("base"):
                colour, dash = style.AXIS_COLOURS[i], style.DASHES[i]
            else:
                leg, place = next(
                    (k, leg.index(shown.joints[i])) for k, leg in enumerate(shown.legs) if shown.joints[i] in leg
                )
                colour, dash = style.LEG_COLOURS[leg % len(style.LEG_COLOURS)], style.DASHES[place % len(style.DASHES)]
            axes.plot(shown.gains["time_s"], shown.gains[column], color=colour, ls=dash)
        axes.set_title("on " + title, loc="left")
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    for row in grid:
        row[0].set_ylabel("gain")
    style.mark_phases(grid, shown.phases, float(shown.nodes["time_s"][-1]))
    axes_handles = [
        Line2D([], [], color=c, ls=d, label=f"base {a}")
        for a, c, d in zip(tables.AXES, style.AXIS_COLOURS, style.DASHES)
    ]
    handles = [
        Line2D(
            [],
            [],
            color=style.LEG_COLOURS[k % len(style.LEG_COLOURS)],
            ls=style.DASHES[i % len(style.DASHES)],
            label=name,
        )
        for k, leg in enumerate(shown.legs)
        for i, name in enumerate(leg)
    ]
    figure.legend(
        handles, [h.get_label() for h in handles], loc="lower center", ncols=min(6, len(handles)), handlelength=2.8
    )
    return style.finish(
        figure,
        f"{shown.title}: the {len(names)} gains of the torque of {shown.joint}",
        "torque = planned + gains · (planned − measured state); lines of the joints by leg (colour) and place in it (dashes)",
        axes_handles,
        "gains",
        tables.exact(shown.gains),
        bottom=0.1 + 0.18 * legend_rows,
    )


def draw_torque_over_position(shown: tables.Shown) -> Files:
    table = tables.torque_over_position(shown)
    rows = (len(table) + 1) // 2
    figure, grid = style.grid(rows, 2, 8.5, 1.2 + 2.5 * rows, sharey=True, sharex=False)
    for axes, (joint, by_series) in zip(grid.flat, table.items()):
        position, upper, lower = shown.limit_curves[joint]
        axes.fill_between(position, lower, upper, color="0.955", zorder=0)
        for limit in (upper, lower):
            axes.plot(position, limit, color="black", lw=1.2)
        for name, colour, width in (("simulation", style.SKY, 3.0), ("plan", style.VERMILLION, 1.1)):
            if name in by_series:
                axes.plot(by_series[name][1], by_series[name][2], color=colour, lw=width)
        axes.plot(*by_series["plan"][1:, 0], "o", color=style.VERMILLION, mec="white", ms=6)
        shares = {
            name: style.largest(
                torque / np.where(torque < 0, np.interp(at, position, lower), np.interp(at, position, upper))
            )
            for name, (_, at, torque) in by_series.items()
        }
        axes.set_title(
            f"{joint}: " + ", ".join(f"{name} {share:.0%}" for name, share in shares.items()) + " of the limit",
            loc="left",
        )
        axes.set_xlabel("position [rad]")
    for axes in grid.flat[len(table) :]:
        axes.set_visible(False)
    for axes in grid[:, 0]:
        axes.set_ylabel("torque [N m]")
    handles = [
        Line2D([], [], color="black", lw=1.2, label="limit"),
        Line2D([], [], color=style.VERMILLION, label="planned"),
        Line2D([], [], color=style.VERMILLION, marker="o", mec="white", ms=6, lw=0, label="start"),
    ]
    if shown.simulated is not None:
        handles.append(Line2D([], [], color=style.SKY, lw=3, label="simulated"))
    files = style.finish(
        figure,
        f"{shown.title}: torque against position, with its limit",
        shown.settings(),
        handles,
        "torque_over_position",
        tables.torque_over_position_text(table),
    )
    return files | {"limit_curves.csv": tables.limit_curves_text(shown.limit_curves).encode()}


def draw(shown: tables.Shown, on_progress: Callable[[int, int], object] | None) -> Files:
    """All figures, each in its own process: each takes a second or more, and changes Matplotlib's
    settings."""
    drawn: list[Callable[[tables.Shown], Files]] = [draw_torques, draw_contact_acceleration]
    if shown.simulated is not None:
        drawn += [draw_base_error, draw_joint_error]
    if shown.gains is not None:
        drawn += [draw_gains]
    if shown.limit_curves:
        drawn += [draw_torque_over_position]
    files: Files = {}
    with concurrent.futures.ProcessPoolExecutor(
        mp_context=multiprocessing.get_context("fork"), initializer=_begin
    ) as pool:
        done = concurrent.futures.as_completed([pool.submit(function, shown) for function in drawn])
        if on_progress is not None:
            on_progress(0, len(drawn))
        for number, figure in enumerate(done, 1):
            files |= figure.result()
            if on_progress is not None:
                on_progress(number, len(drawn))
    return files


def _begin() -> None:
    die_with_parent()
    style.use()
