// What the figures show, computed again in another way: contact velocities from leg kinematics, gains from the tracker.
#include "prowl/io/figure_data.hpp"

#include <gmock/gmock.h>

#include <map>
#include <sstream>

#include "prowl/model/configuration.hpp"
#include "prowl/model/leg_kinematics.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

using Row = std::map<std::string, std::string>;

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> parts;
  std::istringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<Row> rows(const std::string& csv) {
  std::istringstream stream(csv);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = cells(line);
  std::vector<Row> result;
  while (std::getline(stream, line)) {
    const std::vector<std::string> values = cells(line);
    EXPECT_EQ(values.size(), names.size()) << line;
    Row row;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
    result.push_back(row);
  }
  return result;
}

double number(const Row& row, const std::string& name) { return std::stod(row.at(name)); }

/// HyQ swings a leg and puts it down: contacts that change. Planned once.
const test::SolvedTask& step() {
  static const test::SolvedTask task = test::solve_task("hyq/step");
  return task;
}

/// Velocity of a contact in the world, J(q) v, from where the leg is in the base.
Eigen::Vector3d contact_velocity(LegKinematics& legs, int contact, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
  legs.update(q.tail(q.size() - 7));
  const Eigen::Vector3d linear = v.head<3>(), angular = v.segment<3>(3);
  return base_rotation(q) *
         (linear + angular.cross(legs.position(contact)) + legs.linear(contact) * v.tail(v.size() - 6));
}

/// J̇v by a central difference along v.
Eigen::Vector3d velocity_product(LegKinematics& legs, int contact, const TrajectoryPoint& point) {
  constexpr double kStep = 1e-5;
  Eigen::VectorXd rate = point.v;
  rate.head<3>() = base_rotation(point.q) * point.v.head<3>();
  const Eigen::VectorXd after = integrate(point.q, kStep * rate), before = integrate(point.q, -kStep * rate);
  return (contact_velocity(legs, contact, after, point.v) - contact_velocity(legs, contact, before, point.v)) /
         (2 * kStep);
}

