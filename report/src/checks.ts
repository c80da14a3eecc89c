import type { Check, ReportData } from "./data";
import { short } from "./dom";

/// Groups of checks by beginning of their names, in order of display.
export const kGroups: [string, string[]][] = [
  ["Task", ["nodes fit the problem", "start state", "goal", "term ", "phase duration"]],
  ["Limits of the robot", ["joint "]],
  [
    "Contact forces",
    [
      "friction cone",
      "unilateral force",
      "least load",
      "planned contact force",
      "force before opening",
      "contact acceleration",
    ],
  ],
  ["Contact positions", ["contact ", "penetration", "swing clearance"]],
  ["Accuracy of the dynamics", [""]],
];

export const groupOf = (check: Check): string =>
  kGroups.find(([, beginnings]) => beginnings.some((beginning) => check.name.startsWith(beginning)))![0];

/// Unit of a check; for mixed quantities ("SI") that of the worst coordinate.
export function unitOf(check: Check, data: ReportData): string {
  if (check.unit === "-" || check.unit === "") return "";
  if (check.unit !== "SI") return check.unit.replace("^2", "²");
  const coordinate = check.where.split(", ").at(-1) ?? "";
  const torque = data.charts.flatMap((tab) => tab.charts).find((chart) => chart.title === coordinate);
  const isLength = /^base [xyz]$/.test(coordinate) || torque?.unit === "N";
  const unit = isLength ? "m" : "rad";
  if (check.name.includes("velocity")) return `${unit}/s`;
  return check.name === "start state" ? `${unit}, ${unit}/s` : unit;
}

/// Used share of the limit: 0 for a value inside its bound; null without a positive limit.
export function usedShare(check: Check): number | null {
  if (check.worst === null || check.limit === null) return null;
  if (check.worst <= 0) return 0;
  return check.limit > 0 ? check.worst / check.limit : null;
}

/// A share in words: "45 %", "< 0.001 %".
export function percent(share: number | null): string {
  if (share === null) return "–";
  if (share > 0 && share < 1e-5) return "< 0.001 %";
  return share > 10 ? `${short(share, 2)}-fold` : `${short(100 * share, 2)} %`;
}

/// Length of a bar, 0 to 1: logarithmic from a millionth of the limit to the limit.
export const barLength = (share: number): number =>
  share <= 0 ? 0 : Math.min(Math.max(1 + Math.log10(share) / 6, 0.03), 1);

/// The worst value, or the remaining margin if it is inside the bound.
export function worstText(check: Check, unit: string): string {
  const { worst, limit } = check;
  const suffix = unit ? ` ${unit}` : "";
  if (worst === null) return "–";
  if (worst < 0) return `${short(-worst)}${suffix} left`;
  if (worst > 0 && limit !== null && worst < 1e-9 * limit) return `≈ 0${suffix}`;
  return `${short(worst)}${suffix}`;
}

/// Merges texts that differ only in the name of a contact.
export function mergedByContact(texts: string[], contacts: string[]): string[] {
  const groups = new Map<string, { text: string; names: string[] }>();
  for (const text of texts) {
    const name = contacts.find((one) => text.split(/[^\w]+/).includes(one));
    const key = name ? text.replace(name, "\0") : text;
    const group = groups.get(key) ?? { text: key, names: [] };
    if (name) group.names.push(name);
    groups.set(key, group);
  }
  return [...groups.values()].map(({ text, names }) => text.replace("\0", () => names.join(", ")));
}
