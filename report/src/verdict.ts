import type { Check, PlanJson } from "./data";

const kLimits: Record<string, string> = {
  iteration_limit: "out of iterations",
  time_limit: "out of time",
  interrupted: "interrupted",
  evaluation_failed: "an evaluation failed",
  solver_failed: "the solver failed",
  infeasible: "no motion satisfies all constraints",
};

/// Purpose of each grade, with the limits of the local integration error (CertificateLimits).
export const kGrades: Record<string, string> = {
  draft: "draft: good for simulation, integration error below 1e-4",
  certified: "certified: integration error below 1e-6",
  failed: "failed: a check exceeds its limit",
};

export const failedChecks = (plan: PlanJson): Check[] => plan.certificate.checks.filter((check) => !check.passed);

/// Short reason why a plan is not good; "" if it is good.
export function whyNot(plan: PlanJson): string {
  if (plan.good) return "";
  const proof = plan.reasons.find((reason) => reason.includes("out of reach"));
  if (proof) return proof.startsWith("goal") ? "goal out of reach" : "a contact is out of reach";
  if (plan.reasons.length > 0 && plan.status === "infeasible") return "the task cannot be done";
  const failed = failedChecks(plan);
  // A doubt, not a proof: the guess misses its footholds. What the last iterate of such a solve misses says less.
  if (plan.hints.some((hint) => hint.startsWith("goal"))) return "goal seems out of reach";
  if (failed.some((check) => check.name.startsWith("goal"))) return "goal not reached";
  if (plan.status !== "converged") return kLimits[plan.status] ?? plan.status.replaceAll("_", " ");
  return failed.length === 1 ? `${failed[0].name} exceeds its limit` : `${failed.length} checks failed`;
}
