import type { Clock } from "./clock";
import type { ViewData } from "./data";
import { el } from "./dom";
import { layerSwitches } from "./layers";
import { View } from "./view";

/// The 3D view with its switches, or null and a sentence in its place.
export function makeView(container: HTMLElement, data: ViewData, clock: Clock): View | null {
  try {
    const view = new View(container, data, clock);
    container.append(layerSwitches(view, data));
    return view;
  } catch (error) {
    container.append(
      el(
        "p",
        { class: "no-view" },
        `No 3D view: this browser provides no WebGL (${error instanceof Error ? error.message : String(error)}). Plots and tables work without it.`,
      ),
    );
    return null;
  }
}
