import type { Iterate, ReportData } from "./data";
import { el, short } from "./dom";

/// Data of a motion that changes between iterates.
export type Shown = Pick<ReportData, "phases" | "plan" | "charts">;

const kPause = 200; // between pictures of the latest iterate: drawing slows the solver [ms]

/// Iterates of the solver, sent by the server of prowl view, on a slider that ends with the latest,
/// or the result. When the plan is solved, the page reloads with its certificate.
export class Live {
  readonly element: HTMLElement;
  private readonly result: Shown | null;
  private readonly iterates: (Iterate | string)[] = []; // parsed when first shown
  private readonly slider = el("input", {
    type: "range",
    min: "0",
    max: "0",
    step: "1",
    value: "0",
    "aria-label": "Iterate of the solver",
  });
  private readonly readout = el("output", { class: "iterate" });
  private follows = true;
  private waiting = false;

  constructor(
    data: ReportData,
    private readonly show: (shown: Shown) => void,
  ) {
    this.result = data.live?.solved ? { phases: data.phases, plan: data.plan, charts: data.charts } : null;
    this.slider.addEventListener("input", () => {
      this.follows = Number(this.slider.value) === this.last();
      this.draw();
    });
    this.element = el(
      "section",
      { class: "live", "aria-label": "Iterates" },
      el("label", {}, "Iterate ", this.slider),
      this.readout,
    );
    this.describe();
  }

  /// Call it after the first picture: all iterates so far arrive at once.
  listen(): void {
    const events = new EventSource("/events");
    events.addEventListener("iterate", (event) => {
      this.iterates.push(event.data as string);
      this.slider.max = String(this.last());
      if (this.follows) this.slider.value = this.slider.max;
      if (!this.follows || this.result) this.describe();
      else this.ask();
    });
    events.addEventListener("solved", () => {
      if (!this.result) location.reload();
    });
    events.addEventListener("error", () => {
      events.close();
      this.element.classList.add("ended");
      this.element.title = "prowl view has ended: this page keeps its data";
      this.describe();
    });
  }

  /// Slider index of the latest iterate, or of the result after it.
  private last(): number {
    return this.result ? this.iterates.length : Math.max(this.iterates.length - 1, 0);
  }
  /// Limits the rate: iterates may arrive faster than they can be drawn.
  private ask(): void {
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      this.draw();
    }, kPause);
  }
  private iterate(index: number): Iterate | undefined {
    const found = this.iterates[index];
    if (typeof found !== "string") return found;
    return (this.iterates[index] = JSON.parse(found) as Iterate);
  }
  private draw(): void {
    const chosen: Shown | null | undefined = this.iterate(Number(this.slider.value)) ?? this.result;
    if (chosen) this.show({ phases: chosen.phases, plan: chosen.plan, charts: chosen.charts });
    this.describe();
  }
  private describe(): void {
    const at = this.iterate(Number(this.slider.value));
    const count = this.iterates.length;
    const text = at
      ? `mesh ${at.level + 1}, ${at.intervals} intervals: iteration ${at.iteration} · cost ${short(at.cost)} · constraints ${short(at.constraint_violation, 2)} · optimality ${short(at.dual_violation, 2)}`
      : this.result
        ? `result, after ${count} iterates`
        : "initial guess";
    this.readout.textContent = this.element?.classList.contains("ended") ? `${text} · the server has ended` : text;
    this.slider.setAttribute("aria-valuetext", text);
  }
}
