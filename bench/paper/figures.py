"""The paper's figures 1, 2 and 4 to 8, from plans and simulations of the same motions."""

import pathlib
import shutil

import numpy as np
import style
from matplotlib.lines import Line2D
from motions import AXES, HEIGHT, Motion, base_positions, read_table
from plans import Planner
from scipy.spatial.transform import Rotation

LEGS = ("lf", "rf", "lh", "rh")  # as seen from above, fore legs first
LEG_NAMES = {"lf": "left fore", "rf": "right fore", "lh": "left hind", "rh": "right hind"}
KINDS = ("haa", "hfe", "kfe")
MARKS = {"haa": (style.BLUE, "*"), "hfe": (style.ORANGE, "+"), "kfe": (style.VERMILLION, "o")}  # those of the paper
DEGREE = np.pi / 180
GAINS_OF = "lh_kfe_joint"


def handle(label: str, **look) -> Line2D:
    return Line2D([], [], label=label, **look)


def save(pictures: dict[str, bytes], out: pathlib.Path) -> None:
    for name, picture in pictures.items():
        (out / name).write_bytes(picture)


def model_tables(planner: Planner, motion: Motion, *options: str) -> pathlib.Path:
    """What the robot's model has to say of a plan: the tables, and the figures, of prowl figures."""
    plan = motion.fine if options else motion.coarse
    planner.run("figures", plan.folder, *options)
    return plan.folder / "figures"


def draw_knee_limit(motions: dict[str, Motion], tables: pathlib.Path, out: pathlib.Path) -> None:
    """Figure 1: the curve of limit_curves.csv, and the knees of all motions under it."""
    rows = [line.split(",") for line in (tables / "limit_curves.csv").read_text(encoding="utf-8").splitlines()[1:]]
    curve = np.array(
        [(-float(position), float(limit)) for joint, position, limit, _ in rows if joint == "lf_kfe_joint"]
    )
    figure, grid = style.grid(1, 1, 6.4, 4.2)
    axes = grid[0, 0]
    axes.fill_between(*curve.T, color="0.955", zorder=0)
    axes.plot(*curve.T, color="black", lw=1.6)
    handles = [handle("limit", color="black", lw=1.6)]
    for motion, colour in zip(motions.values(), style.LEG_COLOURS):
        table = motion.fine.trajectory
        knees = [(np.abs(table[f"q_{leg}_kfe_joint_rad"]), np.abs(table[f"tau_{leg}_kfe_joint_Nm"])) for leg in LEGS]
        for knee in knees:
            axes.plot(*knee, color=colour, lw=0.8, alpha=0.7)
        handles.append(handle(motion.subject.name, color=colour))
    axes.set(xlabel="knee flexion |q| [rad]", ylabel="torque |τ| [N m]", xlim=(0.349, 2.4435), ylim=(0, None))
    title = "Largest torque of HyQ's knee over its angle"
    subtitle = "lines below the limit: the four knees in each motion"
    save(style.finish(figure, title, subtitle, handles, "fig_01_knee_torque_limit"), out)


def draw_phases(motion: Motion, out: pathlib.Path) -> None:
    """Figure 2: contacts of the phases, and what is continuous from one to the next."""
    table, feet = motion.coarse.trajectory, [f"{leg}_foot" for leg in LEGS]
    time, phase = table["time_s"], table["phase"]
    figure, grid = style.grid(3, 1, 7.2, 6.0, height_ratios=[1.1, 1, 1])
    bars, height, torque = grid[:, 0]
    for row, foot in enumerate(feet):
        for number, (_, start, end) in enumerate(motion.phases(motion.coarse)):
            if table[f"contact_{foot}"][phase == number][0] > 0.5:
                bars.broken_barh([(start, end - start)], (-row - 0.36, 0.72), color=style.SKY, ec="white")
    bars.set_yticks(-np.arange(len(feet)), [LEG_NAMES[leg] for leg in LEGS])
    bars.set_title("feet on the ground", loc="left")
    scene = motion.coarse_scene
    path = scene.path("lf_foot")[:, HEIGHT]
    height.plot(scene.time, 100 * (path - path[0]), color="0.7", lw=1.0)
    at_nodes = np.array([path[scene.node(t)] for t in time])
    values = ((height, 100 * (at_nodes - path[0])), (torque, table["tau_lf_kfe_joint_Nm"]))
    for number, colour in enumerate((style.BLUE, style.VERMILLION, style.GREEN)):
        for axes, value in values:
            axes.plot(time[phase == number], value[phase == number], "o", ms=4.5, color=colour)
        torque.plot(time[phase == number], values[1][1][phase == number], color=colour, lw=0.9)
    height.set_title("height of the left fore foot [cm]: both nodes of a switch have the same q and v", loc="left")
    torque.set_title("torque of the left fore knee [N m]: each node obeys the dynamics of its own phase", loc="left")
    torque.set_xlabel("time [s]")
    style.mark_phases(grid, motion.phases(motion.coarse), float(time[-1]))
    for _, start, _ in motion.phases(motion.coarse)[1:]:
        for axes in grid[:, 0]:
            axes.axvline(start, color="0.45", lw=0.8, ls=style.DASHES[2])
    subtitle = f"HyQ's {motion.subject.name} on the mesh of its task file; dots are nodes, two of them at each switch"
    save(style.finish(figure, "Phases of a motion, and the switches between them", subtitle, [], "fig_02_phases"), out)


