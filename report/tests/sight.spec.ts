// What the view shows: the whole motion, layers, what a click is on, and its video.
import { readFileSync } from "node:fs";
import { expect, type Page, test } from "@playwright/test";
import { folder, open, readTable, seek, timeOf } from "./reports";

const layer = (page: Page, name: string) => page.getByRole("checkbox", { name, exact: true });
const endOf = (page: Page) => page.evaluate(() => window.prowl!.clock.end);
const screenBox = (page: Page) => page.evaluate(() => window.prowl!.view!.screenBox());

for (const [width, height] of [
  [1440, 900],
  [400, 800],
]) {
  test(`the whole walk is in the first picture, ${width} px`, async ({ page }) => {
    await page.setViewportSize({ width, height });
    await open(page, "walk");
    await page.waitForTimeout(200);
    const end = await endOf(page);
    let outermost = 0;
    for (let share = 0; share <= 1; share += 0.05) {
      await seek(page, share * end);
      const { left, right, bottom, top } = await screenBox(page);
      for (const edge of [left, right, bottom, top]) expect(Math.abs(edge)).toBeLessThan(0.95);
      outermost = Math.max(outermost, -left, right, -bottom, top);
    }
    // On a low picture the switches take a fifth of it.
    expect(outermost, "a robot far away is easily inside").toBeGreaterThan(width > 900 ? 0.7 : 0.5);
  });
}

test("follow moves to the robot and stays with it; reset view shows all again", async ({ page }) => {
  await open(page, "walk");
  const end = await endOf(page);
  await seek(page, 0.9 * end);
  const before = await screenBox(page);
  const centre = async () => {
    const { left, right } = await screenBox(page);
    return Math.abs(left + right) / 2;
  };
  expect(await centre()).toBeGreaterThan(0.1);
  await layer(page, "follow").check();
  await expect.poll(centre).toBeLessThan(0.1);
  const near = await screenBox(page);
  expect(near.right - near.left).toBeGreaterThan(1.15 * (before.right - before.left));
  for (const share of [0.1, 0.5, 0.9]) {
    await seek(page, share * end);
    expect(await centre()).toBeLessThan(0.2);
  }
  await layer(page, "follow").uncheck();
  await page.getByRole("button", { name: "reset view" }).click();
  await expect.poll(async () => Math.abs((await screenBox(page)).right - before.right)).toBeLessThan(0.02);
});

test("arrows of the simulation stand beside those of the plan", async ({ page }) => {
  await open(page, "step");
  const simulated = readTable(`${folder("step")}/simulate.csv`);
  const row = Math.floor(0.3 * simulated.time_s.length);
  await seek(page, simulated.time_s[row]);
  const arrows = await page.evaluate(() => window.prowl!.view!.simulatedArrows());
  expect(arrows.filter(({ visible }) => visible).length).toBeGreaterThan(2);
  for (const { name, visible, vector } of arrows) {
    if (!visible) continue;
    const around = simulated[`f_${name}_z_N`].slice(row - 12, row + 12); // the report has fewer samples than the file
    expect(vector[2]).toBeGreaterThan(Math.min(...around) - 5);
    expect(vector[2]).toBeLessThan(Math.max(...around) + 5);
  }
});

/// Signed area of a polygon seen from above, and whether a point is inside of it (or as near as `slack`).
function isInside(corners: number[][], [x, y]: number[], slack: number): boolean {
  return corners.every((a, i) => {
    const b = corners[(i + 1) % corners.length];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    return ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / length > -slack;
  });
}

