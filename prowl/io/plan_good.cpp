#include "prowl/io/plan_directory.hpp"

namespace prowl {

bool is_good(const Plan& plan) { return plan.result.status == SolveStatus::converged && plan.certificate.passed; }

}  // namespace prowl
