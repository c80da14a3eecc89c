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

/// How far the closed loop leaves a motion under disturbances, to first order: standard deviations of what is drawn
/// once (start, masses) and the largest effect of one push.
struct Tube {
  /// Of one phase of the motion, one column for each of its samples.
  struct OfPhase {
    std::vector<double> times;    ///< [s]
    Eigen::MatrixXd state;        ///< dx, standard deviation without pushes (2 nv rows) [m, rad, m/s, rad/s]
    Eigen::MatrixXd pushed;       ///< dx, largest by a push (2 nv rows)
    Margins::OfPhase needed;      ///< of the limits: docs/robust.md#margins
    Eigen::MatrixXd cone_left;    ///< by the motion, of each contact, with all friction [N]
    Eigen::MatrixXd torque_left;  ///< by the motion, nu rows [N m]
    Eigen::MatrixXd load;         ///< normal force of each contact [N]
    Eigen::MatrixXd height;       ///< of each contact of the robot in the air, above its surfaces; else infinite [m]

    /// Size of dx that 95 % of the cases keep (2 nv rows): two standard deviations and the worst push, as squares.
    Eigen::MatrixXd band() const;
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
    Eigen::MatrixXd Z, step;                               ///< of ReducedSample
    Eigen::MatrixXd drift, push;                           ///< d xi/dt by what is constant, and by a push along x and y
    Eigen::MatrixXd limits;                                ///< by xi
    Eigen::MatrixXd by_constants, by_push;                 ///< of the limits, at fixed xi
    Eigen::VectorXd cone_left, torque_left, load, height;  ///< of Tube::OfPhase
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

  const MotionProblem& problem_;
  Eigen::VectorXd weight_;  ///< of the metric of xi
  Disturbances disturbances_;
  InertiaErrors inertia_;
  ContactSchedule schedule_;
  RigidBodyTerms terms_;
  ContactKinematics feet_;                         ///< all contacts of the robot
  std::vector<std::pair<double, double>> swings_;  ///< begin and end of each of the schedule [s]
  std::vector<std::vector<Sample>> samples_;       ///< of each phase, last first
  Eigen::MatrixXd start_;                          ///< deviations xi at the start, one column for each draw
};

/// Gains of a motion, and where they let it go.
struct ClosedLoop {
  FeedbackDesign feedback;
  Tube tube;
};

/// With the gains of design_feedback(). Throws NumericalError if there are none.
ClosedLoop closed_loop(const MotionProblem& problem, const Trajectory& motion, const TrackingOptions& tracking,
                       const Disturbances& disturbances);

/// Step of the gains where a tube need not be exact [s].
inline constexpr double kTubeStep = 0.01;

/// Rows of the contacts of a phase as those of all contacts of the robot; NaN for those in the air.
Eigen::MatrixXd rows_of_contacts(const MotionProblem& problem, std::size_t phase, const Eigen::MatrixXd& held);

}  // namespace prowl
