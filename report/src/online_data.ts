// Data that `prowl mpc` embeds in its page. Seconds, metres, newtons; world axes, z up.
import type { MotionData, Phase, Triple, ViewData } from "./data";

export interface TickTimes {
  median: number;
  p99: number;
  longest: number;
}

export interface OnlineResult {
  success: boolean;
  end: string;
  end_time_s: number;
  failures: string[];
  notes: string[];
  velocity_error_mps: number;
  turn_error_radps: number;
  plans: number;
  failed_plans: number;
  dropped_plans: number;
  forces: Record<"undisturbed" | "kicked", { plans: number; outside: number }>;
  plan_ms: TickTimes;
  feedback_ms: TickTimes;
}

export interface OnlineData extends Pick<ViewData, "scene" | "phases" | "plan" | "size_m" | "weight_N"> {
  robot: string;
  mass_kg: number;
  gait: string;
  gaits: string[];
  period_s: number;
  budget_s: number;
  height: string; // of the base, over plan.time
  moves: { title: string; unit: string; commanded: string; measured: string }[]; // over plan.time
  pushes: { time: number; duration: number; impulse: Triple }[];
  times_ms: string; // computing time of each plan, one every period
  result: OnlineResult | null; // null while the run goes on
  live: boolean;
  warnings: string[];
}

/// One moment of a run that goes on.
export interface OnlineMoment {
  time: number;
  plan: MotionData;
  phases: Phase[];
  commanded: Triple;
  measured: Triple;
}
