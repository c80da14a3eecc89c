import type { ViewData } from "./data";
import { el } from "./dom";
import type { Layers, View } from "./view";

/// Switches for the layers of the view.
export function layerSwitches(view: View, data: ViewData): HTMLElement {
  const names: [keyof Layers, string, boolean][] = [
    ["forces", "forces", true],
    ["cones", "cones", true],
    ["ghost", "simulation", view.simulation !== null],
    ["other", "other plan", data.other !== null],
    ["trails", "paths", true],
    ["mass", "centre of mass", true],
    ["support", "support", true],
    ["zmp", "ZMP", true],
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
  const list = el("details", { class: "layer-list" }, el("summary", {}, "layers"), el("div", {}, ...boxes));
  // Folded on narrow screens, where the list would cover the view.
  const narrow = matchMedia("(max-width: 900px)");
  const fit = () => (list.open = !narrow.matches);
  narrow.addEventListener("change", fit);
  fit();
  return el("div", { class: "layers" }, list, reset);
}
