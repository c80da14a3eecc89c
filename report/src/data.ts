// Data that `prowl report` embeds in the page (docs/report.md). Seconds, metres, newtons; world
// axes, z up.

export type Triple = [number, number, number];

export interface Phase {
  name: string;
  start: number;
  end: number;
  intervals: number;
  contacts: { contact: number; surface: number }[];
}

export interface Surface {
  name: string;
  point: Triple;
  normal: Triple;
  friction: number;
  patch: Triple[]; // corners in the world; empty for a whole plane
}

export interface Visual {
  link: string;
  body: number;
  placement: number[]; // x y z, quaternion x y z w, in the body
  kind: "box" | "sphere" | "cylinder" | "capsule" | "mesh";
  size: Triple;
  meshes: number[];
  colour: Triple | null;
}

export interface Scene {
  meshes: { positions: string; triangles: string; colour: Triple | null }[];
  visuals: Visual[];
  bodies: string[];
  contacts: { name: string; body: number; point: Triple; radius: number }[];
  surfaces: Surface[];
}

export interface MotionData {
  time: number[];
  placements: string; // times x bodies x 7
  forces: string; // times x contacts x 3
  mass_centre: string; // times x 3
}

export interface SeriesData {
  label: string;
  style: "plan" | "other" | "simulation" | "other-simulation" | "limit" | "band" | "needed";
  time: "plan" | "other" | "simulation" | "other-simulation";
  values: string;
}

export interface ChartData {
  title: string;
  unit: string;
  series: SeriesData[];
}

export interface Check {
  name: string;
  worst: number | null;
  limit: number | null;
  certified_limit: number | null;
  unit: string;
  time_s: number | null;
  where: string;
  passed: boolean;
}

export interface TextFile {
  path: string;
  text: string;
}

export interface PlanJson {
  name: string;
  status: string;
  good: boolean;
  reasons: string[];
  hints: string[];
  certificate: {
    passed: boolean;
    grade: string;
    checks: Check[];
    integration_errors: { start_s: number; end_s: number; error: number | null; where: string }[];
    redundant_contacts: string[];
    contact_ranks: { phase: string; rows: number; rank: number }[];
  };
  solver: {
    name: string;
    message: string;
    cost: number | null;
    constraint_violation: number | null;
    dual_violation: number | null;
    iterations: number;
    seconds: number;
    cpu_seconds: number;
    tolerance: number;
    max_iterations: number;
    max_time_s: number;
    warm_start: string;
    levels: { intervals: number; status: string; iterations: number; seconds: number; cpu_seconds: number }[];
    convergence?: {
      level: number[];
      iteration: number[];
      cost: (number | null)[];
      constraint_violation: (number | null)[];
      dual_violation: (number | null)[];
      seconds: number[];
    };
  };
  problem: { robot: string; variables: number; constraints: number };
  versions: Record<string, string>;
  overrides: Record<string, number>;
  task_file: TextFile;
  robot_file: TextFile;
  urdf: TextFile;
}

/// "rest" is null if the robot did not stand at the end.
export interface SimulationError {
  largest: number | null;
  rms: number | null;
  rest: number | null;
}

/// Result of MuJoCo, or of a rollout (engine "rollout"): without slip, sensors and versions, but
/// with loads of contacts.
export interface SimulationJson {
  engine: string;
  success: boolean;
  failures: string[];
  end: string;
  end_time_s: number;
  base_position_m: SimulationError;
  base_angle_rad: SimulationError;
  joints_rad: SimulationError;
  torque: { largest_share: number; joint: string; saturated_share_of_time: number; positive_work_J: number };
  slip_m?: Record<string, number>;
  contacts?: Record<string, { least_normal_force_N: number | null }>;
  options: {
    seed: number;
    control_rate_Hz: number;
    step_s: number;
    noise: { scale: number };
    delay_s: number;
    bandwidth_Hz: number;
    perfect_state: boolean;
    open_loop: boolean;
    mass_scale: number;
    friction: number | null;
    base_offset_m?: number[];
    base_offset_rad?: number[];
    pushes: { impulse_Ns: number[]; time_s: number; duration_s: number }[];
  };
  versions?: Record<string, string>;
}

export interface ReportData {
  format: number;
  directory: string;
  robot: string;
  weight_N: number;
  size_m: number;
  joints: string[];
  phases: Phase[];
  plan_json: PlanJson;
  command: string;
  simulated_friction: number | null; // of the task; null: as planned with
  scene: Scene;
  plan: MotionData;
  simulation: MotionData | null;
  simulation_json: SimulationJson | null;
  charts: { name: string; charts: ChartData[] }[];
  gains: { time: number[]; values: string } | null;
  warnings: string[];
  live: { solved: boolean } | null; // served by prowl view
  other: OtherPlan | null; // second plan, to compare
}

/// What the view shows.
export type ViewData = Pick<ReportData, "scene" | "phases" | "plan" | "simulation" | "other" | "size_m" | "weight_N">;

/// A second plan in the same page. Its scene is null if equal to the first.
export type OtherPlan = Pick<
  ReportData,
  "directory" | "robot" | "size_m" | "phases" | "plan_json" | "plan" | "simulation" | "simulation_json" | "charts"
> & { scene: Scene | null };

/// An iterate of the solver, sent by prowl view; "level" is the mesh, 0 the coarsest.
export interface Iterate {
  level: number;
  intervals: number;
  iteration: number;
  cost: number | null;
  constraint_violation: number | null;
  dual_violation: number | null;
  seconds: number;
  phases: Phase[];
  plan: MotionData;
  charts: ReportData["charts"];
}

function bytes(base64: string): ArrayBuffer {
  const text = atob(base64);
  const result = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) result[i] = text.charCodeAt(i);
  return result.buffer;
}

export const floats = (base64: string): Float32Array => new Float32Array(bytes(base64));
export const integers = (base64: string): Uint32Array => new Uint32Array(bytes(base64));

export function readData(): ReportData {
  const text = document.getElementById("prowl-data")?.textContent ?? "";
  const data = JSON.parse(text) as ReportData;
  if (data.format !== 1) throw new Error(`this page reads reports of format 1, not ${data.format}`);
  return data;
}
