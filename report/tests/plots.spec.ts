// What the plots and the forces show, against the plan's own files.
import { readFileSync } from "node:fs";
import path from "node:path";
import { pathToFileURL } from "node:url";
import { expect, test, type Page } from "@playwright/test";
import { folder, open, readTable, report, root, seek, timeOf } from "./reports";

const number = (text: string) => Number(text.replaceAll("−", "-"));
const chart = (page: Page, title: string) =>
  page.locator("figure.chart", { has: page.locator(".title", { hasText: new RegExp(`^${title}$`) }) });
const tab = (page: Page, name: string) => page.getByRole("tab", { name }).click();

/// What the heading of a chart says of plan and simulation at the time of the clock.
async function values(page: Page, title: string): Promise<number[]> {
  return (await chart(page, title).locator(".values span").allTextContents()).map(number);
}

test("the values in the headings are those of the plan and of the simulation", async ({ page }) => {
  await open(page, "step");
  const nodes = readTable(`${folder("step")}/trajectory.csv`);
  const simulated = readTable(`${folder("step")}/simulate.csv`);
  const row = Math.floor(nodes.time_s.length / 2);
  const time = nodes.time_s[row];
  await seek(page, time);
  const near = simulated.time_s.findIndex((t) => t >= time);
  const expectValues = async (title: string, plan: string, simulation: string) => {
    const [found, other] = await values(page, title);
    expect(Math.abs(found - nodes[plan][row])).toBeLessThan(6e-3 * Math.abs(nodes[plan][row]) + 1e-9);
    const range = simulated[simulation].slice(near - 6, near + 6);
    const slack = 0.01 * Math.abs(other) + 1e-9;
    expect(other).toBeGreaterThan(Math.min(...range) - slack);
    expect(other).toBeLessThan(Math.max(...range) + slack);
  };
  await expectValues("rf_kfe_joint", "tau_rf_kfe_joint_Nm", "tau_rf_kfe_joint_Nm");
  await expect(page.locator(".plots .legend .key")).toHaveText(["plan", "simulation", "limit"]); // in the same order
  await tab(page, "Base");
  await expectValues("position z", "base_pz_m", "true_base_pz_m");
  await tab(page, "Joints");
  await expectValues("lf_hfe_joint", "q_lf_hfe_joint_rad", "true_q_lf_hfe_joint_rad");
  await tab(page, "Forces");
  await expectValues("rh_foot z", "f_rh_foot_z_N", "f_rh_foot_z_N");
});

/// Where the lines of the time are in the plots, as shares of their widths; null for a hidden one.
const playheads = (page: Page): Promise<(number | null)[]> =>
  page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>(".playhead")].map((head) => {
      const over = head.parentElement!.getBoundingClientRect();
      const line = head.getBoundingClientRect();
      return head.hidden || line.height < 20 ? null : (line.left + 0.5 * line.width - over.left) / over.width;
    }),
  );

/// Every plot over time has its line, in the right place.
async function expectPlayheads(page: Page, time: number, count: number): Promise<void> {
  const { end, planned } = await page.evaluate(() => {
    const { clock, data } = window.prowl!;
    return { end: clock.end, planned: data.plan.time.at(-1)! };
  });
  await expect.poll(async () => (await playheads(page)).length).toBe(count);
  await expect.poll(async () => (await playheads(page)).filter((head) => head === null)).toEqual([]);
  const heads = await playheads(page);
  // Plots are over the time of what is in them: the plan, or the plan and its simulation.
  for (const head of heads)
    expect(Math.min(Math.abs(head! - time / end), Math.abs(head! - time / planned))).toBeLessThan(0.015);
}

