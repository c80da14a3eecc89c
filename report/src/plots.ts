import { Chart, type Line } from "./chart";
import type { Clock } from "./clock";
import { type ChartData, floats, type ReportData, type SeriesData } from "./data";
import { el } from "./dom";

interface Tab {
  name: string;
  legend: [string, string, boolean][]; // text, colour, dashed
  limits: boolean;
  charts: (options: { limits: boolean; group: string }) => Chart[];
  head?: HTMLElement;
  wide?: boolean; // for long titles or many values
}

const kOther = "other plan";
const kOtherSimulation = "other simulation";
const kBand = "band of the tube";
const kNeeded = "needed by the tube";
const kTube = "Tube"; // of one plan: another has its own
const kAxes = ["x", "y", "z"];
const kAxisColours = ["axis-x", "axis-y", "axis-z"];

/// The series of one joint or contact, in a separate tab.
export interface Picked {
  name: string;
  isOfIt: (tab: string, chart: string) => boolean;
}

/// All plots, one tab per kind, created when first shown.
export class Plots {
  readonly element: HTMLElement;
  private tabs: Tab[];
  private buttons: HTMLButtonElement[] = [];
  private readonly list = el("div", { class: "tabs", role: "tablist", "aria-label": "Plots" });
  private readonly panel = el("div", { class: "charts", role: "tabpanel", id: "plots-panel", tabindex: "0" });
  private readonly legend = el("div", { class: "legend" });
  private readonly limits = el("input", { type: "checkbox", id: "plots-limits" });
  private times: Record<SeriesData["time"], number[]>;
  private charts: Chart[] = [];
  private chosen = 0;
  private picked: Picked | null = null;

  constructor(
    private readonly data: ReportData,
    private readonly clock: Clock,
  ) {
    this.times = this.timesOfData();
    this.tabs = this.tabsOfData();
    this.makeButtons();
    this.limits.addEventListener("change", () => {
      this.tabs[this.chosen].limits = this.limits.checked;
      for (const chart of this.charts) chart.showLimits(this.limits.checked);
    });
    this.element = el(
      "section",
      { class: "card plots", "aria-label": "Plots" },
      this.list,
      el(
        "div",
        { class: "bar-under" },
        this.legend,
        el("label", { class: "limits", for: "plots-limits" }, this.limits, " limits"),
      ),
      this.panel,
      el(
        "p",
        { class: "hint" },
        "Time in seconds. Click in a plot to go to that time, drag to zoom, double-click to reset. Click a title to enlarge its plot.",
      ),
    );
    clock.onChange(() => this.charts.forEach((chart) => chart.update()));
    new ResizeObserver(() => this.charts.forEach((chart) => chart.resize())).observe(this.panel);
  }

  /// Name of the current tab.
  get tab(): string {
    return this.tabs[this.chosen].name;
  }
  chooseNamed(name: string): void {
    const index = this.tabs.findIndex((tab) => tab.name === name);
    if (index >= 0) this.choose(index);
  }
  /// Shows the series of a joint or contact in an additional tab.
  pick(picked: Picked): void {
    this.picked = picked;
    this.tabs = this.tabsOfData();
    this.makeButtons();
    this.choose(this.tabs.length - 1);
  }
  /// Called when another tab is chosen.
  onChoose: () => void = () => undefined;

