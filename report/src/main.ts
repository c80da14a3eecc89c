import "uplot/dist/uPlot.min.css";
import "./style.css";
import { certificate } from "./certificate";
import { Clock } from "./clock";
import { comparison } from "./compare";
import { readData, type ReportData } from "./data";
import { el } from "./dom";
import { foldable } from "./fold";
import { header } from "./header";
import { keyboard, kKeys } from "./keyboard";
import { MomentLink } from "./link";
import { Live, type Shown } from "./live";
import { makeView } from "./make_view";
import { pickSeries } from "./pick";
import { Plots } from "./plots";
import { recordButton } from "./record";
import { reproduce, simulation } from "./reproduce";
import { solver } from "./solver";
import { ThemeSwitch } from "./theme";
import { Timeline } from "./timeline";
import type { View } from "./view";

/// State of the page, for tests.
declare global {
  interface Window {
    prowl?: { clock: Clock; view: View | null; data: ReportData };
  }
}

function helpDialog(): HTMLDialogElement {
  const close = el("button", { type: "button" }, "Close");
  const dialog = el(
    "dialog",
    { "aria-labelledby": "help-title" },
    el("h2", { id: "help-title" }, "Keys"),
    el("dl", { class: "facts" }, ...kKeys.flatMap(([keys, text]) => [el("dt", {}, keys), el("dd", {}, text)])),
    el(
      "p",
      { class: "hint" },
      "In the view: drag to turn, right drag or two fingers to move, wheel or pinch to zoom. Click a body or a foot to plot its series.",
    ),
    close,
  );
  close.addEventListener("click", () => dialog.close());
  return dialog;
}

/// The view, or a note why there is none; the rest of the page works without it.
const endOf = ({ plan, simulation, other }: ReportData): number =>
  Math.max(...[plan, simulation, other?.plan, other?.simulation].map((motion) => motion?.time.at(-1) ?? 0));

function start(): void {
  const data = readData();
  document.title = `${data.robot} ${data.plan_json.name} – Prowl`;
  const clock = new Clock(endOf(data));
  let redraw: () => void = () => undefined;
  const theme = new ThemeSwitch(() => redraw());

  const container = el("div", { class: "view" });
  const help = helpDialog();
  const timeline = new Timeline(data, clock);
  const plots = new Plots(data, clock);
  const goTo = (time: number) => {
    clock.pause();
    clock.seek(time);
  };
  const isSolving = data.live?.solved === false;
  const later = el(
    "section",
    { class: "card" },
    el("p", { class: "hint" }, "Certificate, solver and sources appear here when the task is solved."),
  );
  const judged = isSolving ? { element: later, draw: () => undefined } : certificate(data, clock, goTo);
  const solved = isSolving ? null : solver(data, clock);
  const warnings =
    data.warnings.length > 0
      ? el(
          "section",
          { class: "card warnings", "aria-label": "Warnings" },
          ...data.warnings.map((text) => el("p", {}, `⚠ ${text}`)),
        )
      : null;
  document.body.append(
    header(data, theme, () => help.showModal()),
    el(
      "main",
      {},
      el("div", { class: "stage" }, container, timeline.element),
      el(
        "div",
        { class: "details" },
        warnings,
        comparison(data),
        plots.element,
        foldable(judged.element, judged.draw),
        foldable(simulation(data)),
        foldable(solved?.element ?? null, solved?.draw),
        isSolving ? null : foldable(reproduce(data)),
      ),
    ),
    help,
  );

  const view = makeView(container, data, clock);
  if (view) {
    pickSeries(view, plots, data);
    const record = recordButton(view.canvas, clock, `${data.robot}_${data.plan_json.name}`.replace(/[^\w.-]+/g, "_"));
    if (record) timeline.addTool(record);
  }
  plots.choose(0);
  judged.draw();
  solved?.draw();
  redraw = () => {
    view?.setTheme();
    plots.draw();
    judged.draw();
    solved?.draw();
  };
  if (data.live) {
    const show = (shown: Shown) => {
      Object.assign(data, shown);
      clock.setEnd(endOf(data));
      timeline.setData();
      plots.setData();
      view?.setPlan();
    };
    const live = new Live(data, show);
    timeline.element.after(live.element);
    requestAnimationFrame(() => setTimeout(() => live.listen()));
  }
  keyboard(clock, timeline, view, data, () => (help.open ? help.close() : help.showModal()));
  const link = new MomentLink(clock, plots, view);
  timeline.addTool(link.button);
  link.start();
  window.prowl = { clock, view, data };
}

start();