test("the zero-moment point is inside the support polygon of three or four feet", async ({ page }) => {
  await open(page, "walk");
  for (const name of ["centre of mass", "support", "ZMP"]) await layer(page, name).check();
  const end = await page.evaluate(() => window.prowl!.data.phases.at(-1)!.end);
  let moved = 0;
  let first: number[] | null = null;
  for (let share = 0.02; share < 1; share += 0.07) {
    await seek(page, share * end);
    const { corners, zmp } = await page.evaluate(() => window.prowl!.view!.balanceNow());
    expect(corners.length).toBeGreaterThanOrEqual(3);
    expect(zmp).not.toBeNull();
    expect(isInside(corners, zmp!, 1e-3)).toBe(true);
    expect(Math.abs(zmp![2])).toBeLessThan(1e-3);
    first ??= zmp;
    moved = Math.max(moved, Math.hypot(zmp![0] - first![0], zmp![1] - first![1]));
  }
  expect(moved).toBeGreaterThan(0.1);
  await layer(page, "ZMP").uncheck();
  expect(await page.evaluate(() => window.prowl!.view!.balanceNow().zmp)).toBeNull();
});

test("the centre of mass moves as the forces say: m a = Σ f + m g", async ({ page }) => {
  await open(page, "crouch");
  const { errors, largest } = await page.evaluate(() => {
    const { data } = window.prowl!;
    const array = (text: string) => new Float32Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
    const { time, mass_centre, forces } = data.plan;
    const [centres, all] = [array(mass_centre), array(forces)];
    const contacts = data.scene.contacts.length;
    const g = 9.81;
    const errors: number[] = [];
    let largest = 0;
    // Over 0.2 s, so that the rounding of 32-bit floats does not matter: positions at three times, mean force between.
    const span = 0.1;
    const at = (t: number) => {
      const i = time.findIndex((one) => one >= t - 1e-9);
      const share = i === 0 ? 0 : (t - time[i - 1]) / (time[i] - time[i - 1]);
      return [0, 1, 2].map((k) =>
        i === 0 ? centres[k] : centres[3 * (i - 1) + k] * (1 - share) + centres[3 * i + k] * share,
      );
    };
    const load = (t: number) => {
      const i = time.findIndex((one) => one >= t - 1e-9);
      let sum = 0;
      for (let c = 0; c < contacts; ++c) sum += all[3 * (i * contacts + c) + 2];
      return sum;
    };
    for (let t = 0.2; t < 1.8; t += 0.1) {
      const [before, now, after] = [at(t - span), at(t), at(t + span)];
      const acceleration = (before[2] - 2 * now[2] + after[2]) / span ** 2;
      // The second difference is the acceleration's mean with a triangle for its weight.
      let mean = 0;
      let weights = 0;
      for (let s = -0.09; s < 0.095; s += 0.01) {
        mean += (span - Math.abs(s)) * load(t + s);
        weights += span - Math.abs(s);
      }
      const expected = (mean / weights / data.weight_N - 1) * g;
      errors.push(Math.abs(acceleration - expected));
      largest = Math.max(largest, Math.abs(expected));
    }
    return { errors, largest };
  });
  expect(largest).toBeGreaterThan(0.3); // [m/s²]
  for (const error of errors) expect(error).toBeLessThan(0.03);
});

