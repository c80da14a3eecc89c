import type { ReportData } from "./data";
import { el, short } from "./dom";
import type { ThemeSwitch } from "./theme";
import { kGrades, whyNot } from "./verdict";

function badge(data: ReportData): HTMLElement {
  const { certificate: found, good } = data.plan_json;
  if (data.live?.solved === false) return el("span", { class: "badge" }, "… solving");
  if (!good) return el("span", { class: "badge bad" }, `✗ no plan: ${whyNot(data.plan_json)}`);
  return el("span", { class: "badge good", title: kGrades[found.grade] }, `✓ passed · ${found.grade}`);
}

/// Motion and solve in one line.
function summary(data: ReportData): string {
  const { good, solver: solved } = data.plan_json;
  const intervals = data.phases.reduce((sum, phase) => sum + phase.intervals, 0);
  const parts = [
    `motion ${short(data.phases.at(-1)?.end ?? 0)} s`,
    `${data.phases.length} ${data.phases.length === 1 ? "phase" : "phases"}`,
    `${intervals} intervals`,
  ];
  if (data.live?.solved === false) parts.push(solved.name);
  else
    parts.push(
      `${good ? "solved" : "stopped"} in ${short(solved.seconds)} s by ${solved.name}, ${solved.iterations} iterations`,
    );
  return parts.join(" · ");
}

export function header(data: ReportData, theme: ThemeSwitch, help: () => void): HTMLElement {
  const helpButton = el("button", { type: "button", "aria-label": "Keys" }, "?");
  helpButton.addEventListener("click", help);
  return el(
    "header",
    {},
    el("h1", {}, el("span", { class: "robot" }, data.robot), " ", data.plan_json.name),
    badge(data),
    el("span", { class: "summary" }, summary(data)),
    el("span", { class: "spacer" }),
    helpButton,
    theme.button,
  );
}
