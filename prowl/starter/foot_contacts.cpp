#include "prowl/starter/foot_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "prowl/model/so3.hpp"
#include "prowl/starter/sole.hpp"

namespace prowl {
namespace {

constexpr std::size_t kSoleJoints = 5;   // a leg with fewer cannot keep a sole level
constexpr double kSnap = 0.35;           // [rad]: largest tilt of an axis taken for down
constexpr double kSameHeight = 5e-3;     // [m]: spheres that touch the ground together
constexpr double kLargestBall = 0.25;    // of the leg's length; wheels are the largest
constexpr double kPointRounding = 1e-5;  // [m]

double rounded(double x) { return kPointRounding * std::round(x / kPointRounding) + 0.0; }

/// Rotation of the foot with a level sole.
Eigen::Matrix3d level_rotation(const RobotPose& pose, const Leg& leg) {
  Eigen::Matrix3d R = pose.body(leg.foot).rotation();
  if (leg.joints.size() < kSoleJoints) return R;
  Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  double best = std::cos(kSnap);
  for (const RobotLink& link : pose.links()) {
    if (link.body != leg.foot) continue;
    const Eigen::Matrix3d axes = R * link.placement.rotation();
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d axis = (i < 3 ? 1.0 : -1.0) * axes.col(i % 3);
      if (-axis.z() > best) {
        best = -axis.z();
        down = axis;
      }
    }
  }
  return so3::shortest_rotation(down, -Eigen::Vector3d::UnitZ()) * R;
}

/// Link of the body whose origin is nearest to `point`; `preferred` wins ties.
const RobotLink& nearest_link(const RobotPose& pose, int body, const Eigen::Vector3d& point,
                              const std::string& preferred) {
  const RobotLink* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const RobotLink& link : pose.links()) {
    if (link.body != body) continue;
    constexpr double kTie = 1e-3;  // [m]
    const double distance = (link.placement.translation() - point).norm() - (link.name == preferred ? kTie : 0.0);
    if (distance < least) {
      least = distance;
      nearest = &link;
    }
  }
  return *nearest;
}

ContactPoint contact_at(const RobotLink& link, const std::string& name, const Eigen::Vector3d& in_body, double radius) {
  const Eigen::Vector3d offset = link.placement.inverse() * in_body;
  return {name, link.name, rounded(radius), offset.unaryExpr([](double x) { return rounded(x); })};
}

/// "_toe_in", "_heel_out": corner at (x, y) from the middle of a level foot.
std::string corner_name(const Eigen::Vector2d& from_middle, bool toe_is_ahead, bool inside_is_right) {
  return std::string((from_middle.x() > 0.0) == toe_is_ahead ? "_toe" : "_heel") +
         ((from_middle.y() < 0.0) == inside_is_right ? "_in" : "_out");
}

class FootFinder {
 public:
  FootFinder(const RobotPose& pose, const Leg& leg, const FootShapes& shapes)
      : pose_(pose), leg_(leg), shapes_(shapes), level_(level_rotation(pose, leg)) {}

  FootContacts find() const {
    if (shapes_.shapes.empty()) return bare_frame();
    FootContacts foot = spheres();
    if (foot.contacts.empty() && leg_.joints.size() >= kSoleJoints) foot = sole();
    return foot.contacts.empty() ? ball() : foot;
  }

 private:
  /// Points of a shape, levelled.
  Eigen::Matrix3Xd levelled(const FootShape& shape) const { return level_ * shape.points; }
  double lowest(const FootShape& shape) const { return levelled(shape).row(2).minCoeff() - shape.radius; }
  double lowest() const {
    double least = std::numeric_limits<double>::infinity();
    for (const FootShape& shape : shapes_.shapes) least = std::min(least, lowest(shape));
    return least;
  }
  const char* kind() const { return shapes_.are_visual ? "visual (no collision)" : "collision"; }
  bool is_on_the_left() const { return pose_.body(leg_.foot).translation().y() > 0.0; }

