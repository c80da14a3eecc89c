// What the page says in words: head line, time line, certificate, two plans, links, and all of it on a narrow screen.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { expect, type Page, test } from "@playwright/test";
import { folder, open, readTable, report, seek, timeOf, watch } from "./reports";

const plan = (name: string) => JSON.parse(readFileSync(`${folder(name)}/plan.json`, "utf8"));
const isNear = (text: string, value: number) => expect(Math.abs(Number(text) - value)).toBeLessThan(6e-3 * value);

test("the head line tells the motion's time from the solver's", async ({ page }) => {
  await open(page, "walk");
  const { solver } = plan("walk");
  const text = (await page.locator(".summary").textContent())!;
  const [, motion, solved, iterations] =
    /^motion ([\d.]+) s · .* · solved in ([\d.]+) s by Riccati, (\d+) iterations$/.exec(text)!;
  isNear(motion, await page.evaluate(() => window.prowl!.data.plan.time.at(-1)!));
  isNear(solved, solver.seconds);
  expect(Number(iterations)).toBe(solver.iterations);
});

test("a grade says what it is good for, where it stands", async ({ page }) => {
  await open(page, "crouch");
  await expect(page.locator(".badge")).toHaveText("✓ passed · draft");
  await expect(page.locator(".badge")).toHaveAttribute("title", /good for simulation/);
  await expect(page.locator(".grade")).toHaveText(
    "Draft: good for simulation, integration error below 1e-4. Certified: integration error below 1e-6.",
  );
});

test("a failed plan says what is wrong in words", async ({ page }) => {
  await open(page, "failed");
  await expect(page.locator(".badge")).toHaveText("✗ no plan: goal seems out of reach");
  const failed = plan("failed").certificate.checks.filter((check: { passed: boolean }) => !check.passed).length;
  expect(failed).toBeGreaterThan(1);
  await expect(page.locator("#certificate-title")).toContainText(`${failed} of `);
  await expect(page.locator("tr.failed")).toHaveCount(failed);
  const conflict = /^has to give way: phase 1, goal 1, base z at 1 s: 0.15\d m beyond its bound$/;
  await expect(page.locator(".notes li").first()).toHaveText(conflict);
  await expect(page.locator(".notes li").last()).toHaveText(/lf_foot, lh_foot, rf_foot, rh_foot/); // one for four feet
  await expect(page.locator(".summary")).toContainText("stopped in");
  await expect(page.locator("header")).not.toContainText("solver_failed");
  await expect(page.locator("#certificate-title")).not.toContainText("grade");
});

test("a goal that is proven out of reach is named", async ({ page }) => {
  await page.addInitScript(() => {
    const parse = JSON.parse;
    JSON.parse = (text: string) => {
      const data = parse(text);
      if (data?.plan_json) {
        Object.assign(data.plan_json, { good: false, status: "infeasible" });
        data.plan_json.reasons = [
          "goal 1, phase 'phase 1': contact lf_foot is out of reach: 0.9 m or more from lf_haa",
        ];
      }
      return data;
    };
  });
  await open(page, "crouch");
  await expect(page.locator(".badge")).toHaveText("✗ no plan: goal out of reach");
});

test("checks stand in groups, with units and the share of the limit that is used", async ({ page }) => {
  await open(page, "walk");
  const { checks } = plan("walk").certificate;
  const groups = page.locator("tr.group th");
  await expect(groups).toHaveText([
    "Task",
    "Limits of the robot",
    "Contact forces",
    "Contact positions",
    "Accuracy of the dynamics",
  ]);
  await expect(page.locator("tr[data-check]")).toHaveCount(checks.length);
  await expect(page.locator(".checks")).not.toContainText("SI");
  for (const check of checks) {
    const row = page.locator(`tr[data-check="${check.name}"]`);
    const percent = (await row.locator(".percent").textContent())!;
    const share = (100 * check.worst) / check.limit;
    if (check.worst <= 0) expect(percent).toBe("0 %");
    else if (share < 1e-3) expect(percent).toBe("< 0.001 %");
    else expect(Math.abs(Number(percent.replace(" %", "")) - share)).toBeLessThan(0.051 * share); // two digits
    if (check.worst < 0) await expect(row.locator(".worst")).toContainText("left");
  }
  await expect(page.locator(`tr[data-check="joint position beyond limit"] .limit`)).toHaveText("0.001 rad");
  // All columns are in sight.
  const wide = await page
    .locator(".wide", { has: page.locator(".checks") })
    .evaluate((one) => [one.scrollWidth, one.clientWidth]);
  expect(wide[0]).toBeLessThanOrEqual(wide[1]);
  // Logarithmic bars: what uses more has a longer one.
  const lengths = await page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>(".used")].map((bar) => Number(bar.style.getPropertyValue("--share"))),
  );
  expect(lengths.filter((length) => length > 0).length).toBeGreaterThan(lengths.length / 2);
});

