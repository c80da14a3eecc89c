#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "prowl/files/base64.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/report_page/report_json.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;
using Eigen::MatrixXd;
using Points = std::vector<TrajectoryPoint>;
using Value = std::function<double(const TrajectoryPoint&)>;

const char* const kAxes[] = {"x", "y", "z"};
constexpr double kLeastLoad = 1e-3;  ///< share of the weight; below it a ratio of forces means nothing
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

Json series(const char* label, const char* style, const char* time, const Points& points, const Value& value) {
  std::vector<float> values;
  for (const TrajectoryPoint& point : points) values.push_back(static_cast<float>(value(point)));
  return {{"label", label}, {"style", style}, {"time", time}, {"values", base64(values)}};
}

Json series(const char* label, const char* style, const char* time, const Eigen::RowVectorXd& values) {
  return {{"label", label},
          {"style", style},
          {"time", time},
          {"values", base64(std::vector<float>(values.begin(), values.end()))}};
}

/// Charts of the planned motion and, if present, of the simulated one.
class Charts {
 public:
  Charts(const MotionProblem& problem, const Points& plan, const Points& simulation)
      : problem_(problem), robot_(problem.robot), plan_(plan), simulation_(simulation) {}

  Json chart(const std::string& title, const char* unit, const Value& value) const {
    Json all = Json::array();
    all.push_back(series("plan", "plan", "plan", plan_, value));
    if (!simulation_.empty()) all.push_back(series("simulation", "simulation", "simulation", simulation_, value));
    return {{"title", title}, {"unit", unit}, {"series", all}};
  }
  /// Adds a limit over the planned motion, unless it is infinite.
  void add_limit(Json& chart, const Value& limit) const {
    if (plan_.empty() || !std::isfinite(limit(plan_.front()))) return;
    chart["series"].push_back(series("limit", "limit", "plan", plan_, limit));
  }

  Json torques() const {
    Json charts = Json::array();
    for (int j = 0; j < robot_.nu(); ++j) {
      Json one = chart(joint(j), prismatic(j) ? "N" : "N m", [j](const auto& p) { return p.tau(j); });
      add_limit(one, [this, j](const auto& p) { return robot_.torque_upper(j, p.q(7 + j), p.v(6 + j)); });
      add_limit(one, [this, j](const auto& p) { return robot_.torque_lower(j, p.q(7 + j), p.v(6 + j)); });
      charts.push_back(one);
    }
    return charts;
  }

  Json base() const {
    Json charts = Json::array();
    for (int i = 0; i < 3; ++i) {
      charts.push_back(chart(fmt::format("position {}", kAxes[i]), "m", [i](const auto& p) { return p.q(i); }));
    }
    const char* const angles[] = {"roll", "pitch", "yaw"};
    for (int i = 0; i < 3; ++i) {
      charts.push_back(
          chart(angles[i], "rad", [i](const auto& p) { return rpy_from_rotation(base_rotation(p.q))(i); }));
    }
    for (int i = 0; i < 3; ++i) {
      charts.push_back(
          chart(fmt::format("velocity {} (base frame)", kAxes[i]), "m/s", [i](const auto& p) { return p.v(i); }));
    }
    for (int i = 0; i < 3; ++i) {
      charts.push_back(chart(fmt::format("angular velocity {} (base frame)", kAxes[i]), "rad/s",
                             [i](const auto& p) { return p.v(3 + i); }));
    }
    return charts;
  }

  Json joint_positions() const {
    Json charts = Json::array();
    for (int j = 0; j < robot_.nu(); ++j) {
      Json one = chart(joint(j), prismatic(j) ? "m" : "rad", [j](const auto& p) { return p.q(7 + j); });
      add_limit(one, [this, j](const auto&) { return robot_.position_upper()(j); });
      add_limit(one, [this, j](const auto&) { return robot_.position_lower()(j); });
      charts.push_back(one);
    }
    return charts;
  }