test("the line of the time is in every plot: after a deep link, a tab, a theme, a zoom back", async ({ page }) => {
  await page.goto(`${pathToFileURL(report("crouch")).href}#t=1.3`);
  await page.waitForFunction(() => window.prowl !== undefined);
  await expectPlayheads(page, 1.3, 12 + 1); // one of the integration error
  for (const [name, count] of [
    ["Base", 12],
    ["Forces", 12],
    ["Margins", 7],
    ["Gains", 6],
    ["Torques", 12],
  ] as const) {
    await tab(page, name);
    await expectPlayheads(page, 1.3, count + 1);
  }
  await page.getByRole("button", { name: /^Switch to/ }).click();
  await expectPlayheads(page, 1.3, 13);
  await page.setViewportSize({ width: 1100, height: 800 });
  await expectPlayheads(page, 1.3, 13);

  const over = chart(page, "lf_kfe_joint").locator(".u-over");
  const box = (await over.boundingBox())!;
  await page.mouse.move(box.x + 0.05 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.2 * box.width, box.y + 0.5 * box.height, { steps: 5 });
  await page.mouse.up();
  await expect.poll(async () => (await playheads(page)).filter((head) => head === null).length).toBe(12); // not in sight
  await over.dblclick();
  const now = await timeOf(page);
  await expectPlayheads(page, now, 13);
});

test("a click on a title enlarges its plot, and another makes it small", async ({ page }) => {
  await open(page, "crouch");
  await seek(page, 0.8);
  const figure = chart(page, "lh_kfe_joint");
  const title = figure.getByRole("button", { name: "lh_kfe_joint" });
  const size = async () => (await figure.locator("canvas").boundingBox())!;
  const small = await size();
  await title.click();
  await expect(title).toHaveAttribute("aria-expanded", "true");
  await expect.poll(async () => (await size()).width).toBeGreaterThan(2.5 * small.width);
  expect((await size()).height).toBeGreaterThan(2.5 * small.height);
  await expectPlayheads(page, 0.8, 13);
  await title.click();
  await expect.poll(async () => (await size()).width).toBeCloseTo(small.width, 0);
});

test("titles are not cut", async ({ page }) => {
  await open(page, "squat");
  for (const name of ["Torques", "Base", "Forces"]) {
    await tab(page, name);
    const cut = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>(".chart .title, .chart .now")]
        .filter((one) => one.scrollWidth > one.clientWidth + 1)
        .map((one) => one.textContent),
    );
    expect(cut).toEqual([]);
  }
});

test("labels of the axes are inside of their plots, and clear of each other", async ({ page }) => {
  await page.addInitScript(() => {
    const cut: string[] = [];
    const last = new Map<
      HTMLCanvasElement,
      { text: string; left: number; right: number; top: number; bottom: number }
    >();
    const fillText = CanvasRenderingContext2D.prototype.fillText;
    CanvasRenderingContext2D.prototype.fillText = function (
      this: CanvasRenderingContext2D,
      text: string,
      x: number,
      y: number,
      ...rest: number[]
    ) {
      const size = this.measureText(text);
      const at = this.getTransform().transformPoint(new DOMPoint(x, y));
      const left = at.x - size.actualBoundingBoxLeft;
      const right = at.x + size.actualBoundingBoxRight;
      const top = at.y - size.actualBoundingBoxAscent;
      const bottom = at.y + size.actualBoundingBoxDescent;
      if (left < -0.5 || right > this.canvas.width + 0.5 || top < -0.5 || bottom > this.canvas.height + 0.5)
        cut.push(`${text} in ${this.canvas.closest("figure")?.querySelector(".title")?.textContent}`);
      const before = last.get(this.canvas); // labels of one axis follow each other
      if (before && left < before.right && right > before.left && top < before.bottom && bottom > before.top)
        cut.push(`${text} on ${before.text}`);
      last.set(this.canvas, { text, left, right, top, bottom });
      Object.assign(window, { cut, labels: ((window as { labels?: number }).labels ?? 0) + 1 });
      return Reflect.apply(fillText, this, [text, x, y, ...rest]);
    } as typeof fillText;
  });
  await open(page, "trot");
  for (const name of ["Torques", "Base", "Joints", "Rates", "Forces", "Margins", "Gains"]) {
    await tab(page, name);
    await page.waitForTimeout(100);
  }
  expect(await page.evaluate(() => (window as { labels?: number }).labels)).toBeGreaterThan(200);
  expect(await page.evaluate(() => (window as { cut?: string[] }).cut)).toEqual([]);
});