  choose(index: number): void {
    this.chosen = index;
    const tab = this.tabs[index];
    this.buttons.forEach((button, i) => {
      button.setAttribute("aria-selected", String(i === index));
      button.tabIndex = i === index ? 0 : -1;
    });
    this.panel.setAttribute("aria-labelledby", `tab-${index}`);
    this.limits.checked = tab.limits;
    this.limits.parentElement!.hidden = !tab.legend.some(([text]) => text === "limit");
    this.panel.classList.toggle("two", tab.wide === true);
    this.legend.replaceChildren(
      ...tab.legend.map(([text, name, dashed]) => el("span", { class: `key ${name}${dashed ? " dashed" : ""}` }, text)),
    );
    this.charts = tab.charts({ limits: tab.limits, group: tab.name });
    this.panel.replaceChildren(...(tab.head ? [tab.head] : []), ...this.charts.map((chart) => chart.element));
    this.draw();
    this.onChoose();
  }
  /// Plots the current data: the same tabs for another motion.
  setData(): void {
    const limits = this.tabs.map((tab) => tab.limits);
    this.times = this.timesOfData();
    this.tabs = this.tabsOfData();
    this.tabs.forEach((tab, i) => (tab.limits = limits[i] ?? tab.limits));
    const large = this.charts.map((chart) => chart.large);
    this.choose(Math.min(this.chosen, this.tabs.length - 1));
    this.charts.forEach((chart, i) => large[i] && chart.enlarge(true));
  }
  /// Redraws, in the colours of the theme.
  draw(): void {
    for (const chart of this.charts) chart.draw();
  }

  private makeButtons(): void {
    this.buttons = this.tabs.map((tab, i) => {
      const button = el(
        "button",
        { type: "button", role: "tab", id: `tab-${i}`, "aria-controls": "plots-panel" },
        tab.name,
      );
      button.addEventListener("click", (event) => {
        this.choose(i);
        if (event.detail > 0) button.blur(); // by a pointer: arrow keys keep moving in time
      });
      button.addEventListener("keydown", (event) => this.move(event, i));
      return button;
    });
    this.list.replaceChildren(...this.buttons);
  }
  private move(event: KeyboardEvent, from: number): void {
    const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const to = (from + by + this.tabs.length) % this.tabs.length;
    this.choose(to);
    this.buttons[to].focus();
  }

  private timesOfData(): Record<SeriesData["time"], number[]> {
    const { plan, simulation, other } = this.data;
    return {
      plan: plan.time,
      simulation: simulation?.time ?? [],
      other: other?.plan.time ?? [],
      "other-simulation": other?.simulation?.time ?? [],
    };
  }
  private tabsOfData(): Tab[] {
    const all = this.data.charts.map((tab) => ({
      name: tab.name,
      charts: tab.charts.map((chart) => this.withOther(tab.name, chart)),
    }));
    const tabs = all.map((tab) => this.fromData(tab));
    if (this.data.gains) tabs.push(this.gains(this.data.gains));
    if (this.picked) {
      const { name, isOfIt } = this.picked;
      const charts = all.flatMap((tab) =>
        tab.charts
          .filter((chart) => isOfIt(tab.name, chart.title))
          .map((chart) => ({ ...chart, title: `${tab.name}: ${chart.title}` })),
      );
      tabs.push({ ...this.fromData({ name, charts }), wide: true });
    }
    return tabs;
  }
  /// A chart with the series of the other plan and its simulation, if that has the same chart.
  private withOther(tab: string, chart: ChartData): ChartData {
    if (tab === kTube) return chart;
    const same = this.data.other?.charts
      .find((one) => one.name === tab)
      ?.charts.find((one) => one.title === chart.title && one.unit === chart.unit);
    const other = (one: SeriesData): SeriesData[] => {
      if (one.style === "plan") return [{ ...one, label: kOther, style: "other", time: "other" }];
      if (one.style !== "simulation") return [];
      return [{ ...one, label: kOtherSimulation, style: "other-simulation", time: "other-simulation" }];
    };
    return { ...chart, series: [...chart.series, ...(same?.series.flatMap(other) ?? [])] };
  }
  private fromData(tab: ReportData["charts"][number]): Tab {
    const styles = new Set(tab.charts.flatMap((chart) => chart.series.map((series) => series.style)));
    const legend: Tab["legend"] = [];
    if (styles.has("plan")) legend.push(["plan", "plan", false]);
    if (styles.has("other")) legend.push([kOther, "second", false]);
    if (styles.has("simulation")) legend.push(["simulation", "simulation", false]);
    if (styles.has("other-simulation")) legend.push([kOtherSimulation, "second", true]);
    if (styles.has("limit")) legend.push(["limit", "limit", true]);
    if (styles.has("band")) legend.push([kBand, "limit", true]);
    if (styles.has("needed")) legend.push([kNeeded, "second", true]);
    // In this order one lies over the other, and values stand side by side: the plan is a broad line below the rest.
    const order = { limit: 0, band: 0, needed: 0, plan: 1, other: 2, simulation: 3, "other-simulation": 4 };
    const isAlone = !styles.has("other") && !styles.has("simulation");
    const widths = {
      limit: 1,
      band: 1,
      needed: 1,
      plan: isAlone ? 1.5 : 3,
      other: 1.5,
      simulation: 1.2,
      "other-simulation": 1.2,
    };
    const dashes = new Map([
      ["limit", [4, 3]],
      ["band", [4, 3]],
      ["needed", [4, 3]],
      ["other-simulation", [2, 2]],
    ]);
    const colours = new Map([
      ["band", "limit"],
      ["needed", "second"],
      ["other", "second"],
      ["other-simulation", "second"],
    ]);
    const lines = (all: SeriesData[]): Line[] =>
      [...all]
        .sort((a, b) => order[a.style] - order[b.style])
        .map((series) => ({
          label: series.label,
          time: this.times[series.time],
          values: floats(series.values),
          colour: colours.get(series.style) ?? series.style,
          dash: dashes.get(series.style),
          width: widths[series.style],
          limit: series.style === "limit",
        }));
    return {
      name: tab.name,
      legend,
      wide: ["Margins", kTube].includes(tab.name),
      limits: tab.name !== "Rates",
      charts: (options) =>
        tab.charts.map(
          (chart) =>
            new Chart(
              { ...options, title: chart.title, unit: chart.unit, lines: lines(chart.series) },
              this.clock,
              this.data.phases,
            ),
        ),
    };
  }

