#include "prowl/formulations/collocation/dynamics_form.hpp"

namespace prowl {
namespace {

/// a and tau are variables, c(q, v, a, tau) = 0 rows: projected (docs/theory.md#inverse-form).
class InverseForm : public DynamicsForm {
 public:
  std::string name() const override { return "inverse"; }
  std::unique_ptr<PointFunction> at(ChartedNode& node, const Instant& instant, std::vector<int> rows) const override {
    return std::make_unique<PointFunction>(node, instant, std::move(rows));
  }
};

}  // namespace

std::unique_ptr<DynamicsForm> inverse_dynamics() { return std::make_unique<InverseForm>(); }

}  // namespace prowl