  Json joint_velocities() const {
    Json charts = Json::array();
    for (int j = 0; j < robot_.nu(); ++j) {
      Json one = chart(joint(j), prismatic(j) ? "m/s" : "rad/s", [j](const auto& p) { return p.v(6 + j); });
      add_limit(one, [this, j](const auto&) { return robot_.velocity_limit()(j); });
      add_limit(one, [this, j](const auto&) { return -robot_.velocity_limit()(j); });
      charts.push_back(one);
    }
    return charts;
  }

  Json forces() const {
    Json charts = Json::array();
    for (std::size_t c = 0; c < robot_.contacts().size(); ++c) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::Index k = 3 * static_cast<Eigen::Index>(c) + i;
        Json one = chart(fmt::format("{} {}", robot_.contacts()[c].name, kAxes[i]), "N",
                         [k](const auto& p) { return p.force(k); });
        for (const double side : {1.0, -1.0}) {
          const auto limit = [this, c, i, side](const auto& p) { return force_limit(p, static_cast<int>(c), i, side); };
          const auto has_limit = [&](const auto& p) { return std::isfinite(limit(p)); };
          if (std::any_of(plan_.begin(), plan_.end(), has_limit))
            one["series"].push_back(series("limit", "limit", "plan", plan_, limit));
        }
        charts.push_back(one);
      }
    }
    return charts;
  }

  /// Used share of each kind of limit, at the worst joint or contact; 1 is at the limit.
  Json margins() const {
    Json charts = Json::array();
    const auto add = [&](const std::string& title, const Json& one) {
      Json with_limit = one;
      with_limit["title"] = title;
      add_limit(with_limit, [](const auto&) { return 1.0; });
      charts.push_back(with_limit);
    };
    add("joint torque, worst joint",
        chart("", "of limit", [this](const auto& p) { return worst_joint(p, &Charts::torque_share); }));
    add("joint position, worst joint",
        chart("", "of limit", [this](const auto& p) { return worst_joint(p, &Charts::position_share); }));
    add("joint velocity, worst joint",
        chart("", "of limit", [this](const auto& p) { return worst_joint(p, &Charts::velocity_share); }));
    for (std::size_t c = 0; c < robot_.contacts().size(); ++c) {
      Json one = {{"title", ""}, {"unit", "of limit"}, {"series", Json::array()}};
      one["series"].push_back(series("plan", "plan", "plan", plan_,
                                     [this, c](const auto& p) { return friction_share(p, static_cast<int>(c)); }));
      add(fmt::format("friction, {}", robot_.contacts()[c].name), one);
    }
    return charts;
  }

  /// Deviations of the base from the plan within the band of the tube, and what the plan leaves of its limits beside
  /// what the tube needs.
  Json deviations_in(const Tube& tube) const {
    Json charts = Json::array();
    const Eigen::Index nv = robot_.nv();
    const MatrixXd band = at_plan(tube, 2 * nv, [](const Tube::OfPhase& phase, std::size_t) { return phase.band(); });
    const MatrixXd off = deviations();
    for (const Eigen::Index row : {0, 1, 2, 3, 4, 5}) {
      for (const bool is_rate : {false, true}) {
        const std::string unit = row < 3 ? "m" : "rad";
        Json one = {{"title", fmt::format("{}{}, deviation", is_rate ? "velocity (base frame) of " : "",
                                          coordinate_name(robot_, row))},
                    {"unit", is_rate ? unit + "/s" : unit},
                    {"series", Json::array()}};
        const Eigen::Index k = is_rate ? nv + row : row;
        for (const double side : {1.0, -1.0})
          one["series"].push_back(series("band", "band", "plan", side * band.row(k)));
        if (off.cols() > 0) one["series"].push_back(series("simulation", "simulation", "simulation", off.row(k)));
        charts.push_back(one);
      }
    }
    const auto add = [&](const std::string& title, const char* unit, const Eigen::RowVectorXd& left,
                         const Eigen::RowVectorXd& needed) {
      if (std::isinf(left.maxCoeff())) return;  // no limit
      Json both = Json::array({series("plan", "plan", "plan", left), series("needed", "needed", "plan", needed)});
      charts.push_back({{"title", title}, {"unit", unit}, {"series", both}});
    };
    const auto contacts = static_cast<Eigen::Index>(robot_.contacts().size());
    const auto of_contacts = [&](const auto& rows) {
      return at_plan(tube, contacts, [&](const Tube::OfPhase& phase, std::size_t p) {
        return rows_of_contacts(problem_, p, rows(phase));
      });
    };
    const MatrixXd cone = of_contacts([](const Tube::OfPhase& phase) { return phase.cone_left; });
    const MatrixXd cone_needed = of_contacts([](const Tube::OfPhase& phase) { return phase.cone_needed(); });
    for (Eigen::Index c = 0; c < contacts; ++c)
      add("left of the friction cone, " + robot_.contacts()[static_cast<std::size_t>(c)].name, "N", cone.row(c),
          cone_needed.row(c));
    const MatrixXd torque =
        at_plan(tube, robot_.nu(), [](const Tube::OfPhase& phase, std::size_t) { return phase.torque_left; });
    const MatrixXd torque_needed =
        at_plan(tube, robot_.nu(), [](const Tube::OfPhase& phase, std::size_t) { return phase.needed.torque; });
    for (int j = 0; j < robot_.nu(); ++j)
      add("left of the torque, " + joint(j), prismatic(j) ? "N" : "N m", torque.row(j), torque_needed.row(j));
    return charts;
  }

 private:
  using Share = double (Charts::*)(const TrajectoryPoint&, int) const;

  /// Rows of the tube at the points of the plan, linear between its samples. `rows`: of a phase, a column a sample.
  template <class Rows>
  MatrixXd at_plan(const Tube& tube, Eigen::Index count, const Rows& rows) const {
    MatrixXd result(count, static_cast<Eigen::Index>(plan_.size()));
    std::vector<MatrixXd> of_phases;
    for (std::size_t p = 0; p < tube.phases.size(); ++p) of_phases.push_back(rows(tube.phases[p], p));
    for (std::size_t k = 0; k < plan_.size(); ++k) {
      const auto phase = static_cast<std::size_t>(plan_[k].phase);
      const std::vector<double>& times = tube.phases[phase].times;
      const double part = (plan_[k].time - times.front()) / (times.back() - times.front());
      result.col(static_cast<Eigen::Index>(k)) = margin_at(of_phases[phase], std::clamp(part, 0.0, 1.0));
    }
    return result;
  }

  /// Of the simulated motion from the plan, whose end goes on: 2 nv rows, a column a point.
  MatrixXd deviations() const {
    MatrixXd result(2 * robot_.nv(), static_cast<Eigen::Index>(simulation_.size()));
    const Trajectory plan{plan_};
    for (std::size_t k = 0; k < simulation_.size(); ++k) {
      const TrajectoryPoint& point = simulation_[k];
      const TrajectoryPoint planned = sample(plan, std::min(point.time, plan.duration()));
      result.col(static_cast<Eigen::Index>(k)) << difference(planned.q, point.q), point.v - planned.v;
    }
    return result;
  }

  const std::string& joint(int j) const { return robot_.joint_names()[j]; }
  bool prismatic(int j) const { return robot_.joint_is_prismatic()[j]; }

  double worst_joint(const TrajectoryPoint& p, Share share) const {
    double worst = 0.0;
    for (int j = 0; j < robot_.nu(); ++j) worst = std::max(worst, (this->*share)(p, j));
    return worst;
  }
  double torque_share(const TrajectoryPoint& p, int j) const {
    const double tau = p.tau(j), q = p.q(7 + j), v = p.v(6 + j);
    return tau / (tau < 0.0 ? robot_.torque_lower(j, q, v) : robot_.torque_upper(j, q, v));
  }
  /// 0 in the middle of the range, 1 at its ends.
  double position_share(const TrajectoryPoint& p, int j) const {
    const double lower = robot_.position_lower()(j), upper = robot_.position_upper()(j);
    if (!std::isfinite(upper - lower)) return 0.0;
    return std::abs(p.q(7 + j) - 0.5 * (lower + upper)) / (0.5 * (upper - lower));
  }
  double velocity_share(const TrajectoryPoint& p, int j) const {
    return std::abs(p.v(6 + j)) / robot_.velocity_limit()(j);
  }

  /// Surface under a contact; null while the contact is open.
  const Surface* surface_below(const TrajectoryPoint& p, int c) const {
    for (const PhaseContact& held : problem_.phases[p.phase].contacts) {
      if (held.contact == c) return &problem_.surfaces[held.surface];
    }
    return nullptr;
  }
  /// Limit of one world component of a contact force at its present normal force f_n:
  ///
  ///   f_n n_i ± μ f_n √(1 - n_i²)
  ///
  /// This is the edge of the friction cone along that axis. Along the normal the lower limit is 0
  /// (no pulling) and there is no upper limit. NaN while the contact is open.
  double force_limit(const TrajectoryPoint& p, int c, int axis, double side) const {
    constexpr double kAlong = 0.999;  // |n_i| above this: the axis is the normal
    const Surface* const surface = surface_below(p, c);
    if (surface == nullptr) return kNothing;
    const double along = surface->normal(axis);
    if (std::abs(along) > kAlong) return side * along < 0.0 ? 0.0 : kNothing;
    const double normal = surface->normal.dot(p.force.segment<3>(3 * c));
    return normal * (along + side * surface->friction * std::sqrt(1.0 - along * along));
  }

  /// Tangential force over the friction limit; NaN while the contact is open or nearly unloaded.
  double friction_share(const TrajectoryPoint& p, int c) const {
    const Surface* const surface = surface_below(p, c);
    if (surface == nullptr) return kNothing;
    const Eigen::Vector3d f = p.force.segment<3>(3 * c);
    const double normal = surface->normal.dot(f);
    if (normal < kLeastLoad * robot_.weight()) return kNothing;
    return (f - normal * surface->normal).norm() / (surface->friction * normal);
  }

  const MotionProblem& problem_;
  const RobotModel& robot_;
  const Points& plan_;
  const Points& simulation_;
};

}  // namespace

