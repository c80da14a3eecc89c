// Opens every page of the site from disk in a headless browser, as a reader without a network would: no errors, no requests to
// anywhere else, nothing wider than a phone, and the search finds things.
//     browse.mjs SITE PICTURES
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const { chromium } = createRequire(fileURLToPath(new URL("../../report/package.json", import.meta.url)))(
  "@playwright/test",
);
const [site, pictures] = process.argv.slice(2);
const browserPath = [
  process.env.PROWL_CHROMIUM,
  "/usr/bin/chromium",
  "/usr/bin/chromium-browser",
  "/usr/bin/google-chrome",
].find((path) => path && existsSync(path));
const faults = [];
const check = (condition, message) => condition || faults.push(message);

const browser = await chromium.launch({ executablePath: browserPath, args: ["--no-sandbox"] });
const pages = [
  ...readdirSync(site).filter((name) => name.endsWith(".html")),
  "api/index.html",
  "source/prowl/plan.hpp.html",
];
mkdirSync(pictures, { recursive: true });
const looks = {
  light: { colorScheme: "light", width: 1300 },
  dark: { colorScheme: "dark", width: 1300 },
  phone: { colorScheme: "light", width: 390 },
};

for (const [look, { colorScheme, width }] of Object.entries(looks)) {
  const context = await browser.newContext({ colorScheme, viewport: { width, height: 900 } });
  const page = await context.newPage();
  let name = "";
  page.on("console", (message) => check(message.type() !== "error", `${name}, ${look}: ${message.text()}`));
  page.on("pageerror", (error) => check(false, `${name}, ${look}: ${error.message}`));
  page.on("request", (request) =>
    check(/^(file|data|blob|about):/.test(request.url()), `${name} asks for ${request.url()}`),
  );
  page.on("requestfailed", (request) =>
    // but one that the next page has cut short
    check(request.failure()?.errorText === "net::ERR_ABORTED", `${name}: cannot load ${request.url()}`),
  );
  for (name of pages) {
    await page.goto(pathToFileURL(join(site, name)).href);
    const overflow = await page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);
    check(name.startsWith("api/") || overflow <= 0, `${name}, ${look}: ${overflow} pixels wider than the window`);
    if (/^(index|concepts|theory|examples)\.html$/.test(name)) {
      await page.screenshot({
        path: join(pictures, `${name.replace(".html", "")}_${look}.png`),
        fullPage: name !== "theory.html",
      });
    }
    if (name === "concepts.html") {
      // pictures take the page's colour of text
      const colour = await page.evaluate(() => getComputedStyle(document.querySelector("svg.picture text")).fill);
      const text = await page.evaluate(() => getComputedStyle(document.querySelector("article")).color);
      check(colour === text, `${look}: text of pictures is ${colour}, of the page ${text}`);
    }
  }
  if (look === "light") {
    await page.goto(pathToFileURL(join(site, "index.html")).href);
    // by keys: once its index is read, the search looks at the text when a key comes up, not when the text changes
    await page.getByRole("textbox", { name: "Search" }).pressSequentially("friction");
    const hits = page.locator(".md-search-result__item");
    await hits
      .nth(2)
      .waitFor({ timeout: 20_000 })
      .catch(() => {});
    check((await hits.count()) > 2, `the search for "friction" finds ${await hits.count()} pages`);
  }
  await context.close();
}
await browser.close();
if (faults.length > 0) {
  console.error([...new Set(faults)].join("\n"));
  process.exit(1);
}
console.log(`${pages.length} pages, three looks each: ${pictures}`);
