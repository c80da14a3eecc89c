#include "prowl/starter/standing_posture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/starter/robot_pose.hpp"
#include "prowl/starter/sole.hpp"

namespace prowl {
namespace {

constexpr double kSweep = 0.01;           // [rad]
constexpr double kHipApart = 0.1;         // of the leg: joints closer to the knee are at the knee
constexpr double kPostureFitted = 1e-4;   // [m]
constexpr double kJointRounding = 1e-4;   // [rad]
constexpr std::size_t kSoleContacts = 3;  // feet with this many contacts keep a level orientation
// Stretch of the legs, in order of trial. 0.93 bends a humanoid knee by 45 degrees.
constexpr double kStretchOfPoints[] = {0.8, 0.75, 0.85, 0.7, 0.65, 0.9, 0.95};
constexpr double kStretchOfSoles[] = {0.93, 0.9, 0.95, 0.87, 0.97, 0.84};

class PostureSearch {
 public:
  PostureSearch(const RobotModel& robot, const LegSearch& search, const std::vector<std::vector<int>>& contacts_of_leg)
      : robot_(robot),
        legs_(search.legs),
        contacts_(contacts_of_leg),
        pose_(robot, search.upright),
        neutral_(neutral_joints(robot)) {
    pose_.set(neutral_);
    double toes = 0.0;
    for (std::size_t l = 0; l < legs_.size(); ++l) {
      knees_.push_back(find_knee(l));
      hips_.push_back(hip_of(l));
      toes += middle(l).x() - pose_.joint(legs_[l].joints.back()).x();
    }
    toes_are_behind_ = contacts_of_leg[0].size() >= kSoleContacts && toes < -kToe;
    find_soles();
  }

  StandingPosture find() {
    StandingPosture result;
    result.joints = neutral_;
    result.knees = knees_;
    const bool soles = contacts_[0].size() >= kSoleContacts;
    const auto tries = soles ? std::vector<double>(std::begin(kStretchOfSoles), std::end(kStretchOfSoles))
                             : std::vector<double>(std::begin(kStretchOfPoints), std::end(kStretchOfPoints));
    for (const double stretch : tries) {
      const auto joints = stand(stretch);
      if (!joints) continue;
      result.found = true;
      result.stretch = stretch;
      result.joints = joints->unaryExpr([](double x) { return kJointRounding * std::round(x / kJointRounding) + 0.0; });
      pose_.set(result.joints);
      double ground = std::numeric_limits<double>::infinity();
      for (std::size_t c = 0; c < robot_.contacts().size(); ++c)
        ground = std::min(ground, pose_.contact(c).z() - robot_.contacts()[c].radius);
      result.height = -ground;
      break;
    }
    return result;
  }

 private:
  Eigen::Vector3d middle(std::size_t leg) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int c : contacts_[leg]) sum += pose_.contact(static_cast<std::size_t>(c));
    return sum / static_cast<double>(contacts_[leg].size());
  }

  /// Distance from joint `from` to the middle of the contacts over a full turn of `joint`: (angle,
  /// distance).
  std::vector<std::pair<double, double>> sweep(std::size_t leg, int joint, int from) {
    std::vector<std::pair<double, double>> distances;
    Eigen::VectorXd joints = neutral_;
    for (double angle = -std::numbers::pi; angle < std::numbers::pi; angle += kSweep) {
      joints(joint) = angle;
      pose_.set(joints);
      distances.emplace_back(angle, (middle(leg) - pose_.joint(from)).norm());
    }
    pose_.set(neutral_);
    return distances;
  }

  static bool shorter(const std::pair<double, double>& a, const std::pair<double, double>& b) {
    return a.second < b.second;
  }

