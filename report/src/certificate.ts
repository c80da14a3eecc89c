import { Chart } from "./chart";
import type { Clock } from "./clock";
import type { Check, ReportData } from "./data";
import { el, short } from "./dom";

const kDraft = 1e-4; // CertificateLimits of prowl/certificate/certificate.hpp
const kCertified = 1e-6;

/// The checks of the finished plan; each goes to its worst moment.
export function certificate(
  data: ReportData,
  clock: Clock,
  goTo: (time: number) => void,
): { element: HTMLElement; draw: () => void } {
  const { certificate: found, reasons, hints } = data.plan_json;
  const rows = found.checks.map((check) => row(check, goTo));
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
          el("th", { scope: "col", class: ["worst", "limit", "time"].includes(name) ? "number" : "" }, name),
        ),
      ),
    ),
    el("tbody", {}, ...rows),
  );
  const notes: HTMLElement[] = [];
  for (const text of [...reasons, ...hints]) notes.push(el("li", {}, text));
  if (found.redundant_contacts.length > 0) {
    notes.push(
      el(
        "li",
        {},
        `Forces of ${found.redundant_contacts.join(", ")} are one choice of many: the motion does not tell them.`,
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
      el("small", {}, `${found.passed ? "passed" : "failed"}, grade: ${found.grade}`),
    ),
    el(
      "p",
      { class: "hint" },
      "Judged from the finished motion alone, by other code than planned it. A check passes if worst ≤ limit; a negative worst is what is left to the bound. A row goes to the worst moment.",
    ),
    notes.length > 0 ? el("ul", { class: "notes" }, ...notes) : null,
    el("div", { class: "wide" }, table),
    chart?.element,
    chart
      ? el(
          "p",
          { class: "hint" },
          "Dashed: limit of grade draft, dotted: of grade certified. It falls with the cube of the step.",
        )
      : null,
  );
  if (chart) clock.onChange(() => chart.update());
  return { element, draw: () => chart?.draw() };
}

function row(check: Check, goTo: (time: number) => void): HTMLElement {
  const unit = check.unit === "-" || check.unit === "" ? "" : ` ${check.unit.replace("^2", "²")}`;
  const share = check.worst === null || check.limit === null || check.limit === 0 ? null : check.worst / check.limit;
  const bar = el("span", { class: check.passed ? "used" : "used over" });
  bar.style.setProperty("--share", String(Math.min(Math.max(share ?? (check.passed ? 0 : 1), 0), 1)));
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
    el("td", { class: "verdict" }, verdict(check)),
    el("th", { scope: "row" }, check.name),
    el("td", { class: "number worst" }, `${short(check.worst)}${unit}`),
    el("td", { class: "number limit" }, `${short(check.limit)}${unit}`),
    el("td", { class: "share", title: share === null ? false : `${short(100 * share)} % of the limit` }, bar),
    el("td", { class: "number time" }, seek),
    el("td", { class: "where" }, check.where),
  );
  if (time !== null) line.addEventListener("click", () => goTo(time));
  return line;
}

function verdict(check: Check): string {
  if (!check.passed) return "✗ fail";
  const certified = check.worst !== null && check.certified_limit !== null && check.worst <= check.certified_limit;
  return certified ? "✓ pass" : "✓ draft";
}
