// The reports that the tests open, and what they are compared with.
import { readFileSync } from "node:fs";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import type { Page } from "@playwright/test";

export const root = path.resolve(path.dirname(fileURLToPath(import.meta.url)), "../..");
export const work = process.env.PROWL_REPORT_WORK ?? path.join(root, "report/artefacts");
export const command = process.env.PROWL_COMMAND ?? path.join(root, "build/bin/prowl");

export const folder = (name: string): string => path.join(work, name);
export const report = (name: string): string => path.join(folder(name), "report.html");

export type Table = Record<string, number[]>;

export function readTable(file: string): Table {
  const [heading, ...rows] = readFileSync(file, "utf8")
    .trimEnd()
    .split("\n")
    .map((line) => line.split(","));
  return Object.fromEntries(heading.map((name, i) => [name, rows.map((row) => Number(row[i]))]));
}

/// Keeps what goes wrong in a page and what it asks of the network.
export function watch(page: Page): { errors: string[]; requests: string[] } {
  const errors: string[] = [];
  const requests: string[] = [];
  page.on("console", (message) => {
    if (message.type() === "error" || (message.type() === "warning" && !message.text().includes("GL Driver Message")))
      errors.push(message.text());
  });
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  return { errors, requests };
}

/// Opens a report as a double click does.
export async function open(page: Page, name: string): Promise<{ errors: string[]; requests: string[] }> {
  const seen = watch(page);
  await page.goto(pathToFileURL(report(name)).href);
  await page.waitForFunction(() => window.prowl !== undefined);
  return seen;
}

export const seek = (page: Page, time: number): Promise<void> =>
  page.evaluate((t) => window.prowl!.clock.seek(t), time);
export const timeOf = (page: Page): Promise<number> => page.evaluate(() => window.prowl!.clock.time);
