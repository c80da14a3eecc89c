// The page of `prowl mpc`: a run under online control, or one that goes on and takes commands.
import "uplot/dist/uPlot.min.css";
import "./style.css";
import "./online.css";
import { Chart, type Line } from "./chart";
import { Clock } from "./clock";
import { floats, type Phase, type ViewData } from "./data";
import { el, short } from "./dom";
import { foldable } from "./fold";
import { keyboard } from "./keyboard";
import { makeView } from "./make_view";
import type { OnlineData, OnlineMoment, OnlineResult } from "./online_data";
import { Remote } from "./online_remote";
import { recordButton } from "./record";
import { ThemeSwitch } from "./theme";
import { Timeline } from "./timeline";
import type { View } from "./view";

/// State of the page, for tests.
declare global {
  interface Window {
    prowlOnline?: { clock: Clock; view: View | null; data: OnlineData };
  }
}

/// Charts shade every second of these: the pushes.
function pushPhases({ pushes, plan }: OnlineData): Phase[] {
  const at = (start: number, end: number): Phase => ({ name: "", start, end, intervals: 1, contacts: [] });
  const ordered = [...pushes].sort((a, b) => a.time - b.time);
  const phases: Phase[] = [];
  let from = 0;
  for (const { time, duration } of ordered) {
    phases.push(at(from, time), at(time, time + duration));
    from = time + duration;
  }
  phases.push(at(from, plan.time.at(-1) ?? from));
  return phases;
}

function makeCharts(data: OnlineData, clock: Clock): Chart[] {
  const { time } = data.plan;
  const pushes = pushPhases(data);
  const chart = (title: string, unit: string, lines: Line[]) =>
    new Chart({ title, unit, lines, limits: true, group: "online" }, clock, pushes);
  const ticks = floats(data.times_ms);
  const tickTime = Array.from(ticks, (_, i) => i * data.period_s);
  const budget: Line = {
    label: "budget",
    time: [0, tickTime.at(-1) ?? 0],
    values: [1e3 * data.budget_s, 1e3 * data.budget_s],
    colour: "limit",
    limit: true,
  };
  return [
    ...data.moves.map(({ title, unit, commanded, measured }) =>
      chart(title, unit, [
        { label: "command", time, values: floats(commanded), colour: "plan" },
        { label: "measured", time, values: floats(measured), colour: "simulation" },
      ]),
    ),
    chart("height of the base", "m", [{ label: "height", time, values: floats(data.height), colour: "simulation" }]),
    chart("CPU time of a plan", "ms", [{ label: "plan", time: tickTime, values: ticks, colour: "plan" }, budget]),
  ];
}

function facts(data: OnlineData, result: OnlineResult): HTMLElement {
  const share = ({ plans, outside }: { plans: number; outside: number }) =>
    plans > 0 ? `${short((100 * outside) / plans)} % of ${plans} plans` : "–";
  const entries: [string, string][] = [
    ["velocity error", `${short(result.velocity_error_mps)} m/s rms`],
    ["turn rate error", `${short(result.turn_error_radps)} rad/s rms`],
    ["plans", `${result.plans}, ${result.failed_plans} failed, ${result.dropped_plans} late and lost`],
    [
      "CPU time of a plan",
      `median ${short(result.plan_ms.median)} ms, 99 % below ${short(result.plan_ms.p99)} ms, longest ${short(result.plan_ms.longest)} ms; budget ${short(1e3 * data.budget_s)} ms`,
    ],
    [
      "after the measurement",
      `median ${short(result.feedback_ms.median)} ms, 99 % below ${short(result.feedback_ms.p99)} ms`,
    ],
    ["forces outside their cones", share(result.forces.undisturbed)],
    ["the same within 0.5 s of a push", share(result.forces.kicked)],
    ["pushes", String(data.pushes.length)],
  ];
  return el(
    "section",
    { class: "card" },
    el("h2", {}, "Run"),
    ...[...result.failures, ...result.notes].map((text) => el("p", {}, text)),
    el("dl", { class: "facts" }, ...entries.flatMap(([name, text]) => [el("dt", {}, name), el("dd", {}, text)])),
  );
}

function badge({ result }: OnlineData): HTMLElement {
  if (!result) return el("span", { class: "badge" }, "● live");
  return result.success
    ? el("span", { class: "badge good" }, "✓ success")
    : el("span", { class: "badge bad" }, `✗ ${result.failures[0] ?? result.end}`);
}

/// Moments of the run as they come, until it ends; then the page loads again, with the whole run.
function listen(viewed: ViewData, view: View | null, remote: Remote): void {
  const events = new EventSource("/events");
  events.addEventListener("moment", (event) => {
    const moment = JSON.parse(event.data as string) as OnlineMoment;
    viewed.plan = moment.plan;
    viewed.phases = moment.phases;
    view?.setPlan();
    remote.show(moment);
  });
  events.addEventListener("ended", () => location.reload());
  events.addEventListener("error", () => {
    events.close();
    remote.end("the server has ended");
  });
}

function start(): void {
  const data = JSON.parse(document.getElementById("prowl-data")!.textContent!) as OnlineData;
  document.title = `${data.robot} online – Prowl`;
  const clock = new Clock(data.plan.time.at(-1) ?? 0);
  let redraw: () => void = () => undefined;
  const theme = new ThemeSwitch(() => redraw());
  const viewed: ViewData = { ...data, simulation: null, other: null };
  const container = el("div", { class: "view" });
  const stage = el("div", { class: "stage" }, container);
  const charts = data.result ? makeCharts(data, clock) : [];
  const details = el("div", { class: "details" });
  if (data.warnings.length > 0)
    details.append(el("section", { class: "card warnings" }, ...data.warnings.map((text) => el("p", {}, `⚠ ${text}`))));
  if (data.result) {
    const plots = el(
      "section",
      { class: "card" },
      el("h2", {}, "Over time"),
      el(
        "p",
        { class: "hint" },
        "Blue: command. Orange: measured. Shaded: pushes. Click in a plot to go to that time.",
      ),
      el("div", { class: "charts" }, ...charts.map((chart) => chart.element)),
    );
    details.append(plots, foldable(facts(data, data.result))!);
  }
  document.body.classList.add("online");
  document.body.classList.toggle("live-run", data.live);
  document.body.append(
    el(
      "header",
      {},
      el("h1", {}, el("span", { class: "robot" }, data.robot), ` ${data.gait}, online`),
      badge(data),
      el("span", { class: "spacer" }),
      theme.button,
    ),
    el("main", {}, stage, ...(data.live ? [] : [details])),
  );
  const view = makeView(container, viewed, clock);
  if (data.live) {
    const remote = new Remote(data);
    stage.append(remote.element);
    document.querySelector<HTMLInputElement>(`input[data-layer="follow"]`)?.click();
    requestAnimationFrame(() => setTimeout(() => listen(viewed, view, remote)));
  } else {
    const timeline = new Timeline(viewed, clock);
    stage.append(timeline.element);
    const record = view && recordButton(view.canvas, clock, `${data.robot}_online`);
    if (record) timeline.addTool(record);
    keyboard(clock, timeline, view, data, () => undefined);
    clock.onChange(() => charts.forEach((chart) => chart.update()));
    addEventListener("resize", () => charts.forEach((chart) => chart.resize()));
  }
  redraw = () => {
    view?.setTheme();
    charts.forEach((chart) => chart.draw());
  };
  redraw();
  window.prowlOnline = { clock, view, data };
}

start();