def take_gains(tables: pathlib.Path, out: pathlib.Path) -> None:
    """Figure 4 is one of prowl figures."""
    for ending in ("svg", "png"):
        shutil.copy(tables / f"gains.{ending}", out / f"fig_04_gains.{ending}")


def draw_standing_torques(motion: Motion, out: pathlib.Path) -> None:
    """Figure 5: the optimiser's torques, a panel a leg."""
    table = motion.coarse.trajectory
    figure, grid = style.grid(2, 2, 7.6, 5.4, sharey=True)
    for axes, leg in zip(grid.flat, LEGS):
        for kind, (colour, mark) in MARKS.items():
            look = {"color": colour, "marker": mark, "ms": 8 if mark != "o" else 6, "mew": 1.6, "mfc": "none"}
            axes.plot(table["time_s"], table[f"tau_{leg}_{kind}_joint_Nm"], lw=0.8, **look)
        axes.set_title(LEG_NAMES[leg], loc="left")
    for axes in grid[1]:
        axes.set_xlabel("time [s]")
    for axes in grid[:, 0]:
        axes.set_ylabel("torque [N m]")
    handles = [
        handle(kind.upper(), color=colour, marker=mark, mew=1.6, mfc="none", lw=0.8, ms=7)
        for kind, (colour, mark) in MARKS.items()
    ]
    nodes = len(table["time_s"])
    subtitle = f"N = {nodes} nodes for T = {table['time_s'][-1]:g} s; the trapezoid has torques linear between them"
    save(
        style.finish(figure, "Output of the optimisation: standing", subtitle, handles, "fig_05_standing_torques"), out
    )


def draw_contact_acceleration(motion: Motion, tables: pathlib.Path, out: pathlib.Path) -> None:
    """Figure 6: both parts of the acceleration of each foot, at the nodes."""
    table = read_table(tables / "contact_acceleration.csv")
    nodes = np.searchsorted(table["time_s"], motion.coarse.trajectory["time_s"] - 1e-9)
    figure, grid = style.grid(2, 4, 11.0, 4.6, sharey=True)
    for column, leg in zip(grid.T, LEGS):
        terms = [
            sign * np.array([table[f"{term}_{leg}_foot_{axis}_mps2"] for axis in AXES])
            for sign, term in ((1, "Ja"), (-1, "minus_Jdotv"))
        ]
        for axes, values in zip(column, terms):
            for value, colour, mark in zip(values, style.AXIS_COLOURS, "osd"):
                axes.plot(table["time_s"], value, color=colour, lw=0.6, alpha=0.5)
                axes.plot(table["time_s"][nodes], value[nodes], mark, color=colour, ms=4.5)
        left = style.largest((terms[0] + terms[1])[:, nodes])
        column[0].set_title(f"{LEG_NAMES[leg]}: sum at the nodes\nat most {left:.2g} m/s²", loc="left")
        column[1].set_xlabel("time [s]")
    grid[0, 0].set_ylabel(r"$J\,\ddot{q}$ [m/s²]")
    grid[1, 0].set_ylabel(r"$\dot{J}\,\dot{q}$ [m/s²]")
    handles = [handle(a, color=c, marker=m, lw=0.6) for a, c, m in zip(AXES, style.AXIS_COLOURS, "osd")]
    title = r"Contacts keep their acceleration: $J\,\ddot{q} + \dot{J}\,\dot{q} = 0$"
    subtitle = "standing on six nodes, world axes; marks at the nodes, lines between them"
    save(style.finish(figure, title, subtitle, handles, "fig_06_contact_acceleration"), out)