test("a click on a leg shows its joint's series, on a foot its forces, on the ground none", async ({ page }) => {
  await open(page, "crouch");
  await page.waitForTimeout(300);
  const pixel = (place: "foot" | "trunk" | "nothing") =>
    page.evaluate((wanted) => {
      const { view, data } = window.prowl!;
      const box = view!.canvas.getBoundingClientRect();
      if (wanted === "nothing") return { x: box.right - 20, y: box.bottom - 20 };
      if (wanted === "trunk") {
        const [x, y, z] = view!.bodyPlacement("base");
        return view!.screenPoint(view!.contactPoint(0).set(x, y, z));
      }
      const foot = view!.contactPoint(data.scene.contacts.findIndex((one) => one.name === "lf_foot"));
      return view!.screenPoint(foot);
    }, place);
  const titles = () => page.locator(".plots figure.chart .title").allTextContents();
  const click = async (place: "foot" | "trunk" | "nothing") => {
    const { x, y } = await pixel(place);
    await page.mouse.click(x, y);
  };
  await click("foot");
  await expect(page.getByRole("tab", { selected: true })).toHaveText("lf_foot");
  expect(await titles()).toEqual([
    "Forces: lf_foot x",
    "Forces: lf_foot y",
    "Forces: lf_foot z",
    "Margins: friction, lf_foot",
  ]);
  await expect(page.locator(".picked")).toHaveText("contact lf_foot");

  // Half-way up the shin: no foot is near.
  const shin = await page.evaluate(() => {
    const { view, data } = window.prowl!;
    const foot = view!.contactPoint(data.scene.contacts.findIndex((one) => one.name === "lf_foot"));
    const knee = view!.bodyPlacement("lf_kfe_joint");
    return view!.screenPoint(foot.lerp(foot.clone().fromArray(knee), 0.55));
  });
  await page.mouse.click(shin.x, shin.y);
  await expect(page.getByRole("tab", { selected: true })).toHaveText("lf_kfe_joint");
  expect(await titles()).toEqual(["Torques: lf_kfe_joint", "Joints: lf_kfe_joint", "Rates: lf_kfe_joint"]);

  await click("trunk");
  await expect(page.getByRole("tab", { selected: true })).toHaveText("base");
  expect(await titles()).toHaveLength(12);
  await click("nothing");
  await expect(page.locator(".picked")).toBeHidden();

  // A drag turns the view and picks nothing.
  const { x, y } = await pixel("trunk");
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 60, y + 10, { steps: 4 });
  await page.mouse.up();
  await expect(page.locator(".picked")).toBeHidden();
});

test("Record plays the motion once and saves a video that a browser plays", async ({ page, context }) => {
  await open(page, "crouch");
  await page.getByRole("combobox", { name: "Speed" }).selectOption("2");
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Record" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
  const file = await saved;
  expect(file.suggestedFilename()).toBe("HyQ_crouch.webm");
  const bytes = readFileSync(await file.path());
  expect([...bytes.subarray(0, 4)]).toEqual([0x1a, 0x45, 0xdf, 0xa3]); // EBML
  expect(await timeOf(page)).toBe(await endOf(page));
  await expect(page.getByRole("button", { name: "Record" })).toBeVisible();

  const other = await context.newPage();
  await other.setContent("<video muted></video>");
  const shown = await other.evaluate(
    async (source) => {
      const video = document.querySelector("video")!;
      video.src = source;
      await video.play();
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [video.videoWidth, video.videoHeight];
      const pixels = () => {
        const drawing = canvas.getContext("2d")!;
        drawing.drawImage(video, 0, 0);
        return drawing.getImageData(0, 0, canvas.width, canvas.height).data;
      };
      const first = pixels();
      let changed = 0; // pixels that are not as at the beginning, at the moment with most of them
      while (!video.ended) {
        await new Promise((resolve) => setTimeout(resolve, 100));
        const later = pixels();
        let count = 0;
        for (let i = 0; i < first.length; i += 4) if (Math.abs(first[i] - later[i]) > 25) ++count;
        changed = Math.max(changed, count);
      }
      return { width: video.videoWidth, height: video.videoHeight, changed };
    },
    `data:video/webm;base64,${bytes.toString("base64")}`,
  );
  const canvas = await page.evaluate(() => {
    const { width, height } = window.prowl!.view!.canvas;
    return { width, height };
  });
  expect(shown).toMatchObject(canvas);
  expect(shown.changed, "the robot moves").toBeGreaterThan(500);
});

test("Stop saves what was recorded so far", async ({ page }) => {
  await open(page, "walk");
  await page.getByRole("button", { name: "Record" }).click();
  await page.waitForTimeout(700);
  const saved = page.waitForEvent("download");
  await page.getByRole("button", { name: "Stop" }).click();
  expect(readFileSync(await (await saved).path()).length).toBeGreaterThan(5000);
  expect(await timeOf(page)).toBeLessThan(await endOf(page));
});
