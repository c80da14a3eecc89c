import type { Phase, Scene, Surface } from "./data";

/// The phase of the plan at a time: the later one at a switch, the last one after the end.
export function phaseAt(phases: Phase[], t: number): Phase | undefined {
  return phases.findLast((phase) => phase.start <= t + 1e-9) ?? phases[0];
}

/// The surface that a contact is held on at a time.
export const heldAt =
  (phases: Phase[], surfaces: Surface[], t: number) =>
  (contact: number): Surface | undefined => {
    const entry = phaseAt(phases, t)?.contacts.find((one) => one.contact === contact);
    return entry && surfaces[entry.surface];
  };

/// Short name of a contact: LF for lf_foot, "left" for each point of the left foot.
export function shortContact(name: string): string {
  const parts = name.replace(/_?foot$/i, "").split("_");
  if (parts.length > 2) return parts[0];
  return parts.map((part) => (part.length <= 3 ? part.toUpperCase() : part)).join(" ") || name;
}

/// Short names of contacts in the air in this phase, but in stance in another: "LF+RH".
export function inTheAir(phase: Phase, phases: Phase[], scene: Scene): string {
  const used = new Set(phases.flatMap((one) => one.contacts.map((entry) => entry.contact)));
  for (const entry of phase.contacts) used.delete(entry.contact);
  const names = scene.contacts.filter((_, c) => used.has(c)).map((contact) => shortContact(contact.name));
  return [...new Set(names)].join("+");
}

/// A phase, or all phases of one stride.
export interface Part {
  name: string;
  short: string;
  start: number;
  end: number;
}
export function parts(phases: Phase[]): Part[] {
  const found: Part[] = [];
  for (const { name, start, end } of phases) {
    const stride = /^stride (\d+): /.exec(name);
    const last = found.at(-1);
    const whole = stride ? `stride ${stride[1]}` : name;
    if (stride && last?.name === whole) last.end = end;
    else found.push({ name: whole, short: stride?.[1] ?? "", start, end });
  }
  return found;
}