  Knee find_knee(std::size_t leg) {
    Knee knee;
    double most = -1.0;
    for (const int joint : legs_[leg].joints) {
      if (robot_.joint_is_prismatic()[joint]) continue;
      const auto distances = sweep(leg, joint, legs_[leg].joints.front());
      const auto [least, largest] = std::minmax_element(distances.begin(), distances.end(), shorter);
      if (largest->second - least->second <= most) continue;
      most = largest->second - least->second;
      knee.joint = joint;
    }
    const int hip = hip_joint(leg, knee.joint);
    const auto distances = sweep(leg, knee.joint, hip);
    const auto longest = std::max_element(distances.begin(), distances.end(), shorter);
    knee.straight = longest->first;
    knee.length = longest->second;
    return knee;
  }

  /// Last joint before the knee that is not at the knee.
  int hip_joint(std::size_t leg, int knee) const {
    const std::vector<int>& joints = legs_[leg].joints;
    const double reach = (middle(leg) - pose_.joint(joints.front())).norm();
    int hip = joints.front();
    for (const int joint : joints) {
      if (joint == knee) break;
      if ((pose_.joint(joint) - pose_.joint(knee)).norm() > kHipApart * reach) hip = joint;
    }
    return hip;
  }

  /// Hip in the neutral pose, moved along the knee axis to the side of the foot.
  Eigen::Vector3d hip_of(std::size_t leg) const {
    const Eigen::Vector3d hip = pose_.joint(hip_joint(leg, knees_[leg].joint));
    const Eigen::Vector3d axis = knee_axis(leg);
    const Eigen::Vector3d aside = axis * axis.dot(middle(leg) - hip);
    return hip + Eigen::Vector3d(aside.x(), aside.y(), 0.0);
  }

  Eigen::Vector3d knee_axis(std::size_t leg) const {
    const int body = knees_[leg].joint + 1;
    return pose_.body(body).rotation() * pose_.tree().bodies[body].axis;
  }

  /// Contact positions about their middle, sole level; heights are those of the ball centres.
  void find_soles() {
    for (std::size_t l = 0; l < legs_.size(); ++l) {
      Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
      if (contacts_[l].size() >= kSoleContacts) {
        const auto bottom = [&](std::size_t i) { return pose_.contact(static_cast<std::size_t>(contacts_[l][i])); };
        Eigen::Vector3d normal = (bottom(1) - bottom(0)).cross(bottom(2) - bottom(0)).normalized();
        if (normal.z() < 0.0) normal = -normal;
        turn = so3::shortest_rotation(normal, Eigen::Vector3d::UnitZ());
      }
      std::vector<Eigen::Vector3d>& sole = soles_.emplace_back();
      for (const int c : contacts_[l]) {
        sole.push_back(turn * (pose_.contact(static_cast<std::size_t>(c)) - middle(l)));
        sole.back().z() = robot_.contacts()[c].radius;
      }
    }
  }

