import { Chart } from "./chart";
import type { Clock } from "./clock";
import type { Check, ReportData } from "./data";
import { barLength, groupOf, kGroups, mergedByContact, percent, unitOf, usedShare, worstText } from "./checks";
import { el, short } from "./dom";
import { failedChecks, kGrades } from "./verdict";

const kDraft = 1e-4; // CertificateLimits of prowl/certificate/certificate.hpp
const kCertified = 1e-6;

/// Checks of the finished plan in groups; a click on one goes to its worst moment.
export function certificate(
  data: ReportData,
  clock: Clock,
  goTo: (time: number) => void,
): { element: HTMLElement; draw: () => void } {
  const { certificate: found, reasons, hints } = data.plan_json;
  const groups = kGroups
    .map(([name]) => ({ name, checks: found.checks.filter((check) => groupOf(check) === name) }))
    .filter(({ checks }) => checks.length > 0);
  const table = el(
    "table",
    { class: "checks" },
    el(
      "thead",
      {},
      el(
        "tr",
        {},
        ...["verdict", "check", "worst", "limit", "used", "time", "where"].map((name) =>
          el("th", { scope: "col", class: ["worst", "limit", "used", "time"].includes(name) ? "number" : "" }, name),
        ),
      ),
    ),
    ...groups.map(({ name, checks }) =>
      el(
        "tbody",
        {},
        el("tr", { class: "group" }, el("th", { scope: "rowgroup", colspan: "7" }, name)),
        ...checks.map((check) => row(check, data, goTo)),
      ),
    ),
  );
  const failed = failedChecks(data.plan_json).length;
  const notes: HTMLElement[] = [];
  const names = data.scene.contacts.map((contact) => contact.name);
  for (const text of mergedByContact([...reasons, ...hints], names)) notes.push(el("li", {}, text));
  if (found.redundant_contacts.length > 0) {
    notes.push(
      el(
        "li",
        {},
        `Forces of ${found.redundant_contacts.join(", ")} are not unique: the motion does not determine them.`,
      ),
    );
  }
  const errors = found.integration_errors;
  const limitLine = (label: string, value: number, dash: number[]) => ({
    label,
    time: [errors[0].start_s, errors[errors.length - 1].end_s],
    values: [value, value],
    colour: "limit",
    dash,
    width: 1,
    limit: true,
  });
  const chart =
    errors.length === 0
      ? null
      : new Chart(
          {
            title: "local integration error of each mesh interval",
            unit: "-",
            logarithmic: true,
            limits: true,
            group: "errors",
            height: 130,
            lines: [
              limitLine("draft", kDraft, [4, 3]),
              limitLine("certified", kCertified, [1, 3]),
              {
                label: "error",
                colour: "plan",
                steps: true,
                time: [...errors.map((e) => e.start_s), errors[errors.length - 1].end_s],
                values: [...errors.map((e) => e.error ?? NaN), errors[errors.length - 1].error ?? NaN].map((e) =>
                  Math.max(e, 1e-16),
                ),
              },
            ],
          },
          clock,
          data.phases,
        );
  const element = el(
    "section",
    { class: "card", "aria-labelledby": "certificate-title" },
    el(
      "h2",
      { id: "certificate-title" },
      "Certificate ",
      el(
        "small",
        {},
        found.passed ? `passed, grade ${found.grade}` : `${failed} of ${found.checks.length} checks failed`,
      ),
    ),
    found.passed
      ? el(
          "p",
          { class: "grade" },
          `${sentence(kGrades[found.grade])}.`,
          found.grade === "draft" ? ` ${sentence(kGrades.certified)}.` : null,
        )
      : null,
    el(
      "p",
      { class: "hint" },
      "Computed from the finished motion by separate code for dynamics and integration. A check passes if its worst value is at most its limit; “left” is the remaining margin. The bar is logarithmic, from a millionth of the limit to the limit. Click a row to go to its worst moment.",
    ),
    notes.length > 0 ? el("ul", { class: "notes" }, ...notes) : null,
    el("div", { class: "wide" }, table),
    chart?.element,
    chart
      ? el(
          "p",
          { class: "hint" },
          "Dashed: limit of grade draft; dotted: limit of grade certified. The error falls with the cube of the step.",
        )
      : null,
  );
  if (chart) clock.onChange(() => chart.update());
  return { element, draw: () => chart?.draw() };
}

const sentence = (text: string): string => text[0].toUpperCase() + text.slice(1);

function row(check: Check, data: ReportData, goTo: (time: number) => void): HTMLElement {
  const unit = unitOf(check, data);
  const share = usedShare(check);
  const bar = el("span", { class: check.passed ? "used" : "used over" });
  bar.style.setProperty("--share", String(barLength(share ?? (check.passed ? 0 : 1))));
  const time = check.time_s;
  const seek =
    time === null
      ? null
      : el(
          "button",
          { type: "button", class: "seek", title: `Go to the worst moment of: ${check.name}` },
          `${time.toFixed(3)} s`,
        );
  const line = el(
    "tr",
    { class: check.passed ? "" : "failed", "data-check": check.name },
    el("td", { class: "verdict", title: check.passed ? kGrades[gradeOf(check)] : false }, verdict(check)),
    el("th", { scope: "row" }, check.name),
    el("td", { class: "number worst" }, worstText(check, unit)),
    el("td", { class: "number limit" }, `${short(check.limit)}${unit ? ` ${unit}` : ""}`),
    el("td", { class: "number share" }, el("span", { class: "percent" }, percent(share)), bar),
    el("td", { class: "number time" }, seek),
    el("td", { class: "where" }, check.where),
  );
  if (time !== null) line.addEventListener("click", () => goTo(time));
  return line;
}

const gradeOf = (check: Check): "certified" | "draft" =>
  check.worst !== null && check.certified_limit !== null && check.worst <= check.certified_limit
    ? "certified"
    : "draft";

function verdict(check: Check): string {
  if (!check.passed) return "✗ fail";
  return gradeOf(check) === "certified" ? "✓ pass" : "✓ draft";
}