test("the time line names strides, and feet in the air", async ({ page }) => {
  await open(page, "trot");
  await expect(page.locator(".row.phases .label")).toHaveText("stride");
  await expect(page.locator(".row.feet .label")).toHaveText("in the air");
  const feet = (await page.locator(".row.feet .bar").allTextContents()).filter((text) => text !== "");
  expect(new Set(feet)).toEqual(new Set(["LF+RH", "LH+RF"]));
  const phases = await page.evaluate(() => window.prowl!.data.phases);
  expect(feet).toHaveLength(phases.filter((phase) => phase.contacts.length === 2).length);
  const strides = (await page.locator(".row.phases .bar").allTextContents()).filter((text) =>
    /^(stride )?\d+$/.test(text),
  );
  const count = Math.max(...phases.map((phase) => Number(/^stride (\d+)/.exec(phase.name)?.[1] ?? 0)));
  expect(strides).toHaveLength(count);

  await open(page, "walk");
  const order = (await page.locator(".row.feet .bar").allTextContents()).filter((text) => text !== "");
  expect(order).toHaveLength(8);
  expect(new Set(order)).toEqual(new Set(["LF", "LH", "RF", "RH"]));
});

test("no name on the time line is cut to a letter and dots", async ({ page }) => {
  for (const width of [1440, 400]) {
    await page.setViewportSize({ width, height: 800 });
    for (const name of ["walk", "trot", "step"]) {
      await open(page, name);
      await page.waitForTimeout(100);
      const cut = await page.evaluate(() =>
        [...document.querySelectorAll<HTMLElement>(".tracks .bar")]
          .filter((bar) => bar.scrollWidth > bar.clientWidth && bar.clientWidth < 60)
          .map((bar) => bar.textContent),
      );
      expect(cut).toEqual([]);
    }
  }
});

/// The two cells of a row in the table of two plans.
const compared = (page: Page, name: string) =>
  page.locator(".compare tr", { has: page.getByRole("rowheader", { name, exact: true }) }).locator("td");

const twoPlans = async (page: Page) => {
  const seen = await open(page, "two");
  await expect(page.locator("#compare-title")).toHaveText("Two plans");
  return seen;
};

test("two plans in one page: a table, their lines, both robots", async ({ page }) => {
  const { errors } = await twoPlans(page);
  await expect(compared(page, "task")).toHaveText(["HyQ walk", "HyQ trot"]);
  await expect(compared(page, "iterations")).toHaveText([
    String(plan("walk").solver.iterations),
    String(plan("trot").solver.iterations),
  ]);
  await expect(page.locator(".plots .legend .key.second")).toHaveText(["other plan", "other simulation"]);
  await page.getByRole("tab", { name: "Base" }).click();
  const time = 2.5;
  await seek(page, time);
  const shown = await page.locator("figure.chart", { hasText: "position x" }).locator(".values span").allTextContents();
  const base = async (name: string) => {
    await open(page, name);
    await seek(page, time);
    return page.evaluate(() => window.prowl!.view!.bodyPlacement("base"));
  };
  const [walk, trot] = [await base("walk"), await base("trot")];
  expect(Math.abs(walk[0] - trot[0])).toBeGreaterThan(0.02);
  expect(Math.abs(Number(shown[0].replace("−", "-")) - walk[0])).toBeLessThan(2e-3);
  expect(Math.abs(Number(shown[1].replace("−", "-")) - trot[0])).toBeLessThan(2e-3);

  await open(page, "two");
  await seek(page, time);
  const other = await page.evaluate(() => window.prowl!.view!.otherPlacement("base"));
  for (const i of [0, 1, 2]) expect(Math.abs(other[i] - trot[i])).toBeLessThan(1e-5);
  await expect(page.getByRole("checkbox", { name: "other plan" })).toBeChecked();
  expect(errors).toEqual([]);
});

