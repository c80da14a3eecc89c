// Checks of a tracking plan before a control loop relies on it.
#include <cmath>
#include <string>

#include "prowl/tracker/tracker.hpp"

namespace prowl {
namespace {

void need(bool condition, const std::string& message) {
  if (!condition) throw TrackerError("tracking plan: " + message);
}

void check_matrix(const Eigen::MatrixXd& matrix, Eigen::Index rows, Eigen::Index cols, const std::string& name) {
  need(matrix.rows() == rows && matrix.cols() == cols, name + " has " + std::to_string(matrix.rows()) + " x " +
                                                           std::to_string(matrix.cols()) + " numbers; need " +
                                                           std::to_string(rows) + " x " + std::to_string(cols));
  need(matrix.allFinite(), name + " contains NaN or infinity");
}

void check_segments(const TrackingPlan& plan) {
  need(!plan.segments.empty(), "no segment; need one or more");
  long next = 0;
  for (const TrackingPlan::Segment& segment : plan.segments) {
    const std::string name = "segment \"" + segment.name + "\": ";
    need(std::isfinite(segment.start) && std::isfinite(segment.end) && segment.start < segment.end,
         name + "must end after its start");
    need(&segment == &plan.segments.front() || segment.start == (&segment)[-1].end,
         name + "must start where the previous one ends");
    need(segment.samples >= 2 && segment.first_sample == next,
         name + "need 2 samples or more, directly after the previous ones");
    need(segment.in_contact.size() == plan.contact_names.size(), name + "need one flag per contact");
    next += segment.samples;
  }
  need(next == plan.num_samples(), "the segments do not cover all samples");
}

void check_limits(const TrackingPlan& plan) {
  need(plan.torque_limit.size() == plan.nu(), "need one torque limit per joint");
  need((plan.torque_limit.array() >= 0.0).all(), "a torque limit is negative or NaN");
  for (const TrackingPlan::TorqueCurve& curve : plan.torque_curves) {
    need(curve.joint >= 0 && curve.joint < plan.nu(), "a torque curve names a joint that does not exist");
    need(std::isfinite(curve.lower) && std::isfinite(curve.upper) && curve.lower < curve.upper,
         "a torque curve has an empty range");
    need(curve.values.size() >= 2 && curve.values.allFinite() && (curve.values.array() >= 0.0).all(),
         "a torque curve needs 2 or more values >= 0");
  }
}

}  // namespace

Tracker::Tracker(TrackingPlan plan) : plan_(std::move(plan)) {
  need(plan_.nu() > 0, "no joint");
  need(plan_.nv() <= kMostVelocities, "more than " + std::to_string(kMostVelocities - 6) + " joints");
  check_segments(plan_);
  check_limits(plan_);
  const Eigen::Index samples = plan_.num_samples();
  check_matrix(plan_.q, plan_.nq(), samples, "q");
  check_matrix(plan_.v, plan_.nv(), samples, "v");
  check_matrix(plan_.tau, plan_.nu(), samples, "tau");
  check_matrix(plan_.gains, 2L * plan_.nu() * plan_.nv(), samples, "gains");
  constexpr double kUnit = 1e-6;
  const Eigen::ArrayXd lengths = plan_.q.middleRows<4>(3).colwise().norm();
  need(((lengths - 1.0).abs() < kUnit).all(), "a quaternion is not of unit length");
}

}  // namespace prowl
