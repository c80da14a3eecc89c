// Forward kinematics by urdf-loader and three.js: nothing of Pinocchio's, nothing of the report's.
import { buildSync } from "esbuild";
import { readFileSync } from "node:fs";
import path from "node:path";
import type { Page } from "@playwright/test";
import { folder, root, type Table } from "./reports";

const kScript = `
  import URDFLoader from "urdf-loader";
  import { Quaternion, Vector3 } from "three";
  window.linkPlacement = (urdf, base, joints, link) => {
    const loader = new URDFLoader();
    loader.parseVisual = loader.parseCollision = false;
    const robot = loader.parse(urdf);
    robot.position.fromArray(base, 0);
    robot.quaternion.fromArray(base, 3);
    for (const [name, value] of Object.entries(joints)) robot.setJointValue(name, value);
    robot.updateMatrixWorld(true);
    const position = new Vector3(), rotation = new Quaternion();
    robot.links[link].matrixWorld.decompose(position, rotation, new Vector3());
    return [...position.toArray(), ...rotation.toArray()];
  };`;

declare global {
  interface Window {
    linkPlacement: (urdf: string, base: number[], joints: Record<string, number>, link: string) => number[];
  }
}

/// Placement of a link (x y z, quaternion x y z w) at a row of the plan's trajectory.csv, in a page of its own.
export async function linkPlacement(
  page: Page,
  report: string,
  nodes: Table,
  row: number,
  link: string,
): Promise<number[]> {
  const built = buildSync({
    stdin: { contents: kScript, resolveDir: path.join(root, "report") },
    bundle: true,
    write: false,
    format: "iife",
  });
  const plan = JSON.parse(readFileSync(path.join(folder(report), "plan.json"), "utf8"));
  const joints = Object.fromEntries(plan.problem.joints.map((name: string) => [name, nodes[`q_${name}_rad`][row]]));
  await page.goto("about:blank");
  await page.addScriptTag({ content: built.outputFiles[0].text });
  return page.evaluate(([urdf, base, values, name]) => window.linkPlacement(urdf, base, values, name), [
    plan.urdf.text,
    basePlacement(nodes, row),
    joints,
    link,
  ] as const);
}

export const basePlacement = (table: Table, row: number, prefix = ""): number[] =>
  ["px_m", "py_m", "pz_m", "qx", "qy", "qz", "qw"].map((name) => table[`${prefix}base_${name}`][row]);