  /// Horizontal direction that the knee should point to.
  Eigen::Vector3d wanted_side(std::size_t leg) const {
    if (legs_.size() > 2) {
      Eigen::Vector3d center = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& hip : hips_) center += hip / static_cast<double>(hips_.size());
      return center - hips_[leg];
    }
    return toes_are_behind_ ? -Eigen::Vector3d::UnitX() : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  }

  std::vector<ContactTarget> targets(std::size_t leg, double ground, const Eigen::Vector2d& shift) const {
    std::vector<ContactTarget> result;
    const Eigen::Vector3d foothold(hips_[leg].x() + shift.x(), hips_[leg].y() + shift.y(), ground);
    for (std::size_t i = 0; i < contacts_[leg].size(); ++i)
      result.push_back({contacts_[leg][i], foothold + soles_[leg][i]});
    return result;
  }

  /// Joint positions (nu) with the knee on one side (-1 or 1) of straight; nullopt if impossible.
  std::optional<Eigen::VectorXd> bend(std::size_t leg, int side, double stretch, double ground,
                                      const Eigen::Vector2d& shift) {
    const Knee& knee = knees_[leg];
    const double bent = 2.0 * std::acos(std::clamp(stretch, 0.0, 1.0));
    const double lower = robot_.position_lower()(knee.joint), upper = robot_.position_upper()(knee.joint);
    const double margin = std::min(0.05, 0.02 * (upper - lower));
    // Start with the hip bent half as much the other way: this keeps the foot below it.
    for (const double share : {1.0, 0.6, 1.4}) {
      Eigen::VectorXd q = pose_.q();
      q.tail(robot_.nu()) = neutral_;
      q(7 + knee.joint) = std::clamp(knee.straight + side * share * bent, lower + margin, upper - margin);
      if (side * (q(7 + knee.joint) - knee.straight) < 0.3 * bent) continue;
      const InverseKinematics ik = inverse_kinematics(robot_, q, targets(leg, ground, shift));
      Eigen::VectorXd joints = ik.q.tail(robot_.nu());
      if (ik.residual > kPostureFitted || side * (joints(knee.joint) - knee.straight) < 0.3 * bent) continue;
      if (is_inside(leg, joints)) return joints;
    }
    return std::nullopt;
  }

  bool is_inside(std::size_t leg, const Eigen::VectorXd& joints) const {
    constexpr double kClearance = 0.02;  // [rad]
    return std::all_of(legs_[leg].joints.begin(), legs_[leg].joints.end(), [&](int j) {
      return joints(j) > robot_.position_lower()(j) + kClearance && joints(j) < robot_.position_upper()(j) - kClearance;
    });
  }

  std::optional<Eigen::VectorXd> stand_at(double stretch, double ground, const Eigen::Vector2d& shift) {
    Eigen::VectorXd joints = neutral_;
    for (std::size_t l = 0; l < legs_.size(); ++l) {
      std::optional<Eigen::VectorXd> best;
      double best_side = -std::numeric_limits<double>::infinity();
      for (const int side : {-1, 1}) {
        const auto bent = bend(l, side, stretch, ground, shift);
        if (!bent) continue;
        pose_.set(*bent);
        const Eigen::Vector3d knee = pose_.joint(knees_[l].joint) - hips_[l];
        const double towards = knee.dot(wanted_side(l));
        if (towards > best_side) {
          best_side = towards;
          best = bent;
        }
      }
      if (!best) return std::nullopt;
      for (const int j : legs_[l].joints) joints(j) = (*best)(j);
    }
    return joints;
  }

  std::optional<Eigen::VectorXd> stand(double stretch) {
    double ground = -std::numeric_limits<double>::infinity();  // the leg that needs the highest ground decides
    for (std::size_t l = 0; l < legs_.size(); ++l) {
      const double radius = soles_[l].front().z();
      ground = std::max(ground, hips_[l].z() - stretch * knees_[l].length - radius);
    }
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
    auto joints = stand_at(stretch, ground, shift);
    for (int i = 0; i < 4 && joints && legs_.size() == 2; ++i) {
      pose_.set(*joints);
      // Only along x: sideways, bipeds are nearly symmetrical and their posture should be exactly
      // so.
      shift.x() += pose_.center_of_mass().x() - 0.5 * (middle(0) + middle(1)).x();
      joints = stand_at(stretch, ground, shift);
    }
    return joints;
  }

  const RobotModel& robot_;
  const std::vector<Leg>& legs_;
  const std::vector<std::vector<int>>& contacts_;
  RobotPose pose_;
  Eigen::VectorXd neutral_;
  std::vector<Knee> knees_;
  std::vector<Eigen::Vector3d> hips_;
  std::vector<std::vector<Eigen::Vector3d>> soles_;
  bool toes_are_behind_ = false;  // x of the base points backward
};

}  // namespace

StandingPosture standing_posture(const RobotModel& robot, const LegSearch& search,
                                 const std::vector<std::vector<int>>& contacts_of_leg) {
  return PostureSearch(robot, search, contacts_of_leg).find();
}

}  // namespace prowl