test("torques and forces have their limits: friction and no pulling", async ({ page }) => {
  await open(page, "step");
  const nodes = readTable(`${folder("step")}/trajectory.csv`);
  const friction = Number(
    /^friction = ([\d.]+)/m.exec(readFileSync(path.join(root, "tasks/hyq/step.toml"), "utf8"))![1],
  );
  const limits = (tabName: string, title: string) =>
    page.evaluate(
      ([name, wanted]) => {
        const data = window.prowl!.data;
        const one = data.charts.find((all) => all.name === name)!.charts.find((each) => each.title === wanted)!;
        return one.series
          .filter((series) => series.style === "limit")
          .map((series) => [...new Float32Array(Uint8Array.from(atob(series.values), (c) => c.charCodeAt(0)).buffer)]);
      },
      [tabName, title] as const,
    );
  const times = await page.evaluate(() => window.prowl!.data.plan.time);
  const [upper, lower] = await limits("Forces", "lf_foot x");
  const [pull] = await limits("Forces", "lf_foot z");
  let held = 0;
  nodes.time_s.forEach((time, row) => {
    const at = times.indexOf(time);
    const load = nodes.f_lf_foot_z_N[row];
    if (nodes.contact_lf_foot[row] !== 1 || times.lastIndexOf(time) !== at) return;
    ++held;
    expect(Math.abs(upper[at] - friction * load)).toBeLessThan(1e-3 * Math.abs(load) + 1e-3);
    expect(lower[at]).toBe(-upper[at]);
    expect(pull[at]).toBe(0);
    expect(Math.abs(nodes.f_lf_foot_x_N[row])).toBeLessThanOrEqual(upper[at] + 1);
  });
  expect(held).toBeGreaterThan(10);
  expect(await limits("Torques", "lf_kfe_joint")).toHaveLength(2);
  await tab(page, "Forces");
  await expect(page.locator(".plots .legend .key.limit")).toBeVisible();
  await expect(page.getByRole("checkbox", { name: "limits" })).toBeChecked();
});

test("a click in a plot goes there, and a zoom does not", async ({ page }) => {
  await open(page, "crouch");
  const over = chart(page, "lf_kfe_joint").locator(".u-over");
  const box = (await over.boundingBox())!;
  const end = await page.evaluate(() => window.prowl!.clock.end);
  await page.mouse.click(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
  expect(Math.abs((await timeOf(page)) - 0.4 * end)).toBeLessThan(0.02 * end);
  const there = await timeOf(page);
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.5 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.5 * box.height, { steps: 5 });
  await page.mouse.up();
  expect(await timeOf(page)).toBe(there);
});

test("of a robust plan the tube lies around the simulated deviations, and no other plan has one", async ({ page }) => {
  const { errors } = await open(page, "robust");
  await tab(page, "Tube");
  const [joints, contacts] = await page.evaluate(() => [
    window.prowl!.data.joints.length,
    window.prowl!.data.scene.contacts.length,
  ]);
  await expect(page.locator(".plots figure.chart canvas")).toHaveCount(12 + contacts + joints);
  await expect(page.locator(".plots .legend .key")).toHaveText([
    "plan",
    "simulation",
    "band of the tube",
    "needed by the tube",
  ]);
  const planned = readTable(`${folder("robust")}/trajectory.csv`).time_s.at(-1)!;
  const simulated = readTable(`${folder("robust")}/simulate.csv`);
  for (const time of [0.1, 0.35, 0.5, 0.8]) {
    expect(time).toBeLessThan(planned);
    await seek(page, time);
    const [upper, lower, off] = await values(page, "base y, deviation");
    const row = simulated.time_s.findIndex((t) => t >= time);
    expect(upper).toBeGreaterThan(0.002);
    expect(lower).toBeCloseTo(-upper, 6);
    expect(off).toBeCloseTo(simulated.true_base_py_m[row] - simulated.ref_base_py_m[row], 3);
    expect(Math.abs(off)).toBeLessThan(upper);
  }
  const [needed, left] = await values(page, "left of the friction cone, rh_foot");
  expect(needed).toBeGreaterThan(0);
  expect(left).toBeGreaterThan(needed);
  expect(errors).toEqual([]);
  await open(page, "crouch");
  await expect(page.getByRole("tab", { name: "Tube" })).toHaveCount(0);
});