  FootContacts spheres() const {
    FootContacts foot;
    std::vector<const FootShape*> touching;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const FootShape& shape : shapes_.shapes) {
      if (shape.radius > 0.0 && lowest(shape) <= lowest() + kSameHeight) touching.push_back(&shape);
    }
    for (const FootShape* shape : touching)
      middle += level_ * shape->points.col(0) / static_cast<double>(touching.size());
    std::vector<std::string> corners;
    for (const FootShape* shape : touching) {
      corners.push_back(
          corner_name((level_ * shape->points.col(0) - middle).head<2>(), middle.x() > -kToe, is_on_the_left()));
    }
    const bool are_corners = touching.size() == 4 && std::set(corners.begin(), corners.end()).size() == 4;
    for (const FootShape* shape : touching) {
      const Eigen::Vector3d center = shape->points.col(0);
      const RobotLink& link = nearest_link(pose_, leg_.foot, center, shape->link);
      std::string name = link.name;
      if (are_corners) {
        name += corners[foot.contacts.size()];
      } else if (touching.size() > 1) {
        name += fmt::format("_{}", foot.contacts.size() + 1);
      }
      foot.contacts.push_back(contact_at(link, name, center, shape->radius));
    }
    if (touching.size() == 1) foot.how = fmt::format("the {} sphere of the URDF", kind());
    if (touching.size() > 1) foot.how = fmt::format("the {} lowest {} spheres of the URDF", touching.size(), kind());
    return foot;
  }

  FootContacts sole() const {
    Eigen::Matrix3Xd all(3, 0);
    for (const FootShape& shape : shapes_.shapes) {
      if (shape.rolls) continue;
      const Eigen::Matrix3Xd points = levelled(shape);
      all.conservativeResize(3, all.cols() + points.cols());
      all.rightCols(points.cols()) = points;
    }
    const auto rectangle = find_sole(all);
    if (!rectangle) return {};
    const double height = all.row(2).minCoeff();
    const Eigen::Vector2d middle = 0.5 * (rectangle->lower + rectangle->upper);
    const auto in_body = [&](double x, double y) -> Eigen::Vector3d {
      return level_.transpose() * Eigen::Vector3d(x, y, height);
    };
    const RobotLink& link = nearest_link(pose_, leg_.foot, in_body(middle.x(), middle.y()), "");
    FootContacts foot;
    for (const double x : {rectangle->upper.x(), rectangle->lower.x()}) {
      for (const double y : {rectangle->upper.y(), rectangle->lower.y()}) {
        const std::string corner = corner_name(Eigen::Vector2d(x, y) - middle, middle.x() > -kToe, is_on_the_left());
        foot.contacts.push_back(contact_at(link, link.name + corner, in_body(x, y), 0.0));
      }
    }
    const Eigen::Vector2d edges = rectangle->upper - rectangle->lower;
    foot.how = fmt::format("a rectangle of {:.1f} x {:.1f} cm inside the flat part of the {} shape, {}",
                           100.0 * edges.x(), 100.0 * edges.y(), kind(), shapes_.shapes[0].kind);
    return foot;
  }

  FootContacts ball() const {
    const FootShape* shape = &shapes_.shapes[0];
    for (const FootShape& other : shapes_.shapes) {
      if (lowest(other) < lowest(*shape)) shape = &other;
    }
    const Eigen::Matrix3Xd points = levelled(*shape);
    Eigen::Index at = 0;
    const double bottom = points.row(2).minCoeff(&at);
    const RobotLink& link = nearest_link(pose_, leg_.foot, shape->points.col(at), shape->link);
    const Eigen::Vector3d origin = level_ * link.placement.translation();
    const double radius = origin.z() - bottom;
    const double reach = (pose_.body(leg_.foot).translation() - pose_.joint(leg_.joints.front())).norm() + radius;
    const bool is_above = (points.col(at) - origin).head<2>().norm() < radius;
    FootContacts foot;
    if (radius > 0.0 && radius < kLargestBall * reach && is_above) {
      foot.contacts = {contact_at(link, link.name, link.placement.translation(), radius)};
      foot.how =
          fmt::format("a ball around the frame, down to the lowest point of the {} shape ({})", kind(), shape->kind);
    } else {
      foot.contacts = {contact_at(link, link.name, shape->points.col(at), 0.0)};
      foot.how = fmt::format("the lowest point of the {} shape ({}), no ball", kind(), shape->kind);
    }
    return foot;
  }

  /// Without a shape: the lowest frame of the foot.
  FootContacts bare_frame() const {
    const auto height = [&](const RobotLink& link) {
      return link.body == leg_.foot ? (level_ * link.placement.translation()).z()
                                    : std::numeric_limits<double>::infinity();
    };
    const RobotLink& lowest = *std::ranges::min_element(pose_.links(), {}, height);
    return {{contact_at(lowest, lowest.name, lowest.placement.translation(), 0.0)},
            "the origin of the frame: the URDF contains no readable shape there"};
  }

  const RobotPose& pose_;
  const Leg& leg_;
  const FootShapes& shapes_;
  Eigen::Matrix3d level_;
};

}  // namespace

FootContacts foot_contacts(const RobotPose& pose, const Leg& leg, const FootShapes& shapes) {
  return FootFinder(pose, leg, shapes).find();
}

}  // namespace prowl