test("two plans: simulations of both in table and plots, forces of the second as arrows", async ({ page }) => {
  await twoPlans(page);
  const error = (name: string) =>
    100 * JSON.parse(readFileSync(`${folder(name)}/simulate.json`, "utf8")).base_position_m.largest;
  await expect(compared(page, "simulation")).toHaveText(["succeeded", "succeeded"]);
  const errors = await compared(page, "largest base error").allTextContents();
  ["walk", "trot"].forEach((name, i) => isNear(errors[i].replace(" cm", ""), error(name)));

  await page.getByRole("tab", { name: "Forces" }).click();
  const runs = ["walk", "trot"].map((name) => readTable(`${folder(name)}/simulate.csv`));
  const time = runs[1].time_s[Math.floor(0.4 * runs[1].time_s.length)];
  await seek(page, time);
  const chart = page.locator("figure.chart", { has: page.getByRole("button", { name: "lf_foot z", exact: true }) });
  const shown = (await chart.locator(".values span").allTextContents()).map((text) => Number(text.replace("−", "-")));
  expect(shown).toHaveLength(4); // plan, other plan, simulation, other simulation
  runs.forEach(({ time_s, f_lf_foot_z_N }, i) => {
    const at = time_s.findIndex((t) => t >= time);
    const around = f_lf_foot_z_N.slice(at - 12, at + 12);
    expect(shown[2 + i]).toBeGreaterThan(Math.min(...around) - 5);
    expect(shown[2 + i]).toBeLessThan(Math.max(...around) + 5);
  });

  const nodes = readTable(`${folder("trot")}/trajectory.csv`);
  const node = Math.floor(0.45 * nodes.time_s.length);
  await seek(page, nodes.time_s[node]);
  const arrows = await page.evaluate(() => window.prowl!.view!.otherArrows());
  expect(arrows.filter(({ visible }) => visible).length).toBeGreaterThan(1);
  for (const { name, visible, vector } of arrows) {
    expect(visible).toBe(nodes[`contact_${name}`][node] === 1);
    if (visible)
      ["x", "y", "z"].forEach((axis, i) =>
        expect(Math.abs(vector[i] - nodes[`f_${name}_${axis}_N`][node])).toBeLessThan(1),
      );
  }
});

const hash = (page: Page) => page.evaluate(() => location.hash);

test("the address follows the moment and the tab, and leads back to them", async ({ page, context }) => {
  await open(page, "crouch");
  expect(await hash(page)).toBe("");
  await page.getByRole("tab", { name: "Joints" }).click();
  await seek(page, 0.73);
  await expect.poll(() => hash(page)).toBe("#t=0.73&tab=Joints");
  await page.getByRole("button", { name: "Play" }).click();
  await expect.poll(() => timeOf(page)).toBeGreaterThan(0.9);
  expect(await hash(page)).toBe("#t=0.73&tab=Joints"); // not while it plays
  await page.getByRole("button", { name: "Pause" }).click();
  const stopped = await timeOf(page);
  await expect.poll(() => hash(page)).toContain(`#t=${Number(stopped.toFixed(3))}&`);

  // Turn the view, copy a link, open it elsewhere.
  await context.grantPermissions(["clipboard-read", "clipboard-write"]);
  const box = (await page.locator(".view canvas").boundingBox())!;
  await page.mouse.move(box.x + 0.9 * box.width, box.y + 0.8 * box.height);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.7 * box.height, { steps: 5 });
  await page.mouse.up();
  await page.getByRole("button", { name: "Copy link" }).click();
  await expect(page.getByRole("button", { name: "Copied" })).toBeVisible();
  const link = await page.evaluate(() => navigator.clipboard.readText());
  const camera = (one: Page) => one.evaluate(() => window.prowl!.view!.cameraPose);
  const other = await context.newPage();
  const { errors } = watch(other);
  await other.goto(link);
  await other.waitForFunction(() => window.prowl !== undefined);
  expect(Math.abs((await timeOf(other)) - stopped)).toBeLessThan(1e-3);
  await expect(other.getByRole("tab", { selected: true })).toHaveText("Joints");
  const [mine, theirs] = [await camera(page), await camera(other)];
  mine.forEach((value, i) => expect(Math.abs(value - theirs[i])).toBeLessThan(2e-3));
  expect(errors).toEqual([]);

  await other.evaluate(() => (location.hash = "#t=0.25&tab=Base"));
  await expect.poll(() => timeOf(other)).toBe(0.25);
  await expect(other.getByRole("tab", { selected: true })).toHaveText("Base");
});

