// Films the 3D view of reports in a headless browser, as PNG files in a folder. Standard input is JSON:
//     [{ "report": ..., "folder": ..., "width": ..., "height": ..., "layers": {"cones": false}, "share": 0.5 }]
// One picture at a share of the motion's duration, or with "rate" so many a second, of all of it or from "start" to
// "end" [s].
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const { chromium } = createRequire(fileURLToPath(new URL("../../report/package.json", import.meta.url)))(
  "@playwright/test",
);
const executablePath = [
  process.env.PROWL_CHROMIUM,
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
].find((path) => path && existsSync(path));
// Nothing but the robot, in the whole window.
const STYLE = `.view { position: fixed !important; inset: 0; width: 100vw !important; height: 100vh !important; z-index: 9999 }
  .view > :not(canvas) { display: none !important }`;

const shots = JSON.parse(readFileSync(0, "utf8"));
const browser = await chromium.launch({ executablePath, args: ["--no-sandbox"] });
for (const { report, folder, width, height, layers, share, rate, start, end } of shots) {
  mkdirSync(folder, { recursive: true });
  const page = await browser.newPage({ viewport: { width, height }, colorScheme: "light", bypassCSP: true });
  page.setDefaultTimeout(180_000); // software draws the picture, perhaps beside other work
  await page.goto(pathToFileURL(report).href);
  await page.waitForFunction(() => (window.prowl ??= window.prowlOnline)?.view);
  await page.addStyleTag({ content: STYLE });
  await page.waitForFunction((size) => document.querySelector(".view canvas").clientWidth === size, width);
  const last = end ?? (await page.evaluate(() => window.prowl.data.plan.time.at(-1)));
  const first = start ?? 0;
  const times = rate
    ? Array.from({ length: Math.floor((last - first) * rate) + 1 }, (_, k) => first + k / rate)
    : [share * last];
  await page.evaluate(
    ([from, chosen]) => {
      const { clock, view } = window.prowl;
      for (const [name, on] of Object.entries(chosen)) view.setLayer(name, on);
      clock.seek(from);
      view.resetCamera();
    },
    [times[0], layers],
  );
  for (const [number, time] of times.entries()) {
    await page.evaluate(
      (t) =>
        new Promise((resolve) => {
          window.prowl.clock.seek(t);
          requestAnimationFrame(() => requestAnimationFrame(resolve));
        }),
      time,
    );
    await page.screenshot({ path: join(folder, `${String(number).padStart(4, "0")}.png`) });
  }
  await page.close();
}
await browser.close();
