// Where things are in the scene, against the plan's own files.
import { expect, test } from "@playwright/test";
import { basePlacement, linkPlacement } from "./kinematics";
import { folder, open, readTable, seek } from "./reports";

const kTolerance = 1e-3; // [m], and of a quaternion's entries

/// The same rotation has two quaternions.
function expectPlacement(found: number[], expected: number[]): void {
  const sign = Math.sign(found.slice(3).reduce((sum, value, i) => sum + value * expected[3 + i], 0));
  expected.forEach((value, i) => expect(Math.abs(found[i] - (i < 3 ? value : sign * value))).toBeLessThan(kTolerance));
}

for (const { name, contact, link } of [
  { name: "crouch", contact: "lf_foot", link: "lf_foot" },
  { name: "step", contact: "rh_foot", link: "rh_foot" },
  { name: "walk", contact: "lh_foot", link: "lh_foot" },
]) {
  test(`${name}: base and foot are where the plan has them`, async ({ page, context }) => {
    await open(page, name);
    const nodes = readTable(`${folder(name)}/trajectory.csv`);
    const other = await context.newPage();
    const rows = [0, Math.floor(nodes.time_s.length / 3), nodes.time_s.length - 1];
    let moved = 0;
    for (const row of rows) {
      await seek(page, nodes.time_s[row]);
      const base = await page.evaluate(() => window.prowl!.view!.bodyPlacement("base"));
      expectPlacement(base, basePlacement(nodes, row));
      const foot = await page.evaluate((wanted) => {
        const { view, data } = window.prowl!;
        return view!.contactPoint(data.scene.contacts.findIndex((one) => one.name === wanted)).toArray();
      }, contact);
      const expected = await linkPlacement(other, name, nodes, row, link);
      foot.forEach((value, i) => expect(Math.abs(value - expected[i])).toBeLessThan(kTolerance));
      moved = Math.max(moved, Math.abs(base[0] - nodes.base_px_m[0]) + Math.abs(base[2] - nodes.base_pz_m[0]));
    }
    expect(moved, "a robot that stands still proves nothing").toBeGreaterThan(0.02);
  });
}

for (const name of ["crouch", "step", "walk", "squat"]) {
  test(`${name}: feet that stand are on the floor and stay`, async ({ page }) => {
    await open(page, name);
    const feet = await page.evaluate(() => {
      const { view, clock, data } = window.prowl!;
      const found: { height: number; slid: number }[] = [];
      for (const phase of data.phases) {
        for (const { contact, surface } of phase.contacts) {
          const { point, normal } = data.scene.surfaces[surface];
          const places = [0, 0.25, 0.5, 0.75, 0.999].map((share) => {
            clock.seek(phase.start + share * (phase.end - phase.start));
            return view!.contactPoint(contact).toArray();
          });
          for (const place of places) {
            const height =
              place.reduce((sum, value, i) => sum + (value - point[i]) * normal[i], 0) -
              data.scene.contacts[contact].radius;
            found.push({ height, slid: Math.hypot(...place.map((value, i) => value - places[0][i])) });
          }
        }
      }
      return found;
    });
    expect(feet.length).toBeGreaterThan(10);
    for (const { height, slid } of feet) {
      expect(Math.abs(height)).toBeLessThan(kTolerance);
      expect(slid).toBeLessThan(kTolerance);
    }
  });
}

test("step: the ghost is where the simulation was", async ({ page }) => {
  await open(page, "step");
  const simulated = readTable(`${folder("step")}/simulate.csv`);
  const rows = [10, Math.floor(simulated.time_s.length / 2), simulated.time_s.length - 1];
  let apart = 0;
  for (const row of rows) {
    await seek(page, simulated.time_s[row]);
    const ghost = await page.evaluate(() => window.prowl!.view!.bodyPlacement("base", true));
    const plan = await page.evaluate(() => window.prowl!.view!.bodyPlacement("base"));
    expectPlacement(ghost, basePlacement(simulated, row, "true_"));
    apart = Math.max(apart, Math.hypot(...[0, 1, 2].map((i) => ghost[i] - plan[i])));
  }
  expect(apart, "a ghost that is the plan proves nothing").toBeGreaterThan(5e-4);
});