test("after a click on a tab the arrow keys go on in time", async ({ page }) => {
  await open(page, "crouch");
  await page.getByRole("tab", { name: "Base" }).click();
  await page.keyboard.press("ArrowRight");
  expect(await timeOf(page)).toBeCloseTo(0.01, 9);
  await expect(page.getByRole("tab", { selected: true })).toHaveText("Base");
  await page.getByRole("tab", { name: "Base" }).focus();
  await page.keyboard.press("ArrowRight");
  await expect(page.getByRole("tab", { selected: true })).toHaveText("Joints");
  expect(await timeOf(page)).toBeCloseTo(0.01, 9);
});

for (const name of ["walk", "two", "squat"]) {
  test(`${name} at 400 px: nothing is cut, and sections are folded`, async ({ page }) => {
    await page.setViewportSize({ width: 400, height: 800 });
    await open(page, name);
    await page.waitForTimeout(200);
    const found = await page.evaluate(() => {
      const seen = (one: Element) => one.getClientRects().length > 0;
      const cut = [
        ...document.querySelectorAll<HTMLElement>("button, .layers, .readout, label, h1, h2, .summary, .badge"),
      ]
        .filter(seen)
        .filter((one) => {
          const box = one.getBoundingClientRect();
          return one.scrollWidth > one.clientWidth + 2 || box.left < -0.5 || box.right > innerWidth + 0.5;
        })
        .filter((one) => getComputedStyle(one).display !== "inline")
        .map((one) => one.outerHTML.slice(0, 90));
      const small = [...document.querySelectorAll<HTMLElement>(".label")]
        .filter((one) => parseFloat(getComputedStyle(one).fontSize) < (document.querySelector(".many") ? 8 : 10))
        .map((one) => one.textContent);
      return { cut, small, wide: document.documentElement.scrollWidth, tall: document.documentElement.scrollHeight };
    });
    expect(found.cut).toEqual([]);
    expect(found.small).toEqual([]);
    expect(found.wide).toBeLessThanOrEqual(400);
    expect(found.tall).toBeLessThan(name === "walk" ? 2600 : 6000);

    const fold = page.getByRole("button", { name: "Open Certificate" });
    await expect(page.locator("table.checks")).toBeHidden();
    await fold.click();
    await expect(page.locator("table.checks")).toBeVisible();
    await expect(page.locator("#certificate-title ~ figure.chart canvas")).toBeVisible();
    await page.getByText("layers", { exact: true }).click();
    await expect(page.getByRole("checkbox", { name: "follow" })).toBeVisible();
    await page.getByText("layers", { exact: true }).click();
    await expect(page.getByRole("checkbox", { name: "follow" })).toBeHidden();
  });
}

test("tables and commands of a section are as wide as its heading, beside no button", async ({ page }) => {
  await open(page, "walk");
  const off = await page.evaluate(() =>
    [...document.querySelectorAll("section:has(> h2 > .fold)")].flatMap((section) => {
      const heading = section.querySelector("h2")!.getBoundingClientRect();
      return [...section.querySelectorAll(":scope table, :scope > pre")].flatMap((one) => {
        const box = one.getBoundingClientRect();
        return [Math.abs(box.left - heading.left), Math.abs(box.right - heading.right)];
      });
    }),
  );
  expect(off.length).toBeGreaterThan(7);
  expect(Math.max(...off)).toBeLessThan(1);
});

test("the switches of two plans leave an edge of the view free", async ({ page }) => {
  await open(page, "two");
  const [view, layers] = await page.evaluate(() =>
    [".view", ".layers"].map((name) => document.querySelector(name)!.getBoundingClientRect().right),
  );
  expect(view - layers).toBeGreaterThan(9);
});

test("the link of a report opens at its moment", async ({ page }) => {
  await page.goto(`${pathToFileURL(report("walk")).href}#t=2.125&tab=Forces`);
  await page.waitForFunction(() => window.prowl !== undefined);
  expect(await timeOf(page)).toBe(2.125);
  await expect(page.getByRole("tab", { selected: true })).toHaveText("Forces");
});
