import uPlot from "uplot";
import type { Clock } from "./clock";
import type { Phase } from "./data";
import { colour, el, short } from "./dom";
import { sampleAt } from "./motion";

export interface Line {
  label: string;
  time: ArrayLike<number>;
  values: ArrayLike<number>;
  colour: string; // name of a theme colour
  dash?: number[];
  width?: number;
  limit?: boolean; // not in the readout; can be switched off
  quiet?: boolean; // not in the readout
  steps?: boolean; // piecewise constant
}

export interface ChartOptions {
  title: string;
  unit: string;
  lines: Line[];
  logarithmic?: boolean;
  height?: number;
  limits: boolean; // show them
  group: string; // charts of one group share cursor and zoom
  resized?: () => void; // called when the chart is enlarged or reduced
  xLabel?: string; // replaces time; then clicks do not seek
}

/// All series over one common x, as uPlot requires; non-finite values are gaps.
function aligned(lines: Line[]): uPlot.AlignedData {
  const one = (line: Line): uPlot.AlignedData => [
    Array.from(line.time),
    Array.from(line.values, (value) => (Number.isFinite(value) ? value : null)),
  ];
  const same = lines.every((line) => line.time === lines[0].time);
  if (same) return [Array.from(lines[0].time), ...lines.map((line) => one(line)[1])] as uPlot.AlignedData;
  // A join would merge two points at one time (a phase transition): shift the first slightly.
  const apart = (data: uPlot.AlignedData): uPlot.AlignedData => {
    const x = data[0] as number[];
    for (let i = x.length - 2; i >= 0; --i) if (x[i] >= x[i + 1]) x[i] = x[i + 1] - 1e-9;
    return data;
  };
  return uPlot.join(
    lines.map((line) => apart(one(line))),
    lines.map(() => [2]),
  );
}

const kHeight = 112; // [px]
const kLargeHeight = 320; // [px], enlarged
const kFont = "10px system-ui, sans-serif";
const kLabelHeight = 16; // of a label of the vertical axis, with padding [px]

/// A small chart over time. A click seeks; a line marks the time of the clock; the values at that
/// time are under the title. A click on the title enlarges it.
export class Chart {
  readonly element: HTMLElement;
  private readonly title: HTMLButtonElement;
  private readonly values = el("span", { class: "values" });
  private readonly box = el("div", { class: "plot" });
  private readonly head = el("div", { class: "playhead" });
  private plot: uPlot | null = null;

  constructor(
    private readonly options: ChartOptions,
    private readonly clock: Clock,
    private readonly phases: Phase[],
  ) {
    this.title = el(
      "button",
      { type: "button", class: "title", title: "Enlarge", "aria-expanded": "false" },
      options.title,
    );
    this.title.addEventListener("click", () => this.enlarge(!this.large));
    this.element = el(
      "figure",
      { class: "chart" },
      el(
        "figcaption",
        {},
        this.title,
        options.xLabel
          ? null
          : el(
              "span",
              { class: "now" },
              this.values,
              el("span", { class: "unit" }, options.unit === "-" ? "" : options.unit),
            ),
      ),
      this.box,
    );
  }

  get large(): boolean {
    return this.element.classList.contains("large");
  }
  enlarge(on: boolean): void {
    this.element.classList.toggle("large", on);
    this.title.setAttribute("aria-expanded", String(on));
    this.title.title = on ? "Reduce" : "Enlarge";
    this.options.resized?.();
    this.resize();
    if (on) this.element.scrollIntoView({ block: "nearest" });
  }