  /// Rows of K(t) of the chosen joint.
  private gains(gains: NonNullable<ReportData["gains"]>): Tab {
    const values = floats(gains.values);
    const { joints } = this.data;
    const nv = 6 + joints.length;
    const row = 2 * nv;
    const select = el(
      "select",
      { id: "gains-joint" },
      ...joints.map((name, j) => el("option", { value: String(j) }, name)),
    );
    const knee = joints.findIndex((name) => /kfe|knee|calf/i.test(name));
    select.value = String(Math.max(knee, 0));
    select.addEventListener("change", () => this.choose(this.chosen));
    const line = (column: number, label: string, name: string): Line => ({
      label,
      time: gains.time,
      values: gains.time.map((_, i) => values[(i * joints.length + Number(select.value)) * row + column]),
      colour: name,
      width: 1.3,
    });
    const axes = (first: number) => kAxes.map((axis, i) => line(first + i, axis, kAxisColours[i]));
    const own = (first: number): Line[] =>
      joints.map((name, j) =>
        j === Number(select.value) ? line(first + j, name, "head") : { ...line(first + j, name, "other"), quiet: true },
      );
    const groups = (): [string, string, Line[]][] => [
      ["on base position", "N m/m", axes(0)],
      ["on base orientation", "N m/rad", axes(3)],
      ["on joint positions", "N m/rad", own(6)],
      ["on base velocity", "N m s/m", axes(nv)],
      ["on base angular velocity", "N m s/rad", axes(nv + 3)],
      ["on joint rates", "N m s/rad", own(nv + 6)],
    ];
    return {
      name: "Gains",
      wide: true,
      limits: false,
      legend: [
        ["x", "axis-x", false],
        ["y", "axis-y", false],
        ["z", "axis-z", false],
        ["the joint itself", "head", false],
        ["other joints", "other", false],
      ],
      head: el("label", { class: "choice", for: "gains-joint" }, "Feedback on the torque of ", select),
      charts: (options) =>
        groups().map(
          ([title, unit, lines]) =>
            new Chart(
              {
                ...options,
                title,
                unit,
                lines: [...lines].sort((a, b) => Number(b.quiet ?? false) - Number(a.quiet ?? false)),
              },
              this.clock,
              this.data.phases,
            ),
        ),
    };
  }
}
