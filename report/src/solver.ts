import { Chart } from "./chart";
import type { Clock } from "./clock";
import type { ReportData } from "./data";
import { el, short } from "./dom";

/// History of the solver: a line per mesh, and violations per iteration.
export function solver(data: ReportData, clock: Clock): { element: HTMLElement; draw: () => void } {
  const { solver: found, problem, status } = data.plan_json;
  const facts: [string, string][] = [
    ["status", status],
    ["solver", found.name],
    ["problem", `${problem.variables} variables, ${problem.constraints} constraints`],
    ["cost", short(found.cost, 6)],
    ["constraint violation", short(found.constraint_violation)],
    ["dual violation", short(found.dual_violation)],
    ["tolerance", short(found.tolerance)],
    ["time", `${short(found.seconds)} s, ${short(found.cpu_seconds)} s of CPU`],
  ];
  if (found.message) facts.push(["message", found.message]);
  const levels = el(
    "table",
    {},
    el(
      "thead",
      {},
      el(
        "tr",
        {},
        ...["mesh", "intervals", "status", "iterations", "time"].map((name) =>
          el("th", { scope: "col", class: ["intervals", "iterations", "time"].includes(name) ? "number" : "" }, name),
        ),
      ),
    ),
    el(
      "tbody",
      {},
      ...found.levels.map((level, i) =>
        el(
          "tr",
          {},
          el("th", { scope: "row" }, String(i + 1)),
          el("td", { class: "number" }, String(level.intervals)),
          el("td", {}, level.status),
          el("td", { class: "number" }, String(level.iterations)),
          el("td", { class: "number" }, `${short(level.seconds)} s`),
        ),
      ),
    ),
  );
  const charts: Chart[] = [];
  const log = found.convergence;
  if (log && log.iteration.length > 1) {
    const x = log.iteration.map((_, i) => i);
    const positive = (values: (number | null)[]) => values.map((value) => (value !== null && value > 0 ? value : NaN));
    const options = { limits: true, group: "convergence", xLabel: "iteration", height: 150 };
    charts.push(
      new Chart(
        {
          ...options,
          title: "violations over iterations, all meshes",
          unit: "-",
          logarithmic: true,
          lines: [
            { label: "constraints", time: x, values: positive(log.constraint_violation), colour: "plan", width: 1.6 },
            { label: "optimality", time: x, values: positive(log.dual_violation), colour: "simulation", width: 1.6 },
            {
              label: "tolerance",
              time: x,
              values: x.map(() => found.tolerance),
              colour: "limit",
              dash: [4, 3],
              width: 1,
              limit: true,
            },
          ],
        },
        clock,
        [],
      ),
      new Chart(
        {
          ...options,
          title: "cost over iterations",
          unit: "-",
          lines: [
            { label: "cost", time: x, values: log.cost.map((value) => value ?? NaN), colour: "plan", width: 1.6 },
          ],
        },
        clock,
        [],
      ),
    );
  }
  const element = el(
    "section",
    { class: "card", "aria-labelledby": "solver-title" },
    el("h2", { id: "solver-title" }, "Solver"),
    el("dl", { class: "facts" }, ...facts.flatMap(([name, value]) => [el("dt", {}, name), el("dd", {}, value)])),
    el("div", { class: "wide" }, levels),
    charts.length > 0
      ? el(
          "div",
          { class: "legend" },
          el("span", { class: "key plan" }, "constraints"),
          el("span", { class: "key simulation" }, "optimality (dual)"),
          el("span", { class: "key limit dashed" }, "tolerance"),
        )
      : null,
    charts.length > 0 ? el("div", { class: "charts two" }, ...charts.map((chart) => chart.element)) : null,
  );
  return { element, draw: () => charts.forEach((chart) => chart.draw()) };
}
