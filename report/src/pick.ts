import type { ReportData } from "./data";
import { el } from "./dom";
import type { Plots } from "./plots";
import type { View } from "./view";

/// A body of the robot, or a contact on it.
interface Picked {
  body: number;
  contact: number | null;
}

const kNearContact = 0.08; // of the robot's size: largest distance of a click on a contact
const kStill = 4; // largest pointer motion of a click [px]

function pickAt(view: View, data: ReportData, x: number, y: number): Picked | null {
  const hit = view.bodyAt(x, y);
  if (!hit) return null;
  const near = data.scene.contacts
    .map((contact, c) => ({ c, body: contact.body, distance: view.contactPoint(c).distanceTo(hit.point) }))
    .filter((one) => one.body === hit.body && one.distance < kNearContact * data.size_m)
    .sort((a, b) => a.distance - b.distance);
  return { body: hit.body, contact: near[0]?.c ?? null };
}

/// A click on the robot plots the series of the body or contact there.
export function pickSeries(view: View, plots: Plots, data: ReportData): void {
  const label = el("output", { class: "picked", hidden: true });
  view.canvas.after(label);
  const base = (tab: string) => tab === "Base";
  const show = (picked: Picked | null) => {
    label.hidden = picked === null;
    view.markBody(picked && picked.body);
    if (!picked) return;
    const contact = picked.contact === null ? null : data.scene.contacts[picked.contact].name;
    const joint = data.joints[picked.body - 1]; // body 0 is the base
    const name = contact ?? joint ?? "base";
    label.textContent = contact ? `contact ${contact}` : joint ? `joint ${joint}` : "base";
    plots.pick({
      name,
      isOfIt: (tab, chart) => {
        if (contact !== null)
          return ["x", "y", "z"].some((axis) => chart === `${contact} ${axis}`) || chart === `friction, ${contact}`;
        return joint ? chart === joint : base(tab);
      },
    });
  };
  let from = [0, 0];
  view.canvas.addEventListener("pointerdown", (event) => (from = [event.clientX, event.clientY]));
  view.canvas.addEventListener("click", (event) => {
    if (Math.hypot(event.clientX - from[0], event.clientY - from[1]) > kStill) return; // a drag
    show(pickAt(view, data, event.clientX, event.clientY));
  });
}
