import type { ReportData, SimulationError, SimulationJson, TextFile } from "./data";
import { el, short } from "./dom";

/// Results of the simulation; null without one.
export function simulation(data: ReportData): HTMLElement | null {
  const found = data.simulation_json;
  if (!found) return null;
  const degrees = (angle: number | null) => (angle === null ? "–" : `${short((angle * 180) / Math.PI)}°`);
  const slips = Object.entries(found.slip_m ?? {}).map(([name, slip]) => `${name} ${short(1000 * slip, 2)} mm`);
  const engine =
    found.engine === "rollout"
      ? "rollout of the planned dynamics"
      : Object.entries(found.versions ?? {})
          .map(([name, version]) => `${name} ${version}`)
          .join(", ");
  // Contacts of a rollout hold for any force.
  const pulling = Object.entries(found.contacts ?? {}).filter(
    ([, load]) => load.least_normal_force_N !== null && load.least_normal_force_N < 0,
  );
  const loads = found.contacts
    ? [
        el("dt", {}, "contacts"),
        el(
          "dd",
          {},
          pulling.length > 0
            ? pulling.map(([name, load]) => `${name} pulls, ${short(-load.least_normal_force_N!)} N`).join(", ")
            : "none pulls",
        ),
      ]
    : [];
  const error = (name: string, of: SimulationError, text: (value: number | null) => string) =>
    el(
      "tr",
      {},
      el("th", { scope: "row" }, name),
      ...[of.largest, of.rms, of.rest].map((value) => el("td", { class: "number" }, text(value))),
    );
  return el(
    "section",
    { class: "card", "aria-labelledby": "simulation-title" },
    el(
      "h2",
      { id: "simulation-title" },
      "Simulation ",
      el("small", {}, found.success ? "succeeded" : `failed: ${found.failures.join("; ")}`),
    ),
    el(
      "div",
      { class: "wide" },
      el(
        "table",
        {},
        el(
          "thead",
          {},
          el(
            "tr",
            {},
            ...["error", "largest", "RMS", "at rest"].map((name) =>
              el("th", { scope: "col", class: name === "error" ? "" : "number" }, name),
            ),
          ),
        ),
        el(
          "tbody",
          {},
          error("base position", found.base_position_m, (value) => (value === null ? "–" : `${short(100 * value)} cm`)),
          error("base orientation", found.base_angle_rad, degrees),
          error("worst joint", found.joints_rad, degrees),
        ),
      ),
    ),
    el(
      "dl",
      { class: "facts" },
      ...(slips.length > 0 ? [el("dt", {}, "slip"), el("dd", {}, slips.join(", "))] : []),
      ...loads,
      el("dt", {}, "torque"),
      el(
        "dd",
        {},
        `${short(100 * found.torque.largest_share)} % of the limit at most (${found.torque.joint}), ${short(found.torque.positive_work_J)} J of work`,
      ),
      el("dt", {}, "engine"),
      el("dd", {}, engine),
    ),
  );
}

/// The command, without options at their defaults.
function simulateCommand(directory: string, found: SimulationJson, taskFriction: number | null): string {
  const { options } = found;
  const words = [
    "prowl simulate",
    /^[\w./-]+$/.test(directory) ? directory : `'${directory.replaceAll("'", "'\\''")}'`,
  ];
  const add = (flag: string, value: unknown, usual: unknown) => {
    if (value !== usual && value !== undefined && value !== null)
      words.push(value === true ? flag : `${flag} ${value}`);
  };
  add("--open-loop", options.open_loop, false);
  if (found.engine === "rollout") {
    words.push("--engine rollout");
    add("--control-rate", options.control_rate_Hz || null, null);
    const offset = (flag: string, value: number[] | undefined) =>
      value?.some((x) => x !== 0) && words.push(`${flag} ${value.join(" ")}`);
    offset("--base-offset-m", options.base_offset_m);
    offset("--base-offset-rad", options.base_offset_rad);
    return words.join(" ");
  }
  add("--perfect-state", options.perfect_state, false);
  add("--noise", options.noise.scale, 1);
  add("--delay", Number((1000 * options.delay_s).toPrecision(6)), 2);
  add("--bandwidth", options.bandwidth_Hz, 0);
  add("--control-rate", options.control_rate_Hz, 1000);
  add("--mass", options.mass_scale, 1);
  add("--friction", options.friction, taskFriction);
  for (const push of options.pushes) words.push(`--push ${push.time_s} ${push.impulse_Ns.join(" ")}`);
  const duration = options.pushes[0]?.duration_s;
  add("--push-duration", duration, 0.1);
  add("--step", options.step_s, 0.0005);
  add("--seed", options.seed, 1);
  return words.join(" ");
}

/// Everything needed to reproduce the plan.
export function reproduce(data: ReportData): HTMLElement {
  const { versions, task_file, robot_file, urdf, overrides } = data.plan_json;
  const commands = [data.command];
  if (data.simulation_json)
    commands.push(simulateCommand(data.directory, data.simulation_json, data.simulated_friction));
  const options = data.simulation_json
    ? file({ path: "options of the simulation", text: JSON.stringify(data.simulation_json.options, null, 2) })
    : null;
  return el(
    "section",
    { class: "card", "aria-labelledby": "reproduce-title" },
    el("h2", { id: "reproduce-title" }, "Reproduce"),
    el("pre", { class: "commands", tabindex: "0" }, commands.join("\n")),
    el(
      "p",
      { class: "hint" },
      `Same versions, same plan. ${data.directory ? `Folder: ${data.directory}. ` : ""}Changed on the command line: ${
        Object.entries(overrides)
          .map(([name, value]) => `${name} = ${value}`)
          .join(", ") || "nothing"
      }.`,
    ),
    el(
      "dl",
      { class: "facts" },
      ...Object.entries(versions).flatMap(([name, version]) => [el("dt", {}, name), el("dd", {}, version)]),
    ),
    file(task_file),
    file(robot_file),
    file(urdf),
    options,
  );
}

function file(source: TextFile): HTMLElement {
  const lines = source.text.split("\n").length;
  return el(
    "details",
    {},
    el("summary", {}, source.path, " ", el("small", {}, `${lines} lines`)),
    el("pre", { tabindex: "0" }, source.text),
  );
}
