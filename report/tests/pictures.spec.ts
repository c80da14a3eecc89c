// What the page looks like: kept as pictures, and checked for what a picture shows at once.
import path from "node:path";
import AxeBuilder from "@axe-core/playwright";
import { expect, test } from "@playwright/test";
import { open, seek, work } from "./reports";

const picture = (name: string) => ({ path: path.join(work, "pictures", `${name}.png`) });

for (const [name, time] of [
  ["crouch", 0.96],
  ["step", 1.2],
  ["walk", 2.0],
  ["squat", 1.2],
] as const) {
  for (const colorScheme of ["light", "dark"] as const) {
    test(`${name}, ${colorScheme}`, async ({ browser }) => {
      const page = await browser.newPage({ colorScheme });
      await open(page, name);
      await seek(page, time);
      await page.waitForTimeout(500);
      const background = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
      const bright =
        background
          .match(/\d+/g)!
          .slice(0, 3)
          .reduce((sum, value) => sum + Number(value), 0) / 3;
      if (colorScheme === "dark") expect(bright).toBeLessThan(60);
      else expect(bright).toBeGreaterThan(200);
      await page.screenshot(picture(`${name}-${colorScheme}`));
      await page.close();
    });
  }
}

test("the switch changes the colours, of the scene too", async ({ page }) => {
  await open(page, "crouch");
  const corner = () =>
    page.evaluate(() => {
      const canvas = document.querySelector<HTMLCanvasElement>(".view canvas")!;
      const copy = document.createElement("canvas");
      [copy.width, copy.height] = [canvas.width, canvas.height];
      return new Promise<number>((resolve) =>
        requestAnimationFrame(() => {
          window.prowl!.view!.ask();
          requestAnimationFrame(() => {
            const context = copy.getContext("2d")!;
            context.drawImage(canvas, 0, 0);
            resolve(context.getImageData(copy.width - 5, 5, 1, 1).data[0]);
          });
        }),
      );
    });
  const before = await corner();
  await page.getByRole("button", { name: "Switch to dark colours" }).click();
  await expect.poll(corner).toBeLessThan(80);
  expect(before).toBeGreaterThan(180);
});

for (const name of ["step", "squat"]) {
  test(`${name} on a phone: nothing is wider than the screen`, async ({ browser }) => {
    const page = await browser.newPage({
      viewport: { width: 390, height: 844 },
      deviceScaleFactor: 2,
      isMobile: true,
      hasTouch: true,
    });
    await open(page, name);
    await seek(page, 1.0);
    await page.waitForTimeout(500);
    await page.screenshot(picture(`${name}-phone`));
    const widths = await page.evaluate(() => [
      document.documentElement.scrollWidth,
      document.documentElement.clientWidth,
    ]);
    expect(widths[0]).toBeLessThanOrEqual(widths[1]);
    await page.evaluate(() => document.querySelector("#certificate-title")!.scrollIntoView());
    await page.waitForTimeout(200);
    await page.screenshot(picture(`${name}-phone-certificate`));
    await page.close();
  });
}

for (const colorScheme of ["light", "dark"] as const) {
  test(`readable by everybody, ${colorScheme}`, async ({ browser }) => {
    const context = await browser.newContext({ colorScheme, bypassCSP: true });
    const page = await context.newPage();
    await open(page, "step");
    const { violations } = await new AxeBuilder({ page }).analyze();
    expect(violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html).join(" ")}`)).toEqual([]);
    await context.close();
  });
}
