import { type Clock, kFrame } from "./clock";
import type { ViewData } from "./data";
import type { Timeline } from "./timeline";
import type { Layers, View } from "./view";

export const kKeys: [string, string][] = [
  ["space", "play, pause"],
  ["← →", "10 ms back, forward; with shift 100 ms; previous, next tab if a tab has the focus"],
  ["home, end", "start, end"],
  ["n, p", "next, previous phase"],
  ["+ −", "faster, slower"],
  ["f, c, g, t", "forces, friction cones, simulation, paths"],
  ["o, m, s, z", "other plan, centre of mass, support polygon, zero-moment point"],
  ["w", "follow the robot"],
  ["r", "reset the view"],
  ["?", "this help"],
];

const kLayers: Record<string, keyof Layers> = {
  f: "forces",
  c: "cones",
  g: "ghost",
  t: "trails",
  o: "other",
  m: "mass",
  s: "support",
  z: "zmp",
  w: "follow",
};

/// Keys of the whole page; a focused field takes precedence.
export function keyboard(
  clock: Clock,
  timeline: Timeline,
  view: View | null,
  data: Pick<ViewData, "phases">,
  help: () => void,
): void {
  const starts = () => [...data.phases.map((phase) => phase.start), data.phases[data.phases.length - 1]?.end ?? 0];
  const actions: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => clock.toggle(),
    ArrowLeft: (event) => clock.seek(clock.time - kFrame * (event.shiftKey ? 10 : 1)),
    ArrowRight: (event) => clock.seek(clock.time + kFrame * (event.shiftKey ? 10 : 1)),
    Home: () => clock.seek(0),
    End: () => clock.seek(clock.end),
    n: () => clock.seek(starts().find((start) => start > clock.time + 1e-6) ?? clock.end),
    p: () => clock.seek(starts().findLast((start) => start < clock.time - 1e-6) ?? 0),
    "+": () => timeline.changeSpeed(1),
    "-": () => timeline.changeSpeed(-1),
    r: () => view?.resetCamera(),
    "?": help,
  };
  for (const [key, layer] of Object.entries(kLayers)) {
    actions[key] = () => document.querySelector<HTMLInputElement>(`input[data-layer="${layer}"]`)?.click();
  }
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const target = event.target as HTMLElement;
    if (target.closest("select, textarea, dialog")) return;
    // Space presses buttons, arrow keys move within tabs and text.
    if (event.key === " " && target.closest("button, summary, input[type=checkbox]")) return;
    if (event.key.length > 1 && target.closest("pre, .wide")) return;
    const action = actions[event.key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}