def _joint_lines(axes, time: np.ndarray, value_of, width: float = 0.9) -> None:
    """A line a joint: colour by leg, dashes by joint."""
    for leg, colour in zip(LEGS, style.LEG_COLOURS):
        for kind, dash in zip(KINDS, style.DASHES):
            axes.plot(time, value_of(f"{leg}_{kind}_joint"), color=colour, ls=dash, lw=width)


def _draw_base(grid_row, motion: Motion) -> None:
    """Simulated base less where the cost pulls it, with the nodes of the plan on the task's own mesh."""
    simulated, asked = motion.simulated, motion.asked_base()
    position, orientation = grid_row
    turns = Rotation.from_quat(np.column_stack([simulated[f"true_base_q{c}"] for c in "xyzw"])).as_rotvec()
    coarse = base_positions(motion.coarse)
    for i, (axis, colour) in enumerate(zip(AXES, style.AXIS_COLOURS)):
        position.plot(simulated["time_s"], 100 * (simulated[f"true_base_p{axis}_m"] - asked[i]), color=colour)
        position.plot(motion.coarse.trajectory["time_s"], 100 * (coarse[:, i] - asked[i]), "o", color=colour, ms=4)
        orientation.plot(simulated["time_s"], turns[:, i] / DEGREE, color=colour)
    style.at_least(orientation, 0.5)
    position.set_title("base position less its nominal value [cm]", loc="left")
    orientation.set_title("base orientation, rotation vector [deg]", loc="left")


def _draw_joints(grid_row, motion: Motion) -> None:
    simulated, nominal = motion.simulated, motion.nominal_joints()

    def less(joint: str, reference: np.ndarray | float) -> np.ndarray:
        return (simulated[f"true_q_{joint}_rad"] - reference) / DEGREE

    away, error = grid_row
    _joint_lines(away, simulated["time_s"], lambda joint: less(joint, nominal[joint]))
    _joint_lines(error, simulated["time_s"], lambda joint: less(joint, simulated[f"ref_q_{joint}_rad"]))
    away.set_title("joint positions less nominal [deg]", loc="left")
    error.set_title("joint positions less planned [deg]", loc="left")
    style.at_least(error, 0.5)


def _draw_torques(grid_row, motion: Motion) -> None:
    simulated = motion.simulated
    total, feedback = grid_row
    _joint_lines(total, simulated["time_s"], lambda joint: simulated[f"tau_{joint}_Nm"])
    _joint_lines(feedback, simulated["time_s"], lambda joint: simulated[f"feedback_{joint}_Nm"], width=0.4)
    total.set_title("torque at the joints [N m]", loc="left")
    feedback.set_title("feedback part of it [N m]", loc="left")


def draw_simulation(motion: Motion, out: pathlib.Path, name: str) -> None:
    """Figures 7 and 8: base, joints and torques in simulation."""
    figure, grid = style.grid(3, 2, 9.6, 7.6)
    for draw, row in zip((_draw_base, _draw_joints, _draw_torques), grid):
        draw(row, motion)
    for axes in grid[-1]:
        axes.set_xlabel("time [s]")
    style.mark_phases(grid, motion.phases(motion.fine), float(motion.simulated["time_s"][-1]))
    handles = [handle(f"base {axis}", color=colour) for axis, colour in zip(AXES, style.AXIS_COLOURS)]
    handles.append(handle("plan on six nodes", color="0.4", marker="o", ms=4, lw=0))
    joints = [handle(LEG_NAMES[leg], color=colour) for leg, colour in zip(LEGS, style.LEG_COLOURS)]
    joints += [handle(kind.upper(), color="0.3", ls=dash) for kind, dash in zip(KINDS, style.DASHES)]
    figure.legend(handles=joints, loc="lower center", ncols=len(joints), handlelength=2.8)
    options = motion.simulation["options"]
    intervals = sum(phase["intervals"] for phase in motion.fine.json["problem"]["phases"])
    subtitle = (
        f"MuJoCo, sensor noise, state estimator, delay {1e3 * options['delay_s']:g} ms; TVLQR about the plan of "
        f"{intervals} intervals that the certificate passes"
    )
    save(
        style.finish(figure, f"Simulation of {motion.subject.title.lower()}", subtitle, handles, name, bottom=0.25), out
    )
