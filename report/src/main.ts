import "uplot/dist/uPlot.min.css";
import "./style.css";
import { certificate } from "./certificate";
import { Clock } from "./clock";
import { readData, type ReportData } from "./data";
import { el, short } from "./dom";
import { keyboard, kKeys } from "./keyboard";
import { Live, type Shown } from "./live";
import { Plots } from "./plots";
import { reproduce, simulation } from "./reproduce";
import { solver } from "./solver";
import { ThemeSwitch } from "./theme";
import { Timeline } from "./timeline";
import { type Layers, View } from "./view";

/// For tests of the page: what it shows, in numbers.
declare global {
  interface Window {
    prowl?: { clock: Clock; view: View | null; data: ReportData };
  }
}

function header(data: ReportData, theme: ThemeSwitch, help: () => void): HTMLElement {
  const { certificate: found, good, name, solver: solved } = data.plan_json;
  const intervals = data.phases.reduce((sum, phase) => sum + phase.intervals, 0);
  const duration = data.phases[data.phases.length - 1]?.end ?? 0;
  const helpButton = el("button", { type: "button", "aria-label": "Keys" }, "?");
  helpButton.addEventListener("click", help);
  return el(
    "header",
    {},
    el("h1", {}, el("span", { class: "robot" }, data.robot), " ", name),
    data.live?.solved === false
      ? el("span", { class: "badge" }, "… solving")
      : el(
          "span",
          { class: good ? "badge good" : "badge bad" },
          good ? `✓ passed · ${found.grade}` : `✗ not good · ${data.plan_json.status}`,
        ),
    el(
      "span",
      { class: "summary" },
      `${short(duration)} s · ${data.phases.length} ${data.phases.length === 1 ? "phase" : "phases"} · ${intervals} intervals · ${solved.name}${data.live?.solved === false ? "" : `, ${solved.iterations} iterations, ${short(solved.seconds)} s`}`,
    ),
    el("span", { class: "spacer" }),
    helpButton,
    theme.button,
  );
}

function layerSwitches(view: View): HTMLElement {
  const names: [keyof Layers, string, boolean][] = [
    ["forces", "forces", true],
    ["cones", "cones", true],
    ["ghost", "simulation", view.simulation !== null],
    ["trails", "paths", true],
    ["follow", "follow", true],
  ];
  const boxes = names
    .filter(([, , there]) => there)
    .map(([name, text]) => {
      const box = el("input", { type: "checkbox", "data-layer": name, checked: view.layers[name] });
      box.addEventListener("change", () => view.setLayer(name, box.checked));
      return el("label", { class: `layer ${name}` }, box, text);
    });
  const reset = el("button", { type: "button" }, "reset view");
  reset.addEventListener("click", () => view.resetCamera());
  return el("div", { class: "layers" }, ...boxes, reset);
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
      "In the view: drag to turn, right drag or two fingers to move, wheel or pinch to come nearer.",
    ),
    close,
  );
  close.addEventListener("click", () => dialog.close());
  return dialog;
}

/// The view, or why there is none: everything else of the page works without.
function makeView(container: HTMLElement, data: ReportData, clock: Clock): View | null {
  try {
    const view = new View(container, data, clock);
    container.append(layerSwitches(view));
    return view;
  } catch (error) {
    container.append(
      el(
        "p",
        { class: "no-view" },
        `No 3D view: this browser gives no WebGL (${error instanceof Error ? error.message : String(error)}). Plots and tables work without.`,
      ),
    );
    return null;
  }
}

const endOf = (data: ReportData): number => Math.max(data.plan.time.at(-1) ?? 0, data.simulation?.time.at(-1) ?? 0);

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
    el("p", { class: "hint" }, "Certificate, solver and sources are here when it is solved."),
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
        plots.element,
        judged.element,
        simulation(data),
        solved?.element,
        isSolving ? null : reproduce(data),
      ),
    ),
    help,
  );

  const view = makeView(container, data, clock);
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
    timeline.element.after(new Live(data, show).element);
  }
  keyboard(clock, timeline, view, data, () => (help.open ? help.close() : help.showModal()));
  const linked = /^#t=(\d+(\.\d+)?)$/.exec(location.hash);
  if (linked) clock.seek(Number(linked[1]));
  window.prowl = { clock, view, data };
}

start();
