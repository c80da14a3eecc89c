// prowl view: the page of the report from a server, with the solver's iterates.
import { type ChildProcessWithoutNullStreams, spawn } from "node:child_process";
import http from "node:http";
import path from "node:path";
import { expect, type Page, test } from "@playwright/test";
import { command, folder, root, watch } from "./reports";

let server: ChildProcessWithoutNullStreams;
let messages = "";

/// The address that the command prints.
async function serve(...parameters: string[]): Promise<string> {
  messages = "";
  server = spawn(command, ["view", ...parameters], { cwd: root });
  server.stderr.on("data", (text) => (messages += text));
  return new Promise((resolve, reject) => {
    server.stdout.once("data", (text) => resolve(String(text).trim()));
    server.once("exit", (status) => reject(new Error(`prowl view: status ${status}\n${messages}`)));
  });
}

function ended(): Promise<number | null> {
  const status = new Promise<number | null>((resolve) => server.once("exit", resolve));
  server.kill("SIGINT");
  return status;
}

test.afterEach(() => server.kill("SIGKILL"));

const slider = (page: Page) => page.getByRole("slider", { name: "Iterate of the solver" });
const pick = (page: Page, value: number) =>
  slider(page).evaluate((input: HTMLInputElement, to) => {
    input.value = String(to);
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
const base = (page: Page, time: number) =>
  page.evaluate((t) => {
    const { clock, view } = window.prowl!;
    clock.seek(t);
    return view!.bodyPlacement("base");
  }, time);

test("a task: every iterate on a slider, the certified result at its end", async ({ page }) => {
  const url = await serve(path.join(root, "tasks/hyq/step.toml"));
  const { errors, requests } = watch(page);
  await page.goto(url);
  await expect(page.locator(".badge")).toContainText("passed", { timeout: 60_000 });
  await expect(page.locator(".iterate")).toContainText("result, after");
  const count = await page.evaluate(() => window.prowl!.data.plan_json.solver.convergence!.iteration.length);
  await expect(slider(page)).toHaveAttribute("max", String(count)); // they come one by one

  const time = 0.6 * (await page.evaluate(() => window.prowl!.clock.end));
  const result = await base(page, time);
  await pick(page, count - 1);
  await expect(page.locator(".iterate")).toContainText(/mesh \d+, \d+ intervals: iteration \d+/);
  const last = await base(page, time);
  expect(Math.hypot(...[0, 1, 2].map((i) => last[i] - result[i]))).toBeLessThan(1e-4);
  await pick(page, 1);
  const second = await base(page, time);
  expect(Math.hypot(...[0, 1, 2].map((i) => second[i] - result[i]))).toBeGreaterThan(1e-3);
  await page.screenshot({ path: path.join(folder("pictures"), "view.png") });
  await pick(page, count);
  expect(await base(page, time)).toEqual(result);

  expect(errors).toEqual([]);
  expect(
    requests.filter(
      (request) => !request.startsWith(url) && !request.startsWith("blob:") && !request.startsWith("data:"),
    ),
  ).toEqual([]);
  expect(await ended()).toBe(0);
  expect(messages).toContain("certificate: passed");
  await expect(page.locator(".iterate")).toContainText("the server has ended");
});

test("the robot is drawn before the first iterate is asked for", async ({ page }) => {
  await page.addInitScript(() => {
    const Source = window.EventSource;
    const asked: number[] = [];
    Object.assign(window, { asked });
    window.EventSource = class extends Source {
      constructor(url: string | URL) {
        asked.push(performance.now());
        super(url);
      }
    };
  });
  await page.route("**/events", () => undefined); // the server's iterates never come
  const url = await serve(path.join(root, "tasks/hyq/step.toml"));
  await page.goto(url);
  await page.waitForFunction(() => (window as unknown as { asked: number[] }).asked.length > 0);
  const { asked, drawn } = await page.evaluate(() => ({
    asked: (window as unknown as { asked: number[] }).asked[0],
    drawn: performance.getEntriesByName("prowl-first-picture")[0].startTime,
  }));
  expect(drawn).toBeLessThan(asked);
  // The robot is green and grey before a pale ground: many colours around the middle of the picture.
  const colours = await page.evaluate(
    () =>
      new Promise<number>((resolve) => {
        const { canvas } = window.prowl!.view!;
        window.prowl!.view!.ask();
        requestAnimationFrame(() => {
          const copy = document.createElement("canvas");
          [copy.width, copy.height] = [canvas.width, canvas.height];
          const drawing = copy.getContext("2d")!;
          drawing.drawImage(canvas, 0, 0);
          const pixels = drawing.getImageData(
            canvas.width / 4,
            canvas.height / 4,
            canvas.width / 2,
            canvas.height / 2,
          ).data;
          let green = 0;
          for (let i = 0; i < pixels.length; i += 4) if (pixels[i + 1] > pixels[i] + 30) ++green;
          resolve(green);
        });
      }),
  );
  expect(colours).toBeGreaterThan(1000);
  await ended();
});

test("a page that is opened while it solves follows the iterates", async ({ page }) => {
  const url = await serve(path.join(root, "tasks/hyq/walk.toml"), "--solver", "ipopt"); // takes seconds
  await page.goto(url);
  await expect(page.locator(".badge")).toContainText("solving");
  await expect(page.locator(".iterate")).toContainText("iteration");
  const seen = Number(await slider(page).inputValue());
  await expect.poll(async () => Number(await slider(page).inputValue())).toBeGreaterThan(seen);
  // Ctrl-C interrupts the solve, unless that has just come to its end.
  const status = await ended();
  if (status === 0) expect(messages).toContain("certificate: passed");
  else expect(status).toBe(130);
});

test("a folder: its report, and nothing else for nobody else", async ({ page }) => {
  const url = await serve(folder("crouch"));
  await page.goto(url);
  await page.waitForFunction(() => window.prowl !== undefined);
  await expect(page.locator(".badge")).toContainText("passed");
  await expect(slider(page)).toHaveCount(0);

  const status = (target: string, headers: Record<string, string> = {}, method = "GET") =>
    new Promise<number>((resolve) => {
      http
        .request(new URL(target, url), { method, headers }, (answer) => {
          answer.resume();
          resolve(answer.statusCode!);
        })
        .end();
    });
  expect(await status("/")).toBe(200);
  expect(await status("/", { Host: "robots.example" })).toBe(403);
  expect(await status("/../plan.json")).toBe(404);
  expect(await status("/", {}, "DELETE")).toBe(405);
  expect(await ended()).toBe(0);
});
