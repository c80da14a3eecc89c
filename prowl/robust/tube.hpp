#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/inertia_errors.hpp"
#include "prowl/motion/contact_schedule.hpp"
#include "prowl/motion/disturbances.hpp"
#include "prowl/motion/margins.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracking/feedback_design.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Deviations of the closed loop from a motion under disturbances, to first order. Each disturbance is drawn once:
/// start, masses, ground, error of the estimate, and one push in any direction at any time.
struct Tube {
  /// Of one phase of the motion, one column for each of its samples.
  struct OfPhase {
    std::vector<double> times;    ///< [s]
    Eigen::MatrixXd state;        ///< dx, standard deviation (2 nv rows) [m, rad, m/s, rad/s]
    Margins::OfPhase needed;      ///< of the limits: docs/robust.md#margins
    Eigen::MatrixXd friction;     ///< what each cone loses where friction is missing [N]
    Eigen::MatrixXd cone_left;    ///< distance of each contact's force from its full cone [N]
    Eigen::MatrixXd torque_left;  ///< distance from the torque limits, nu rows [N m]
    Eigen::MatrixXd height;       ///< of each contact of the robot in the air, above its surfaces; else infinite [m]

    /// Band of dx that 95 % of the cases stay in (2 nv rows): two standard deviations.
    Eigen::MatrixXd band() const;
    /// Margin to the full cones, for deviations and missing friction [N].
    Eigen::MatrixXd cone_needed() const { return needed.cone + friction; }
  };
  std::vector<OfPhase> phases;
};

/// Propagates deviations through the closed loop of design_feedback() along the motion.
class TubeDesign {
 public:
  /// `motion`, `tracking`: of the design.
  TubeDesign(const MotionProblem& problem, const Trajectory& motion, const TrackingOptions& tracking,
             const Disturbances& disturbances);

  /// Takes a sample of the backward pass, last first.
  void add(const ReducedSample& sample);
  /// Once the first sample of the motion is in: forward to its end.
  Tube propagate() const;

 private:
  /// Deviations xi and limits at one sample. Limits: rows of the cones of its contacts | torques | joints | heights of
  /// the contacts of the robot.
  struct Sample {
    double time;
    Eigen::MatrixXd Z, step;                ///< of ReducedSample
    Eigen::MatrixXd drift, push;            ///< d xi/dt by what is constant, and by a push along x and y
    Eigen::MatrixXd limits;                 ///< by xi
    Eigen::MatrixXd by_constants, by_push;  ///< of the limits, at fixed xi
    Eigen::MatrixXd by_ground;              ///< of the joints, by a height under each contact
    Eigen::VectorXd friction, cone_left, torque_left, height;  ///< of Tube::OfPhase
  };
  struct Push {
    double begin;               ///< [s]
    Eigen::MatrixXd deviation;  ///< xi, one column for each direction
  };
  /// xi at one sample, one column for each draw.
  struct Deviations {
    Eigen::MatrixXd start, constants;
    std::vector<Push> pushes;

    /// To the next sample of the phase; null: over the landing at its end.
    void advance(const Sample& at, const Sample* after, double push_duration);
  };
  void measure(const Sample& at, const Deviations& deviations, Tube::OfPhase& phase, Eigen::Index k) const;
  Eigen::MatrixXd start_deviations(const ReducedSample& first) const;
  void add_heights(const ReducedSample& at, Sample& sample);
  Eigen::MatrixXd joints_by_height() const;
  Eigen::MatrixXd misled_torques(const ReducedSample& at, const Eigen::MatrixXd& by_height) const;

  const MotionProblem& problem_;
  double end_;              ///< of the motion [s]
  Eigen::VectorXd weight_;  ///< of the metric of xi
  Disturbances disturbances_;
  InertiaErrors inertia_;
  Eigen::Vector3d pushed_at_;  ///< centre of mass of the base, in its frame [m]
  ContactSchedule schedule_;
  RigidBodyTerms terms_;
  ContactKinematics feet_;                         ///< all contacts of the robot
  std::vector<bool> is_footed_;                    ///< in stance at any time, of each
  std::vector<std::pair<double, double>> swings_;  ///< begin and end of each of the schedule [s]
  std::vector<std::vector<Sample>> samples_;       ///< of each phase, last first
  Eigen::MatrixXd start_;                          ///< deviations xi at the start, one column for each draw
};

/// Between samples of a tube, about [s]: deviations change over 0.1 s and more.
inline constexpr double kTubeStep = 0.02;

/// Of the gains that design_feedback() finds, on a grid of this `step` [s] instead of `tracking`'s. Throws
/// NumericalError if there are none.
Tube make_tube(const MotionProblem& problem, const Trajectory& motion, const TrackingOptions& tracking,
               const Disturbances& disturbances, double step = kTubeStep);

/// Rows of the contacts of a phase as those of all contacts of the robot; NaN for those in the air.
Eigen::MatrixXd rows_of_contacts(const MotionProblem& problem, std::size_t phase, const Eigen::MatrixXd& held);

}  // namespace prowl
