// What the plots and the forces show, against the plan's own files.
import { readFileSync } from "node:fs";
import path from "node:path";
import { expect, test, type Page } from "@playwright/test";
import { folder, open, readTable, root, seek, timeOf } from "./reports";

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
    const [found, other] = (await values(page, title)).reverse(); // the simulation is drawn first
    expect(Math.abs(found - nodes[plan][row])).toBeLessThan(6e-3 * Math.abs(nodes[plan][row]) + 1e-9);
    const range = simulated[simulation].slice(near - 6, near + 6);
    const slack = 0.01 * Math.abs(other) + 1e-9;
    expect(other).toBeGreaterThan(Math.min(...range) - slack);
    expect(other).toBeLessThan(Math.max(...range) + slack);
  };
  await expectValues("rf_kfe_joint", "tau_rf_kfe_joint_Nm", "tau_rf_kfe_joint_Nm");
  await tab(page, "Base");
  await expectValues("position z", "base_pz_m", "true_base_pz_m");
  await tab(page, "Joints");
  await expectValues("lf_hfe_joint", "q_lf_hfe_joint_rad", "true_q_lf_hfe_joint_rad");
  await tab(page, "Forces");
  await expectValues("rh_foot z", "f_rh_foot_z_N", "f_rh_foot_z_N");
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

test("solver and reproduction say what plan.json says", async ({ page }) => {
  await open(page, "step");
  const plan = JSON.parse(readFileSync(`${folder("step")}/plan.json`, "utf8"));
  expect(plan.solver.convergence.iteration.length).toBeGreaterThan(10);
  await expect(page.locator("#solver-title ~ .two figure.chart canvas")).toHaveCount(2);
  await expect(page.locator("pre.commands")).toContainText(`prowl plan ${plan.task_file.path}`);
  await expect(page.locator("details pre").nth(0)).toHaveText(plan.task_file.text, { useInnerText: false });
  await expect(page.locator("details pre").nth(2)).toContainText("<robot");
});
