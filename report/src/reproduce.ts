import type { ReportData, TextFile } from "./data";
import { el, short } from "./dom";

/// How the simulation went, in words and figures; nothing if there was none.
export function simulation(data: ReportData): HTMLElement | null {
  const found = data.simulation_json;
  if (!found) return null;
  const degrees = (angle: number) => `${short((angle * 180) / Math.PI)}°`;
  const slips = Object.entries(found.slip_m ?? {}).map(([name, slip]) => `${name} ${short(1000 * slip, 2)} mm`);
  const error = (name: string, of: { largest: number; rms: number; rest: number }, text: (value: number) => string) =>
    el("tr", {}, el("th", { scope: "row" }, name), ...[of.largest, of.rms, of.rest].map((value) => el("td", { class: "number" }, text(value))));
  return el(
    "section",
    { class: "card", "aria-labelledby": "simulation-title" },
    el("h2", { id: "simulation-title" }, "Simulation ", el("small", {}, found.success ? "success" : `failed: ${found.failures.join("; ")}`)),
    el(
      "div", { class: "wide" },
      el("table", {},
        el("thead", {}, el("tr", {}, ...["error", "largest", "RMS", "in rest"].map((name) => el("th", { scope: "col", class: name === "error" ? "" : "number" }, name)))),
        el("tbody", {},
          error("base position", found.base_position_m, (value) => `${short(100 * value)} cm`),
          error("base orientation", found.base_angle_rad, degrees),
          error("worst joint", found.joints_rad, degrees))),
    ),
    el("dl", { class: "facts" },
      el("dt", {}, "slip"), el("dd", {}, slips.join(", ")),
      el("dt", {}, "torque"), el("dd", {}, `${short(100 * found.torque.largest_share)} % of the limit at most (${found.torque.joint}), ${short(found.torque.positive_work_J)} J of work`),
      el("dt", {}, "engine"), el("dd", {}, Object.entries(found.versions).map(([name, version]) => `${name} ${version}`).join(", "))),
  );
}

/// Everything that it takes to make the plan again.
export function reproduce(data: ReportData): HTMLElement {
  const { versions, task_file, robot_file, urdf, overrides } = data.plan_json;
  const commands = [data.command];
  if (data.simulation_json) commands.push(`prowl simulate DIR  # seed ${data.simulation_json.options["seed"] ?? "1"}`);
  const options = data.simulation_json ? file({ path: "options of the simulation", text: JSON.stringify(data.simulation_json.options, null, 2) }) : null;
  return el(
    "section",
    { class: "card", "aria-labelledby": "reproduce-title" },
    el("h2", { id: "reproduce-title" }, "Reproduce"),
    el("pre", { class: "commands", tabindex: "0" }, commands.join("\n")),
    el("p", { class: "hint" }, `Same versions, same plan. Folder: ${data.directory}. Changed on the command line: ${Object.entries(overrides).map(([name, value]) => `${name} = ${value}`).join(", ") || "nothing"}.`),
    el("dl", { class: "facts" }, ...Object.entries(versions).flatMap(([name, version]) => [el("dt", {}, name), el("dd", {}, version)])),
    file(task_file),
    file(robot_file),
    file(urdf),
    options,
  );
}

function file(source: TextFile): HTMLElement {
  const lines = source.text.split("\n").length;
  return el(
    "details", {},
    el("summary", {}, source.path, " ", el("small", {}, `${lines} lines`)),
    el("pre", { tabindex: "0" }, source.text),
  );
}
