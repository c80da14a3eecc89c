#include "prowl/report_page/online_page.hpp"

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/files/base64.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/online_json.hpp"
#include "prowl/report_page/report_json.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

/// Phases of equal contact, as measured: one begins where a contact starts or stops to push.
Json phases_json(const std::vector<OnlineSample>& samples) {
  Json phases = Json::array();
  Json before;
  for (const OnlineSample& sample : samples) {
    Json contacts = Json::array();
    for (Eigen::Index c = 0; 3 * c < sample.force.size(); ++c) {
      if (!sample.force.segment<3>(3 * c).isZero()) contacts.push_back({{"contact", c}, {"surface", 0}});
    }
    if (!phases.empty()) phases.back()["end"] = sample.time;
    if (!phases.empty() && contacts == before) continue;
    phases.push_back(
        {{"name", ""}, {"start", sample.time}, {"end", sample.time}, {"intervals", 1}, {"contacts", contacts}});
    before = contacts;
  }
  return phases;
}

Json motion_json(const RobotModel& robot, const std::vector<OnlineSample>& samples) {
  std::vector<TrajectoryPoint> points;
  for (const OnlineSample& sample : samples) {
    TrajectoryPoint& point = points.emplace_back();
    point.time = sample.time;
    point.q = sample.q;
    point.force = sample.force;
  }
  return report_motion_json(robot, points);
}

template <class Value>
Json values_json(const std::vector<OnlineSample>& samples, const Value& value) {
  std::vector<float> values;
  for (const OnlineSample& sample : samples) values.push_back(static_cast<float>(value(sample)));
  return base64(values);
}

Json moves_json(const std::vector<OnlineSample>& samples) {
  const std::pair<const char*, const char*> parts[] = {
      {"velocity ahead", "m/s"}, {"velocity to the left", "m/s"}, {"turn rate", "rad/s"}};
  Json charts = Json::array();
  for (int i = 0; i < 3; ++i) {
    charts.push_back({{"title", parts[i].first},
                      {"unit", parts[i].second},
                      {"commanded", values_json(samples, [i](const auto& s) { return s.commanded(i); })},
                      {"measured", values_json(samples, [i](const auto& s) { return s.moves(i); })}});
  }
  return charts;
}

Json pushes_json(const OnlineOptions& options) {
  Json pushes = Json::array();
  for (const Push& push : options.simulation.pushes) {
    pushes.push_back({{"time", push.time},
                      {"duration", push.duration},
                      {"impulse", {push.impulse.x(), push.impulse.y(), push.impulse.z()}}});
  }
  return pushes;
}

/// Gaits that the robot can do.
Json gaits_json(const RobotModel& robot) {
  Json gaits = Json::array();
  const double height = standing_on_ground(robot).z();
  for (const std::string& gait : stepping_gaits()) {
    try {
      stepping_pattern(robot, contacts_of_feet(robot), height, gait);
      gaits.push_back(gait);
    } catch (const InputError&) {
      continue;
    }
  }
  return gaits;
}

Json milliseconds(const std::vector<double>& seconds) {
  std::vector<float> values;
  for (const double time : seconds) values.push_back(static_cast<float>(1e3 * time));
  return base64(values);
}

}  // namespace

std::string online_page(const OnlinePageInputs& inputs, const PackageSearch& search,
                        std::vector<std::string>& warnings) {
  const auto& [robot, options, result, template_html, state] = inputs;
  Json data = {{"robot", robot.name()},
               {"weight_N", robot.weight()},
               {"size_m", robot.size()},
               {"mass_kg", robot.mass()},
               {"gait", options.gait},
               {"gaits", gaits_json(robot)},
               {"period_s", options.period},
               {"budget_s", options.budget},
               {"scene", report_scene(robot, {ground_of(options)}, search, warnings)},
               {"phases", phases_json(result.samples)},
               {"plan", motion_json(robot, result.samples)},
               {"height", values_json(result.samples, [](const auto& s) { return s.q(2); })},
               {"moves", moves_json(result.samples)},
               {"pushes", pushes_json(options)},
               {"times_ms", milliseconds(result.times)},
               {"result", nullptr},
               {"live", state == PageState::solving}};
  if (state != PageState::solving) data["result"] = Json::parse(online_json(robot, options, result));
  data["warnings"] = warnings;
  return filled_page(template_html, data.dump(-1, ' ', false, Json::error_handler_t::replace),
                     state != PageState::file);
}

std::string online_event(const RobotModel& robot, const OnlineSample& sample) {
  const auto triple = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  const Json json = {{"time", sample.time},
                     {"plan", motion_json(robot, {sample})},
                     {"phases", phases_json({sample})},
                     {"commanded", triple(sample.commanded)},
                     {"measured", triple(sample.moves)}};
  return json.dump();
}

}  // namespace prowl
