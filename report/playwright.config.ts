import { existsSync } from "node:fs";
import { join } from "node:path";
import { defineConfig } from "@playwright/test";

// Uses the system's browser: PROWL_CHROMIUM, or the usual paths.
const places = [process.env.PROWL_CHROMIUM, "/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
const browser = places.find((path) => path && existsSync(path));
if (!browser) throw new Error("no Chromium here: apt-get install chromium, or set PROWL_CHROMIUM to one");

export default defineConfig({
  testDir: "tests",
  globalSetup: "./tests/make_reports.ts",
  outputDir: join(process.env.PROWL_REPORT_WORK ?? "artefacts", "results"),
  reporter: [["list"]],
  workers: 1, // rendering uses the processor
  timeout: 120_000,
  expect: { timeout: 15_000 },
  use: {
    viewport: { width: 1440, height: 900 },
    launchOptions: { executablePath: browser, args: ["--no-sandbox"] },
  },
});
