// prowl mpc: the page of a run, and the one that drives a robot while it runs.
import { type ChildProcessWithoutNullStreams, execFileSync, spawn } from "node:child_process";
import { mkdirSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { expect, type Page, test } from "@playwright/test";
import { command, folder, root, watch } from "./reports";

const data = (page: Page) => page.evaluate(() => window.prowlOnline!.data);
const base = (page: Page) => page.evaluate(() => window.prowlOnline!.view!.bodyPlacement("base"));

test("a run: motion, commands, kicks and computing times", async ({ page }) => {
  mkdirSync(folder("pictures"), { recursive: true });
  const file = path.join(folder("pictures"), "online.html");
  execFileSync(command, ["mpc", "go2", "--kicks", "0.5", "--duration", "5", "--page", file, "--quiet"], { cwd: root });
  const { errors, requests } = watch(page);
  await page.goto(pathToFileURL(file).href);
  await expect(page.locator(".badge")).toHaveText("✓ success");
  await expect(page.locator(".chart")).toHaveCount(5);
  await expect(page.locator(".facts")).toContainText("500, 0 failed, 0 late and lost");
  const { plan, pushes, phases } = await data(page);
  expect(pushes.map((push) => push.time)).toEqual([2]);
  expect(plan.time.at(-1)).toBeCloseTo(5, 6);
  expect(phases.length).toBeGreaterThan(20); // a trot

  const at = async (time: number) => {
    await page.evaluate((t) => window.prowlOnline!.clock.seek(t), time);
    return base(page);
  };
  const before = await at(1.9);
  const after = await at(2.3);
  const [x, y] = pushes[0].impulse;
  const along = ((after[0] - before[0]) * x + (after[1] - before[1]) * y) / Math.hypot(x, y);
  expect(along).toBeGreaterThan(0.02); // it moves as it is pushed
  await page.screenshot({ path: path.join(folder("pictures"), "online.png") });
  expect(errors).toEqual([]);
  expect(requests.filter((request) => /^https?:/.test(request))).toEqual([]);
});

test("a run that goes on takes commands and kicks", async ({ page }) => {
  const server: ChildProcessWithoutNullStreams = spawn(command, ["mpc", "hyq", "--view"], { cwd: root });
  try {
    const url = await new Promise<string>((resolve, reject) => {
      server.stderr.on("data", (text) => {
        const found = /http:\S+/.exec(String(text));
        if (found) resolve(found[0]);
      });
      server.once("exit", (status) => reject(new Error(`prowl mpc: status ${status}`)));
    });
    const { errors } = watch(page);
    await page.goto(url);
    await expect(page.locator(".badge")).toHaveText("● live");
    await page.locator("body").click({ position: { x: 5, y: 5 } });
    for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowUp");
    await expect(page.locator(".moves")).toContainText(/measured: 0\.[23]\d m\/s ahead/, { timeout: 60_000 });
    await page.getByRole("button", { name: "Kick" }).click();
    await page.screenshot({ path: path.join(folder("pictures"), "online-live.png") });
    expect(errors).toEqual([]);

    // Another site cannot send this type without asking, and what is no wish is ignored.
    const post = (type: string, body: string) =>
      fetch(new URL("/wishes", url), { method: "POST", headers: { "Content-Type": type }, body }).then((r) => r.status);
    expect(await post("text/plain", '{"kick":1}')).toBe(415);
    expect(await post("application/json", '{"kick":1e9}')).toBe(200);
    expect(await post("application/json", "no JSON")).toBe(200);
    await expect(page.locator(".badge")).toHaveText("● live");
    const ended = new Promise<number | null>((resolve) => server.once("exit", resolve));
    server.kill("SIGINT");
    expect([0, 8]).toContain(await ended); // 8: it did not follow in its last second
  } finally {
    server.kill("SIGKILL");
  }
});
