import type { PlanJson, ReportData, SimulationJson } from "./data";
import { el, short } from "./dom";
import { percent, usedShare } from "./checks";
import { whyNot } from "./verdict";

type One = Pick<ReportData, "directory" | "robot" | "phases" | "plan_json" | "simulation_json">;

const kShares = ["joint torque", "joint velocity"];

const outcome = (run: SimulationJson): string => (run.success ? "succeeded" : "failed");

/// The largest error of a simulation's base.
const centimetres = (run: SimulationJson | null): string =>
  run?.base_position_m.largest == null ? "–" : `${short(100 * run.base_position_m.largest)} cm`;

/// Two plans side by side; null if the page contains one.
export function comparison(data: ReportData): HTMLElement | null {
  if (!data.other) return null;
  const both: One[] = [data, data.other];
  const row = (name: string, value: (one: One) => string) =>
    el("tr", {}, el("th", { scope: "row" }, name), ...both.map((one) => el("td", { class: "number" }, value(one))));
  const isSimulated = both.some((one) => one.simulation_json !== null);
  const worst = (plan: PlanJson, name: string) => plan.certificate.checks.find((check) => check.name === name);
  return el(
    "section",
    { class: "card", "aria-labelledby": "compare-title" },
    el("h2", { id: "compare-title" }, "Two plans"),
    el(
      "table",
      { class: "compare" },
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          el("td", {}),
          el("th", { scope: "col", class: "number" }, el("span", { class: "key plan" }, both[0].directory)),
          el("th", { scope: "col", class: "number" }, el("span", { class: "key second" }, both[1].directory)),
        ),
      ),
      el(
        "tbody",
        {},
        row("task", (one) => `${one.robot} ${one.plan_json.name}`),
        row("result", (one) => whyNot(one.plan_json) || `passed, ${one.plan_json.certificate.grade}`),
        row("motion", (one) => `${short(one.phases.at(-1)?.end)} s`),
        row("mesh", (one) => `${one.phases.reduce((sum, phase) => sum + phase.intervals, 0)} intervals`),
        row("cost", (one) => short(one.plan_json.solver.cost, 5)),
        row("solver", (one) => one.plan_json.solver.name),
        row("iterations", (one) => String(one.plan_json.solver.iterations)),
        row("solved in", (one) => `${short(one.plan_json.solver.seconds)} s`),
        ...kShares.map((name) =>
          row(`largest ${name}`, (one) => {
            const check = worst(one.plan_json, name);
            return check ? `${percent(usedShare(check))} of limit, ${check.where}` : "–";
          }),
        ),
        row("local integration error", (one) => short(worst(one.plan_json, "local integration error")?.worst)),
        isSimulated ? row("simulation", ({ simulation_json: run }) => (run ? outcome(run) : "none")) : null,
        isSimulated ? row("largest base error", ({ simulation_json: run }) => centimetres(run)) : null,
      ),
    ),
    el(
      "p",
      { class: "hint" },
      "Plots, view and time line show the first plan; the second is a line, a robot and arrows in its colour. The robot of its simulation is not drawn.",
    ),
  );
}
