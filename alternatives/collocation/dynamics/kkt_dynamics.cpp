#include "alternatives/collocation/dynamics/dynamics_form.hpp"

namespace prowl {
namespace {

/// a, tau and f are variables, M a + h − S' tau − J' f = 0 and J a + J̇ v = 0 rows. With all forces
/// as variables no row of J remains for the projection: the rows of the node are the unprojected
/// dynamics.
class KktForm : public DynamicsForm {
 public:
  bool has_forces() const override { return true; }
};

}  // namespace

std::unique_ptr<DynamicsForm> kkt_dynamics() { return std::make_unique<KktForm>(); }

}  // namespace prowl
