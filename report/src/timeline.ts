import { type Clock, kFrame } from "./clock";
import type { ViewData } from "./data";
import { el } from "./dom";
import { inTheAir, parts, phaseAt } from "./phases";

const kSpeeds = [0.1, 0.25, 0.5, 1, 2];
const kReadable = 70; // smallest width at which a truncated name is useful [px]
const kStands = "stands still";

const icon = (path: string): SVGSVGElement => {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  const shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
  shape.setAttribute("d", path);
  svg.append(shape);
  return svg;
};
const kPlay = "M4 2.5v11l9-5.5z";
const kPause = "M3.5 2.5h3v11h-3zM9.5 2.5h3v11h-3z";

/// Play button, speed, phases and contacts, with a time slider across all of them.
export class Timeline {
  readonly element: HTMLElement;
  readonly speeds = kSpeeds;
  private readonly play = el("button", { type: "button", class: "play" });
  private readonly slider: HTMLInputElement;
  private readonly readout = el("output", { class: "readout" });
  private readonly phase = el("span", { class: "phase-name" });
  private readonly speed = el("select", { "aria-label": "Speed" });
  private readonly tools = el("span", { class: "tools" });
  private rows: HTMLElement;
  private shown: boolean | null = null;

  constructor(
    private readonly data: ViewData,
    private readonly clock: Clock,
  ) {
    this.slider = el("input", {
      type: "range",
      min: "0",
      max: String(clock.end),
      step: "any",
      value: "0",
      "aria-label": "Time in seconds",
    });
    for (const value of kSpeeds)
      this.speed.append(el("option", { value: String(value), selected: value === 1 }, `${value}×`));
    this.play.addEventListener("click", () => clock.toggle());
    this.slider.addEventListener("input", () => {
      if (clock.playing) clock.pause();
      clock.seek(Number(this.slider.value));
    });
    this.slider.addEventListener("keydown", (event) => this.step(event));
    this.speed.addEventListener("change", () => clock.setSpeed(Number(this.speed.value)));
    this.element = el(
      "section",
      { class: "timeline", "aria-label": "Time line" },
      el(
        "div",
        { class: "transport" },
        this.play,
        this.readout,
        this.phase,
        el("label", { class: "speed" }, "Speed ", this.speed),
        this.tools,
      ),
      (this.rows = this.tracks()),
    );
    clock.onChange(() => this.update());
    new ResizeObserver(() => this.fitNames()).observe(this.element);
    this.update();
  }

  /// Appends a button.
  addTool(tool: HTMLElement): void {
    this.tools.append(tool);
  }
  /// Shows phases and contacts of the current data.
  setData(): void {
    this.slider.max = String(this.clock.end);
    const rows = this.tracks();
    this.rows.replaceWith(rows);
    this.rows = rows;
    this.fitNames();
    this.update();
  }
  /// Faster (+1) or slower (-1).
  changeSpeed(by: number): void {
    const at = kSpeeds.indexOf(this.clock.speed) + by;
    if (at >= 0 && at < kSpeeds.length) this.clock.setSpeed(kSpeeds[at]);
  }

  private step(event: KeyboardEvent): void {
    const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageDown: -10, PageUp: 10 }[event.key];
    if (by === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.clock.seek(this.clock.time + by * kFrame * (event.shiftKey ? 10 : 1));
  }

  private tracks(): HTMLElement {
    const end = this.clock.end;
    const { phases, scene } = this.data;
    const last = phases[phases.length - 1]?.end ?? 0;
    const bar = (start: number, stop: number, name: string, text = "", short = "") => {
      const element = el("div", { class: name, title: text || false, "data-short": short }, text);
      element.style.left = `${(100 * start) / end}%`;
      element.style.width = `${(100 * (stop - start)) / end}%`;
      return element;
    };
    const row = (label: string, bars: HTMLElement[], name: string) =>
      el(
        "div",
        { class: `row ${name}` },
        el("span", { class: "label", title: label }, label),
        el("div", { class: "track" }, ...bars),
      );
    const bars = parts(phases);
    const name = bars.length < phases.length ? "stride" : "phase";
    const upper = bars.map((part, i) => bar(part.start, part.end, i % 2 ? "bar odd" : "bar", part.name, part.short));
    if (end > last + 1e-6) upper.push(bar(last, end, "bar rest", kStands));
    const rows = [row(name, upper, "phases")];
    const feet = phases.map((phase) => inTheAir(phase, phases, scene));
    if (feet.some((text) => text !== "")) {
      const lower = phases.map((phase, i) => {
        const element = bar(phase.start, phase.end, feet[i] ? "bar feet" : "bar feet none", feet[i]);
        element.title = feet[i] ? `${phase.name}; in the air: ${feet[i]}` : phase.name;
        return element;
      });
      rows.push(row("in the air", lower, "feet"));
    }
    scene.contacts.forEach((contact, c) => {
      const held = phases.filter((phase) => phase.contacts.some((entry) => entry.contact === c));
      const bars = held.map((phase) => bar(phase.start, phase.end, "stance"));
      if (end > last + 1e-6 && held.includes(phases[phases.length - 1])) bars.push(bar(last, end, "stance rest"));
      rows.push(row(contact.name, bars, "contact"));
    });
    const many = scene.contacts.length > 6 ? "tracks many" : "tracks";
    return el("div", { class: many }, ...rows, el("div", { class: "scrub" }, this.slider));
  }

  /// Shortens or removes names wider than their bars; tooltips keep them.
  private fitNames(): void {
    for (const bar of this.rows.querySelectorAll<HTMLElement>(".bar")) {
      const full = bar.dataset.full ?? (bar.dataset.full = bar.textContent ?? "");
      for (const text of [full, bar.dataset.short ?? ""]) {
        bar.textContent = text;
        if (bar.scrollWidth <= bar.clientWidth) break;
      }
      if (bar.scrollWidth > bar.clientWidth || bar.textContent === "")
        bar.textContent = bar.clientWidth > kReadable ? full : "";
    }
  }
  private update(): void {
    const { time, end, playing, speed } = this.clock;
    this.slider.value = String(time);
    this.slider.setAttribute("aria-valuetext", `${time.toFixed(2)} seconds`);
    this.readout.textContent = `${time.toFixed(3)} / ${end.toFixed(2)} s`;
    const last = this.data.phases[this.data.phases.length - 1]?.end ?? 0;
    this.phase.textContent = time > last + 1e-9 ? kStands : (phaseAt(this.data.phases, time)?.name ?? "");
    this.speed.value = String(speed);
    if (this.shown === playing) return;
    this.shown = playing;
    this.play.replaceChildren(icon(playing ? kPause : kPlay));
    this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
    this.play.title = playing ? "Pause (space)" : "Play (space)";
  }
}