test("every tab draws all of its charts, and says in which unit", async ({ page }) => {
  const { errors } = await open(page, "squat");
  const joints = await page.evaluate(() => window.prowl!.data.joints.length);
  const contacts = await page.evaluate(() => window.prowl!.data.scene.contacts.length);
  const expected = {
    Torques: joints,
    Base: 12,
    Joints: joints,
    Rates: joints,
    Forces: 3 * contacts,
    Margins: 3 + contacts,
    Gains: 6,
  };
  for (const [name, count] of Object.entries(expected)) {
    await tab(page, name);
    await expect(page.locator(".plots figure.chart canvas")).toHaveCount(count);
    for (const unit of await page.locator(".plots figure.chart .unit").allTextContents()) expect(unit).not.toBe("");
  }
  expect(errors).toEqual([]);
});

test("gains are those of the tracker, as prowl figures reads them", async ({ page }) => {
  await open(page, "crouch");
  await tab(page, "Gains");
  const joint = await page.locator("#gains-joint option:checked").textContent();
  expect(joint).toBe("lf_kfe_joint");
  const before = await values(page, "on base position");
  expect(before).toHaveLength(3);
  await page.locator("#gains-joint").selectOption({ label: "rh_hfe_joint" });
  const after = await values(page, "on base position");
  expect(after).not.toEqual(before);
  expect((await values(page, "on joint positions"))[0]).toBeGreaterThan(0); // a joint is held by its own gain
});

test("arrows are the planned forces, inside the cones of their surfaces", async ({ page }) => {
  await open(page, "walk");
  const nodes = readTable(`${folder("walk")}/trajectory.csv`);
  const friction = Number(
    /^friction = ([\d.]+)/m.exec(readFileSync(path.join(root, "tasks/hyq/walk.toml"), "utf8"))![1],
  );
  const weight = await page.evaluate(() => window.prowl!.data.weight_N);
  let drawn = 0;
  for (const share of [0.1, 0.45, 0.8]) {
    const row = Math.floor(share * nodes.time_s.length);
    await seek(page, nodes.time_s[row]);
    const arrows = await page.evaluate(() => window.prowl!.view!.arrows());
    for (const { name, visible, from, vector, cone } of arrows) {
      const force = ["x", "y", "z"].map((axis) => nodes[`f_${name}_${axis}_N`][row]);
      const size = Math.hypot(...force);
      expect(visible).toBe(nodes[`contact_${name}`][row] === 1 && size > 1e-3 * weight);
      if (!visible) continue;
      ++drawn;
      vector.forEach((value, i) => expect(Math.abs(value - force[i])).toBeLessThan(1e-3 * weight));
      expect(Math.abs(from[2])).toBeLessThan(1e-3); // on the floor
      expect(Math.hypot(vector[0], vector[1]) / vector[2]).toBeLessThanOrEqual(cone.slope * 1.001);
      expect(cone.slope).toBeCloseTo(friction, 6);
    }
  }
  expect(drawn).toBeGreaterThan(5);
});

test("the command of a simulation has the options that were given, and no other", async ({ page }) => {
  const command = async (name: string) => {
    await open(page, name);
    return (await page.locator("pre.commands").textContent())!.split("\n").at(-1);
  };
  expect(await command("walk")).toBe(`prowl simulate ${folder("walk")}`);
  expect(await command("rollout")).toBe(`prowl simulate ${folder("rollout")} --engine rollout`);
});

test("solver and reproduction say what plan.json says", async ({ page }) => {
  await open(page, "step");
  const plan = JSON.parse(readFileSync(`${folder("step")}/plan.json`, "utf8"));
  expect(plan.solver.convergence.iteration.length).toBeGreaterThan(10);
  await expect(page.locator("#solver-title ~ .two figure.chart canvas")).toHaveCount(2);
  await expect(page.locator("pre.commands")).toContainText(`prowl plan ${plan.task_file.path}`);
  await expect(page.locator("details pre").nth(0)).toHaveText(plan.task_file.text, { useInnerText: false });
  await expect(page.locator("details pre").nth(2)).toContainText("<robot");
});
