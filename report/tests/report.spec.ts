// The page in a browser, as a reader uses it.
import { readFileSync, statSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { expect, test } from "@playwright/test";
import { kOddName, kOddText } from "./make_reports";
import { folder, open, report, seek, timeOf } from "./reports";

const kAll = ["crouch", "step", "walk", "squat", "odd", "rollout"];

for (const name of kAll) {
  test(`${name}: loads without errors and asks nothing of the network`, async ({ page }) => {
    const { errors, requests } = await open(page, name);
    await seek(page, 0.5);
    await page.waitForTimeout(300);
    expect(errors).toEqual([]);
    expect(
      requests.filter((url) => !url.startsWith("file:") && !url.startsWith("blob:") && !url.startsWith("data:")),
    ).toEqual([]);
    expect(requests.filter((url) => url.startsWith("file:"))).toHaveLength(1);
    expect(statSync(report(name)).size).toBeLessThan(8e6);
  });
}

test("plays in real time, pauses, and stops at the end", async ({ page }) => {
  await open(page, "crouch");
  await page.getByRole("button", { name: "Play" }).click();
  const wall = Date.now();
  const start = await timeOf(page);
  await expect.poll(() => timeOf(page)).toBeGreaterThan(start + 0.4);
  const gone = (await timeOf(page)) - start;
  expect(gone).toBeLessThan((Date.now() - wall) / 1000 + 0.1);
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(page.getByRole("button", { name: "Play" })).toBeVisible();
  const stopped = await timeOf(page);
  await page.waitForTimeout(300);
  expect(await timeOf(page)).toBe(stopped);

  const end = await page.evaluate(() => window.prowl!.clock.end);
  await seek(page, end - 0.05);
  await page.getByRole("button", { name: "Play" }).click();
  await expect(page.getByRole("button", { name: "Play" })).toBeVisible();
  expect(await timeOf(page)).toBe(end);
});

test("the time line scrubs", async ({ page }) => {
  await open(page, "step");
  const slider = page.getByRole("slider", { name: "Time" });
  const box = (await slider.boundingBox())!;
  const end = await page.evaluate(() => window.prowl!.clock.end);
  const at = (share: number) => [box.x + 6 + share * (box.width - 12), box.y + box.height / 2] as const;
  await page.mouse.click(...at(0.5));
  expect(await timeOf(page)).toBeCloseTo(0.5 * end, 1);
  await page.mouse.down();
  await page.mouse.move(...at(0.75), { steps: 4 });
  await page.mouse.up();
  expect(Math.abs((await timeOf(page)) - 0.75 * end)).toBeLessThan(0.02 * end);
  await expect(page.locator(".readout")).toContainText((await timeOf(page)).toFixed(3));
});

test("keys do what the help says", async ({ page }) => {
  await open(page, "step");
  const phases = await page.evaluate(() => window.prowl!.data.phases.map((phase) => phase.start));
  await page.keyboard.press("ArrowRight");
  expect(await timeOf(page)).toBeCloseTo(0.01, 9);
  await page.keyboard.press("Shift+ArrowRight");
  expect(await timeOf(page)).toBeCloseTo(0.11, 9);
  await page.keyboard.press("ArrowLeft");
  expect(await timeOf(page)).toBeCloseTo(0.1, 9);
  await page.keyboard.press("n");
  expect(await timeOf(page)).toBeCloseTo(phases[1], 9);
  await page.keyboard.press("p");
  expect(await timeOf(page)).toBe(0);
  await page.keyboard.press("End");
  expect(await timeOf(page)).toBe(await page.evaluate(() => window.prowl!.clock.end));
  await page.keyboard.press("Home");
  await page.keyboard.press("+");
  expect(await page.evaluate(() => window.prowl!.clock.speed)).toBe(2);
  await page.keyboard.press("Space");
  await expect.poll(() => timeOf(page)).toBeGreaterThan(0.05);
  await page.keyboard.press("Space");
  expect(await page.evaluate(() => window.prowl!.clock.playing)).toBe(false);
  await page.keyboard.press("f");
  expect(await page.evaluate(() => window.prowl!.view!.layers.forces)).toBe(false);
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog")).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(page.getByRole("dialog")).toBeHidden();
});

test("the whole page can be reached by the keyboard alone", async ({ page }) => {
  await open(page, "crouch");
  const reached = new Set<string>();
  for (let i = 0; i < 80; ++i) {
    await page.keyboard.press("Tab");
    reached.add(
      await page.evaluate(() => {
        const focus = document.activeElement!;
        return focus.getAttribute("role") ?? focus.className.split(" ")[0] ?? focus.tagName;
      }),
    );
  }
  for (const needed of ["theme", "play", "tab", "seek"]) expect([...reached]).toContain(needed);
  await page
    .locator("button.seek", { hasNotText: /^0.000/ })
    .first()
    .focus();
  await page.keyboard.press("Enter");
  expect(await timeOf(page)).toBeGreaterThan(0);
});

test("a row of the certificate goes to its worst moment", async ({ page }) => {
  await open(page, "step");
  const checks = JSON.parse(readFileSync(`${folder("step")}/plan.json`, "utf8")).certificate.checks;
  const later = checks.filter((check: { time_s: number }) => check.time_s > 0);
  expect(later.length).toBeGreaterThan(3);
  for (const check of later.slice(0, 4)) {
    const row = page.locator(`tr[data-check="${check.name}"]`);
    await row.getByRole("button").click();
    expect(await timeOf(page)).toBeCloseTo(check.time_s, 9);
    await expect(row).toContainText(check.where);
  }
  await expect(page.locator("tr[data-check]")).toHaveCount(checks.length);
});

test("without WebGL there is a word about it, and all the rest", async ({ page }) => {
  await page.addInitScript(() => {
    const getContext = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, ...parameters: unknown[]) {
      return String(parameters[0]).startsWith("webgl") ? null : Reflect.apply(getContext, this, parameters);
    } as typeof getContext;
  });
  await open(page, "crouch");
  await expect(page.locator(".no-view")).toContainText("No 3D view");
  await expect(page.locator(".plots figure.chart canvas")).toHaveCount(12);
  await page.keyboard.press("End");
  expect(await timeOf(page)).toBe(await page.evaluate(() => window.prowl!.clock.end));
});

