#include "prowl/simulation/start_state.hpp"

#include <Eigen/QR>
#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

constexpr int kIterations = 20;     // of Newton's method: errors are centimetres
constexpr double kStanding = 1e-3;  // [m]; feet of a plan are so near
constexpr double kTouching = 1e-7;  // [m]

struct Foot {
  int contact;
  Eigen::Vector3d place;
};

}  // namespace

void displace(Physics& physics, const std::vector<Surface>& ground, const std::vector<int>& holds,
              const StartError& error, Eigen::VectorXd& q, Eigen::VectorXd& v) {
  const Eigen::Index nu = v.size() - 6;
  const std::vector<Eigen::Vector3d> planned = physics.contact_positions(q);
  std::vector<Foot> feet;
  bool is_off = !error.is_none();
  for (std::size_t c = 0; c < holds.size(); ++c) {
    if (holds[c] < 0) continue;
    const Surface& surface = ground[static_cast<std::size_t>(holds[c])];
    const double gap = surface.distance(planned[c]) - physics.contact_radius(static_cast<int>(c));
    is_off = is_off || std::abs(gap) > kStanding;
    feet.push_back({static_cast<int>(c), planned[c] - gap * surface.normal});
  }
  if (!is_off) return;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(v.size());
  step.head<6>() = error.base;
  if (error.joints.size() > 0) step.tail(nu) = error.joints;
  q = integrate(q, step);
  v.head<6>() += error.twist;

  const auto rows = static_cast<Eigen::Index>(3 * feet.size());
  Eigen::MatrixXd jacobian(rows, v.size());
  Eigen::VectorXd off(rows);
  const auto linearise = [&] {
    const std::vector<Eigen::Vector3d> places = physics.contact_positions(q);
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * i);
      off.segment<3>(row) = feet[i].place - places[static_cast<std::size_t>(feet[i].contact)];
      jacobian.middleRows<3>(row) = physics.contact_jacobian(feet[i].contact);
    }
  };
  for (int i = 0; i < kIterations && rows > 0; ++i) {
    linearise();
    if (off.cwiseAbs().maxCoeff() < kTouching) break;
    q.tail(nu) += jacobian.rightCols(nu).completeOrthogonalDecomposition().solve(off);
  }
  if (rows == 0) return;
  linearise();
  v.tail(nu) -= jacobian.rightCols(nu).completeOrthogonalDecomposition().solve(jacobian * v);
}

}  // namespace prowl