Json report_charts(const MotionProblem& problem, const Points& plan, const Points& simulation, const Tube* tube) {
  const Charts charts(problem, plan, simulation);
  Json tabs = {{{"name", "Torques"}, {"charts", charts.torques()}},
               {{"name", "Base"}, {"charts", charts.base()}},
               {{"name", "Joints"}, {"charts", charts.joint_positions()}},
               {{"name", "Rates"}, {"charts", charts.joint_velocities()}},
               {{"name", "Forces"}, {"charts", charts.forces()}},
               {{"name", "Margins"}, {"charts", charts.margins()}}};
  if (tube) tabs.push_back({{"name", "Tube"}, {"charts", charts.deviations_in(*tube)}});
  return tabs;
}

Json report_gains(const TrackingPlan& plan, double step) {
  Json times = Json::array();
  std::vector<float> values;
  for (const TrackingPlan::Segment& segment : plan.segments) {
    const double length = segment.end - segment.start;
    const int parts = std::clamp(static_cast<int>(std::ceil(length / step)), 1, segment.samples - 1);
    for (int i = 0; i <= parts; ++i) {  // including both ends of the segment
      const int sample = static_cast<int>(std::lround(static_cast<double>(i) * (segment.samples - 1) / parts));
      times.push_back(segment.start + length * sample / (segment.samples - 1));
      const Eigen::Map<const Eigen::MatrixXd> K(plan.gains.col(segment.first_sample + sample).data(), plan.nu(),
                                                2 * plan.nv());
      for (int j = 0; j < plan.nu(); ++j) {
        for (int k = 0; k < 2 * plan.nv(); ++k) values.push_back(static_cast<float>(K(j, k)));
      }
    }
  }
  return {{"time", times}, {"values", base64(values)}};
}

}  // namespace prowl