TEST(FigureData, ContactAccelerationsAreThoseOfTheLegs) {
  const MotionProblem& problem = step().task.problem;
  LegKinematics legs(problem.robot);
  int compared = 0, open = 0;
  double largest = 0.0;
  double time = 0.0;
  for (const Row& row : rows(contact_acceleration_csv(problem, step().trajectory, 0.005))) {
    EXPECT_LE(number(row, "time_s") - time, 0.005 + 1e-9);
    time = number(row, "time_s");
    const int phase = static_cast<int>(number(row, "phase"));
    TrajectoryPoint point = sample(step().trajectory, time);
    if (point.phase != phase) continue;  // the earlier of two at a switch
    for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) {
      const std::string& name = problem.robot.contacts()[c].name;
      const std::vector<PhaseContact>& held = problem.phases[phase].contacts;
      if (std::none_of(held.begin(), held.end(), [c](const PhaseContact& contact) { return contact.contact == c; })) {
        EXPECT_EQ(row.at("Ja_" + name + "_x_mps2"), "nan") << "a swinging foot has nothing to be held against";
        ++open;
        continue;
      }
      const Eigen::Vector3d from_a = contact_velocity(legs, c, point.q, point.a);
      const Eigen::Vector3d from_v = -velocity_product(legs, c, point);
      for (int i = 0; i < 3; ++i) {
        const std::string axis(1, "xyz"[i]);
        EXPECT_NEAR(number(row, "Ja_" + name + "_" + axis + "_mps2"), from_a(i), 1e-8) << name << " at " << time;
        EXPECT_NEAR(number(row, "minus_Jdotv_" + name + "_" + axis + "_mps2"), from_v(i), 1e-6)
            << name << " at " << time;
        largest = std::max(largest, std::abs(from_v(i)));
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_GT(open, 0) << "no foot ever swings";
  EXPECT_GT(largest, 0.01) << "nothing moves";
  EXPECT_NEAR(time, step().trajectory.duration(), 1e-12);
}

TEST(FigureData, GainsAreThoseOfTheTracker) {
  const test::SolvedTask& task = step();
  const MotionProblem& problem = task.task.problem;
  const Tracker tracker(make_tracking_plan(problem, design_feedback(problem, task.trajectory, task.task.tracking)));
  const int joint = joint_index(problem.robot, "lh_kfe_joint");
  const std::string csv = gains_csv(problem.robot, tracker, joint);
  const std::vector<std::string> columns = cells(csv.substr(0, csv.find('\n')));
  ASSERT_EQ(columns.size(), 2u + 36u);
  EXPECT_EQ(columns[2], "base_px_Npm");
  EXPECT_EQ(columns[7], "base_rz_Nmprad");
  EXPECT_EQ(columns[8], "q_lf_haa_joint_Nmprad");
  EXPECT_EQ(columns[20], "base_vx_Nspm");
  EXPECT_EQ(columns[37], "v_rh_kfe_joint_Nmsprad");

  const std::vector<Row> table = rows(csv);
  ASSERT_EQ(static_cast<int>(table.size()), tracker.plan().num_samples());
  Eigen::MatrixXd K(problem.robot.nu(), 2 * problem.robot.nv());
  for (std::size_t k = 0; k + 1 < table.size(); ++k) {
    const double time = number(table[k], "time_s");
    if (number(table[k + 1], "time_s") == time) continue;  // end of a phase: the tracker gives the later one
    tracker.gains(time, K);
    for (int i = 0; i < 36; ++i) {
      EXPECT_NEAR(number(table[k], columns[static_cast<std::size_t>(i) + 2]), K(joint, i),
                  1e-8 * (1.0 + K.cwiseAbs().maxCoeff()));
    }
  }
  EXPECT_THROW(gains_csv(test::talos(), tracker, joint), InputError);
}

TEST(FigureData, LimitsAreThoseOfThePosture) {
  const RobotModel& robot = step().task.problem.robot;
  const std::vector<Row> limits = rows(torque_limits_csv(robot, step().trajectory));
  ASSERT_EQ(limits.size(), step().trajectory.nodes.size());
  std::map<std::string, const LimitCurve*> knees;
  for (const auto& limit : robot.torque_curves()) knees[robot.joint_names()[limit.joint]] = &limit.curve;
  ASSERT_EQ(knees.size(), 4u);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    for (int j = 0; j < robot.nu(); ++j) {
      const std::string& name = robot.joint_names()[j];
      double expected = robot.torque_limit()(j);
      if (knees.contains(name)) expected = std::min(expected, knees[name]->value(step().trajectory.nodes[k].q(7 + j)));
      EXPECT_NEAR(number(limits[k], "upper_" + name + "_Nm"), expected, 1e-12);
      EXPECT_NEAR(number(limits[k], "lower_" + name + "_Nm"), -expected, 1e-12);
    }
  }
  std::map<std::string, int> points;
  for (const Row& row : rows(limit_curves_csv(robot))) {
    const LimitCurve& curve = *knees.at(row.at("joint"));
    const double position = number(row, "position_rad");
    EXPECT_NEAR(number(row, "limit_Nm"), std::min(curve.value(position), robot.torque_limit().maxCoeff()), 1e-12);
    if (points[row.at("joint")]++ == 0) EXPECT_EQ(position, curve.lower_end());
  }
  EXPECT_EQ(points.size(), 4u);
}

TEST(FigureData, LegsAreWhatMovesContacts) {
  std::map<std::string, std::vector<std::string>> legs;
  for (const Row& row : rows(legs_csv(test::talos()))) legs[row.at("leg")].push_back(row.at("joint"));
  ASSERT_EQ(legs.size(), 3u) << "two legs, and the rest";
  EXPECT_EQ(legs["0"].size(), 6u);
  EXPECT_THAT(legs["0"], testing::Each(testing::StartsWith("leg_left")));
  EXPECT_THAT(legs["1"], testing::Each(testing::StartsWith("leg_right")));
  EXPECT_THAT(legs["2"], testing::Contains("torso_1_joint"));
}

TEST(FigureData, FindsJoints) {
  const RobotModel& knees = step().task.problem.robot;
  EXPECT_EQ(knees.joint_names()[default_gains_joint(knees)], "lf_kfe_joint");
  const RobotModel without_curves = test::hyq();
  EXPECT_EQ(default_gains_joint(without_curves), 2);
  EXPECT_EQ(joint_index(without_curves, "lh_kfe_joint"), 5);
  try {
    joint_index(without_curves, "lh_knee_joint");
    ADD_FAILURE() << "no such joint, but no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'lh_"));
  }
}

}  // namespace
}  // namespace prowl