test("a link may name a time", async ({ page }) => {
  await page.goto(`${pathToFileURL(report("crouch")).href}#t=0.42`);
  await page.waitForFunction(() => window.prowl !== undefined);
  expect(await timeOf(page)).toBe(0.42);
});

test("names are text, whatever they look like", async ({ page }) => {
  const { errors } = await open(page, "odd");
  expect(await page.evaluate(() => (window as { hacked?: unknown }).hacked)).toBeUndefined();
  await expect(page.locator("h1")).toHaveText(`${kOddName} ${kOddName}`);
  await expect(page.locator(".bar").first()).toHaveText(kOddName);
  await expect(page.locator("details pre").first()).toContainText(kOddText);
  await expect(page.locator("pre.commands")).toContainText(`'\\''more`);
  await expect(page.locator("img")).toHaveCount(0);
  expect(await page.locator("script").count()).toBe(2); // the data and the bundle
  expect(errors).toEqual([]);
  const html = readFileSync(report("odd"), "utf8");
  expect(html.split('id="prowl-data">')[1].split("</script>")[0]).not.toContain("<");
});

test("a script that gets into the page is refused", async ({ page }) => {
  await open(page, "crouch");
  const ran = await page.evaluate(() => {
    const script = document.createElement("script");
    script.textContent = "window.hacked = 1";
    document.body.append(script);
    return (window as { hacked?: unknown }).hacked !== undefined;
  });
  expect(ran).toBe(false);
});