  /// Draws the chart; its element must be in the page.
  draw(): void {
    this.plot?.destroy();
    const { lines, options } = { lines: this.options.lines, options: this.options };
    const width = this.box.clientWidth || 200;
    const grid = { stroke: colour("grid"), width: 1 };
    const axis = { stroke: colour("muted"), font: kFont, grid, ticks: { ...grid, size: 3 } };
    const filter = options.logarithmic ? { filter: powersOfTen } : {};
    this.plot = new uPlot(
      {
        width,
        height: this.height(),
        padding: [8, 16, 0, 0], // half a label
        pxAlign: 0, // whole pixels would turn slow changes into steps
        legend: { show: false },
        cursor: { sync: { key: options.group }, drag: { x: true, y: false }, points: { size: 5 } },
        scales: {
          x: { time: false },
          y: options.logarithmic ? { distr: 3 } : { range: (_u, low, high) => padded(low, high) },
        },
        axes: [
          {
            ...axis,
            size: 22,
            gap: 2,
            space: 38,
            values: (_u, ticks) => ticks.map((tick) => (options.xLabel ? String(tick) : `${short(tick, 4)} s`)),
          },
          {
            ...axis,
            ...filter,
            grid: { ...grid, ...filter },
            ticks: { show: false },
            size: (u, texts) => labelWidth(u, texts),
            gap: 3,
            space: 22,
            values: (_u, ticks) => ticks.map((tick) => (tick == null ? "" : short(tick, 4))),
          },
        ],
        series: [
          {},
          ...lines.map((line) => ({
            label: line.label,
            stroke: colour(line.colour),
            width: line.width ?? 1.4,
            dash: line.dash,
            points: { show: false },
            show: !line.limit || options.limits,
            paths: line.steps ? uPlot.paths.stepped!({ align: 1 }) : undefined,
          })),
        ],
        // uPlot sets scales when it draws: after this constructor, and after zooming or resizing.
        hooks: { drawClear: [(u) => this.shade(u)], draw: [() => this.update()] },
      },
      aligned(lines),
      this.box,
    );
    if (!options.xLabel) {
      this.plot.over.append(this.head);
      this.seekOnClick(this.plot.over);
    }
  }
  resize(): void {
    const width = this.box.clientWidth;
    const height = this.height();
    if (this.plot && width > 0 && (width !== this.plot.width || height !== this.plot.height))
      this.plot.setSize({ width, height });
  }
  showLimits(on: boolean): void {
    this.options.limits = on;
    this.options.lines.forEach((line, i) => line.limit && this.plot?.setSeries(i + 1, { show: on }));
  }
  /// Updates time line and values.
  update(): void {
    if (!this.plot || this.options.xLabel) return;
    const t = this.clock.time;
    const { min, max } = this.plot.scales.x;
    this.head.hidden = min == null || max == null || t < min - 1e-9 || t > max + 1e-9;
    if (!this.head.hidden) this.head.style.transform = `translateX(${this.plot.valToPos(t, "x")}px)`;
    const values: Node[] = [];
    for (const line of this.options.lines) {
      if (line.limit || line.quiet) continue;
      const value = at(line, t);
      const text = el("span", { title: line.label }, short(value));
      text.style.color = colour(line.colour);
      values.push(text);
    }
    this.values.replaceChildren(...values);
  }

  private height(): number {
    return Math.max(this.options.height ?? kHeight, this.large ? kLargeHeight : 0);
  }
  private seekOnClick(over: HTMLElement): void {
    let from = 0;
    over.addEventListener("mousedown", (event) => (from = event.clientX));
    over.addEventListener("click", (event) => {
      if (Math.abs(event.clientX - from) > 3) return; // a zoom
      this.clock.pause();
      this.clock.seek(this.plot!.posToVal(event.clientX - over.getBoundingClientRect().left, "x"));
    });
  }
  /// Shades every other phase.
  private shade(u: uPlot): void {
    if (this.options.xLabel) return;
    u.ctx.save();
    u.ctx.fillStyle = colour("shade");
    for (const phase of this.phases.filter((_, i) => i % 2 === 1)) {
      const left = Math.max(u.valToPos(phase.start, "x", true), u.bbox.left);
      const right = Math.min(u.valToPos(phase.end, "x", true), u.bbox.left + u.bbox.width);
      if (right > left) u.ctx.fillRect(left, u.bbox.top, right - left, u.bbox.height);
    }
    u.ctx.restore();
  }
}

/// Linear between samples, NaN outside.
function at(line: Line, t: number): number {
  const { time, values } = line;
  if (time.length === 0 || t > time[time.length - 1] + 1e-9) return NaN;
  const { index, share } = sampleAt(time, t);
  if (line.steps || share === 0) return values[index];
  return values[index] + share * (values[index + 1] - values[index]);
}

/// Keeps the powers of ten among ticks of a logarithmic axis, as many as have room for labels.
const powersOfTen = (u: uPlot, ticks: number[]): (number | null)[] => {
  const exponents = ticks.map((tick) => Math.log10(tick));
  const isPower = exponents.map((exponent) => Math.abs(exponent - Math.round(exponent)) < 1e-6);
  const room = Math.max(Math.floor((u.height - 30) / kLabelHeight), 1);
  const every = Math.ceil(isPower.filter(Boolean).length / room);
  return ticks.map((tick, i) => (isPower[i] && Math.round(exponents[i]) % every === 0 ? tick : null));
};

/// Width of the widest label of the vertical axis [px].
function labelWidth(u: uPlot, texts: string[] | null): number {
  u.ctx.save();
  u.ctx.font = kFont;
  const widest = Math.max(0, ...(texts ?? []).map((text) => u.ctx.measureText(text ?? "").width));
  u.ctx.restore();
  return Math.ceil(Math.max(widest + 9, 34));
}

/// A padded range, large enough that rounding does not look like a motion.
function padded(low: number, high: number): [number, number] {
  if (!Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const span = Math.max(high - low, 0.02 * size, 1e-4);
  const middle = 0.5 * (low + high);
  return [middle - 0.56 * span, middle + 0.56 * span];
}
