#include "prowl/transcription/node/independent_contacts.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "prowl/dynamics/projector.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// What the start leaves free must leave the contacts where q_ref puts them, and still. A start at rest needs no
/// condition on its velocity.
void add_start_axes(const MotionProblem& problem, const MatrixXd& along, std::vector<LandingAxes>& axes) {
  const BoundaryConstraint& start = problem.start();
  const bool moves = !start.fixes_configuration();
  const bool speeds = !start.fixes_velocity() || (moves && !start.velocity_lower.isZero(0.0));
  if (!moves && !speeds) return;
  for (const int row : independent_rows(MatrixXd(0, along.cols()), along)) {
    if (moves) axes[row / 3].foothold.push_back(row % 3);
    if (speeds) axes[row / 3].velocity.push_back(row % 3);
  }
}

}  // namespace

std::vector<int> independent_rows(const MatrixXd& given, const MatrixXd& candidates) {
  if (candidates.rows() == 0) return {};
  // Part of the candidates orthogonal to the given rows.
  MatrixXd rest = candidates.transpose();
  double largest = candidates.rowwise().norm().maxCoeff();
  if (given.rows() > 0) {
    Eigen::ColPivHouseholderQR<MatrixXd> qr(given.transpose());
    qr.setThreshold(Projector::kRankThreshold);
    MatrixXd span = MatrixXd::Identity(given.cols(), qr.rank());
    span.applyOnTheLeft(qr.householderQ().setLength(qr.rank()));
    rest -= span * (span.transpose() * rest).eval();
    largest = std::max(largest, given.rowwise().norm().maxCoeff());
  }
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(rest);
  std::vector<int> rows;
  for (Index i = 0; i < std::min(rest.rows(), rest.cols()); ++i) {
    if (std::abs(qr.matrixQR()(i, i)) <= Projector::kRankThreshold * largest) break;
    rows.push_back(static_cast<int>(qr.colsPermutation().indices()(i)));
  }
  std::ranges::sort(rows);
  return rows;
}

MatrixXd along_surfaces(const MotionProblem& problem, const std::vector<PhaseContact>& contacts, const MatrixXd& J) {
  MatrixXd along(J.rows(), J.cols());
  for (Index i = 0; i < std::ssize(contacts); ++i) {
    const Surface& surface = problem.surfaces[contacts[static_cast<std::size_t>(i)].surface];
    along.middleRows<3>(3 * i) = surface.frame().transpose() * J.middleRows<3>(3 * i);
  }
  return along;
}

PhaseContacts phase_contacts(const DiscreteProblem& discrete, int phase, const Eigen::VectorXd& q) {
  const MotionProblem& problem = discrete.problem;
  const auto& held = problem.phases[phase].contacts;
  const int nv = problem.robot.nv(), num_contacts = static_cast<int>(held.size());
  std::vector<int> staying, landing;
  for (int i = 0; i < num_contacts; ++i) (discrete.schedule.lands(phase, i) ? landing : staying).push_back(i);
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(q);
  ContactKinematics kinematics(contact_indices(held));
  kinematics.set_configuration(terms);
  const MatrixXd& J = kinematics.jacobian();
  const auto rows_of = [&](const std::vector<int>& which) {
    std::vector<int> rows;
    for (const int i : which) rows.insert(rows.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    return rows;
  };
  const std::vector<int> staying_rows = rows_of(staying), landing_rows = rows_of(landing);
  const MatrixXd J_staying = J(staying_rows, Eigen::all), J_landing = J(landing_rows, Eigen::all);

  std::vector<bool> is_kept(static_cast<std::size_t>(J.rows()), false);
  for (const int row : independent_rows(MatrixXd(0, nv), J_staying)) {
    is_kept[staying_rows[row]] = true;
  }
  for (const int row : independent_rows(J_staying, J_landing)) {
    is_kept[landing_rows[row]] = true;
  }
  PhaseContacts result;
  for (int row = 0; row < static_cast<int>(J.rows()); ++row) {
    if (!is_kept[row]) result.chosen_rows.push_back(row);
  }

  // The same for the landing conditions along the axes of the surfaces. Footholds along the surface
  // are variables, too, unless prescribed.
  result.landing.resize(held.size());
  const int num_landing = static_cast<int>(landing.size());
  const MatrixXd along = along_surfaces(problem, held, J), velocity = along(landing_rows, Eigen::all);
  MatrixXd foothold = MatrixXd::Zero(3 * num_landing, nv + 2 * num_landing);
  foothold.leftCols(nv) = velocity;
  for (int l = 0; l < num_landing; ++l) {
    if (!held[landing[l]].foothold) foothold.block<2, 2>(3 * l, nv + 2 * l) = -Eigen::Matrix2d::Identity();
  }
  for (const int row : independent_rows(J_staying, velocity)) {
    result.landing[landing[row / 3]].velocity.push_back(row % 3);
  }
  MatrixXd staying_wide = MatrixXd::Zero(J_staying.rows(), foothold.cols());
  staying_wide.leftCols(nv) = J_staying;
  for (const int row : independent_rows(staying_wide, foothold)) {
    result.landing[landing[row / 3]].foothold.push_back(row % 3);
  }
  // The end of a cycle, whose contacts have landed, says where those of its start are.
  if (phase == 0 && !problem.cycle) add_start_axes(problem, along, result.landing);
  return result;
}

}  // namespace prowl
