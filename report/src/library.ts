// The page of `prowl library`: motions by outcome, and how far they are from their limits.
import "uplot/dist/uPlot.min.css";
import "./style.css";
import "./library.css";
import { Chart, type Line } from "./chart";
import { Clock } from "./clock";
import { el, short } from "./dom";
import { ThemeSwitch } from "./theme";

/// Counts of motions between edges, one less than these.
interface Histogram {
  name: string;
  unit: string;
  edges: number[];
  counts: Record<string, number[]>; // by series
}
interface LibraryData {
  name: string;
  robot: string;
  asked: number;
  done: number;
  kept: number;
  outcomes: { name: string; kept: boolean; count: number; motions: number[]; diagnosis: string }[];
  margins: Histogram[]; // of motions that are kept: checks of the certificate
  far: string[]; // checks of which no motion uses a thousandth of the limit
  draws: Histogram[]; // kept and failed over each value that was drawn
}

const kColours: Record<string, string> = { kept: "plan", failed: "simulation" };

/// A histogram as stairs from zero to zero.
function stairs({ edges, counts }: Histogram, series: string): Line {
  return {
    label: series,
    time: [edges[0], ...edges, edges[edges.length - 1]],
    values: [0, ...counts[series], counts[series].at(-1)!, 0],
    colour: kColours[series],
    steps: true,
    width: 1.8,
  };
}

const clock = new Clock(0); // charts of a report need one

function histograms(title: string, about: string, all: Histogram[]): { element: HTMLElement; charts: Chart[] } {
  const charts = all.map(
    (one) =>
      new Chart(
        {
          title: one.unit && one.unit !== "-" ? `${one.name} [${one.unit}]` : one.name,
          unit: "-",
          lines: Object.keys(one.counts).map((series) => stairs(one, series)),
          limits: true,
          group: one.name,
          xLabel: one.name,
        },
        clock,
        [],
      ),
  );
  return {
    charts,
    element: el(
      "section",
      { class: "card" },
      el("h2", {}, title),
      el("p", { class: "hint" }, about),
      el("div", { class: "histograms" }, ...charts.map((chart) => chart.element)),
    ),
  };
}

function outcomes(data: LibraryData): HTMLElement {
  const row = ({ name, kept, count, motions, diagnosis }: LibraryData["outcomes"][number]) =>
    el(
      "tr",
      {},
      el("td", { class: kept ? "kept" : "failed" }, kept ? `kept: ${name}` : name),
      el("td", { class: "number" }, String(count)),
      el("td", { class: "number" }, `${short((100 * count) / data.done, 3)} %`),
      el("td", {}, motions.join(", ") + (motions.length < count ? ", …" : "")),
      el("td", {}, diagnosis),
    );
  return el(
    "section",
    { class: "card" },
    el("h2", {}, "Outcomes"),
    el(
      "table",
      { class: "outcomes" },
      el(
        "thead",
        {},
        el(
          "tr",
          {},
          ...["outcome", "motions", "share", "first indices", "of the first"].map((name) =>
            el("th", { scope: "col" }, name),
          ),
        ),
      ),
      el("tbody", {}, ...data.outcomes.map(row)),
    ),
    el(
      "p",
      { class: "hint" },
      "A motion in the report: prowl library LIB --motion INDEX --out DIR, then prowl report DIR.",
    ),
  );
}

function start(): void {
  const data = JSON.parse(document.getElementById("prowl-data")!.textContent!) as LibraryData;
  document.title = `${data.robot} ${data.name}, ${data.kept} motions – Prowl`;
  let redraw: () => void = () => undefined;
  const theme = new ThemeSwitch(() => redraw());
  const facts = `${data.asked} motions asked, ${data.done} done, ${data.kept} kept`;
  const margins = histograms(
    "Margins",
    "Motions that are kept, by the worst value of each check: over its limit, or below zero as the distance that is left." +
      (data.far.length > 0 ? ` Below a thousandth of their limits: ${data.far.join(", ")}.` : ""),
    data.margins,
  );
  const draws = histograms("Drawn values", "Motions over each value: kept, and failed.", data.draws);
  document.body.classList.add("library");
  document.body.append(
    el(
      "header",
      {},
      el("h1", {}, el("span", { class: "robot" }, data.robot), ` ${data.name}`),
      el("small", {}, facts),
      theme.button,
    ),
    el("main", {}, outcomes(data), draws.element, margins.element),
  );
  const charts = [...draws.charts, ...margins.charts];
  redraw = () => charts.forEach((chart) => chart.draw());
  redraw();
  addEventListener("resize", () => charts.forEach((chart) => chart.resize()));
}

start();
