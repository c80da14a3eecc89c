// Plans, simulates and reports what the tests look at, with the command that was built.
import { spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import path from "node:path";
import { command, folder, report, root, work } from "./reports";

// Names may be any ASCII without quotes; comments and paths may be anything.
export const kOddName = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=2>";
export const kOddText = `<!-- "quoted" & 'odd' </script><script>window.hacked = "3"</script>`;

function prowl(parameters: string[], status = 0): void {
  const found = spawnSync(command, parameters, { cwd: root, encoding: "utf8" });
  if (found.status !== status)
    throw new Error(`prowl ${parameters.join(" ")}: status ${found.status}\n${found.stdout}${found.stderr}`);
}

function make(name: string, task: string, simulated: boolean, ...options: string[]): void {
  prowl(["plan", task, "--out", folder(name)]);
  if (simulated) prowl(["simulate", folder(name), ...options]);
  prowl(["report", folder(name)]);
}

/// With a push that takes it a part of its tube from the plan.
function makeRobust(): void {
  prowl(["plan", "tasks/hyq/step.toml", "--robust", "--out", folder("robust")]);
  prowl(["simulate", folder("robust"), "--push", "0.3", "0", "5", "0"]);
  prowl(["report", folder("robust")]);
}

/// HyQ's crouch, asked to go lower than it can.
function makeFailed(): void {
  const task = readFileSync(path.join(root, "tasks/hyq/crouch.toml"), "utf8")
    .replace(/^robot = .*$/m, () => `robot = "${path.join(root, "robots/hyq.toml")}"`)
    .replace("base_displacement_m = [0, 0, -0.17]", "base_displacement_m = [0, 0, -0.45]")
    .replace("base_rpy_rad = [0, 0, 0]", 'base_rpy_rad = [0, 0, "free"]'); // so that there is no proof
  const file = path.join(work, "too_low.toml");
  writeFileSync(file, task);
  prowl(["plan", file, "--out", folder("failed")], 3);
  prowl(["report", folder("failed")]);
}

/// HyQ's stand, with names and comments that try to be markup, from a folder with quotes in its name.
function makeOdd(): void {
  const quoted = JSON.stringify(kOddName); // a basic string of TOML, too
  const from = path.join(work, `odd "task" & 'more'`);
  const robot = readFileSync(path.join(root, "robots/hyq.toml"), "utf8").replace(
    /^name = .*$/m,
    () => `name = ${quoted}`,
  );
  const task = readFileSync(path.join(root, "tasks/hyq/stand.toml"), "utf8")
    .replace(/^name = .*$/m, () => `# ${kOddText}\nname = ${quoted}`)
    .replace(/^robot = .*$/m, () => `robot = "robot.toml"`)
    .replace(/^\[\[phase\]\]$/m, () => `[[phase]]\nname = ${quoted}`);
  mkdirSync(from, { recursive: true });
  writeFileSync(path.join(from, "robot.toml"), robot);
  writeFileSync(path.join(from, "task.toml"), task);
  make("odd", path.join(from, "task.toml"), false);
}

export default function (): void {
  if (process.env.PROWL_REPORT_REUSE) return; // while working on the tests
  rmSync(work, { recursive: true, force: true });
  mkdirSync(work, { recursive: true });
  make("crouch", "tasks/hyq/crouch.toml", true);
  make("step", "tasks/hyq/step.toml", true);
  make("walk", "tasks/hyq/walk.toml", true);
  make("trot", "tasks/hyq/trot.toml", true);
  make("squat", "tasks/talos/squat.toml", true);
  make("rollout", "tasks/hyq/stand.toml", true, "--engine", "rollout");
  makeOdd();
  makeRobust();
  makeFailed();
  mkdirSync(folder("two"));
  prowl(["report", folder("walk"), folder("trot"), "--out", report("two")]);
}
