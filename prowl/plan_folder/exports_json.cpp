#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/urdf/link_tree.hpp"
#include "prowl/plan_folder/exports.hpp"
#include "prowl/plan_folder/gain_columns.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/trajectory/phase_span.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

/// On one line: an indented array of numbers would have one a line.
std::string compact(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json to_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

Json to_json(const Eigen::Isometry3d& placement) {
  const Eigen::Quaterniond r = Eigen::Quaterniond(placement.linear()).normalized();
  const Eigen::Vector3d p = placement.translation();
  return {p.x(), p.y(), p.z(), r.x(), r.y(), r.z(), r.w()};
}

Json triples(const Eigen::VectorXd& values) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < values.size(); i += 3) json.push_back(to_json(values.segment<3>(i)));
  return json;
}

Json rows(const Eigen::MatrixXd& matrix) {
  Json json = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) json.push_back(to_json(matrix.row(r).transpose()));
  return json;
}

std::vector<std::string> contact_names(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const ContactPoint& contact : robot.contacts()) names.push_back(contact.name);
  return names;
}

/// The columns of trajectory.csv, by quantity: their names have the units.
Json component_names(const RobotModel& robot) {
  const std::vector<std::string> columns = trajectory_columns(robot);
  const auto nu = static_cast<std::ptrdiff_t>(robot.nu());
  const auto part = [&](std::ptrdiff_t base, std::ptrdiff_t base_size, std::ptrdiff_t joints) {
    std::vector<std::string> names(columns.begin() + base, columns.begin() + base + base_size);
    names.insert(names.end(), columns.begin() + joints, columns.begin() + joints + nu);
    return names;
  };
  constexpr std::ptrdiff_t kFirst = 2, kBase = 7 + 6 + 6;  // time_s, phase; base of q, v, a
  return {{"q", part(kFirst, 7, kFirst + kBase)},
          {"v", part(kFirst + 7, 6, kFirst + kBase + nu)},
          {"a", part(kFirst + 13, 6, kFirst + kBase + 2 * nu)},
          {"tau", part(kFirst, 0, kFirst + kBase + 3 * nu)},
          {"K", gain_columns(robot)}};
}

/// As planned, with their times.
Json phases_json(const PlanRecord& plan) {
  const MotionProblem& problem = plan.task.problem;
  Json phases = Json::array();
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const std::optional<PhaseSpan> span = phase_span(plan.plan.trajectory, p);
    if (!span) continue;
    Json contacts = Json::array();
    for (const PhaseContact& c : problem.phases[p].contacts) {
      contacts.push_back(
          {{"contact", problem.robot.contacts()[c.contact].name}, {"surface", problem.surfaces[c.surface].name}});
    }
    phases.push_back(
        {{"name", problem.phases[p].name}, {"start_s", span->start}, {"end_s", span->end}, {"contacts", contacts}});
  }
  return phases;
}

Json surfaces_json(const MotionProblem& problem) {
  Json surfaces = Json::array();
  for (const Surface& surface : problem.surfaces) {
    Json patch = Json::array();
    for (const Eigen::Vector2d& corner : surface.patch) patch.push_back(to_json(Eigen::VectorXd(surface.at(corner))));
    surfaces.push_back({{"name", surface.name},
                        {"point_m", to_json(Eigen::VectorXd(surface.point))},
                        {"normal", to_json(Eigen::VectorXd(surface.normal))},
                        {"friction", surface.friction},
                        {"patch_m", patch}});
  }
  return surfaces;
}

Json links_json(const std::vector<RobotLink>& links) {
  Json json = Json::array();
  for (const RobotLink& link : links) {
    Json parent = nullptr;
    if (link.parent >= 0) parent = links[link.parent].name;
    json.push_back({{"name", link.name}, {"parent", parent}, {"fixed", link.fixed}});
  }
  return json;
}

/// Fills what is a list with one entry a sample. `in_parent` gets the placements of the links in their parents.
Json samples_json(const RobotModel& robot, const MotionSamples& samples, const std::vector<RobotLink>& links,
                  Json& in_parent) {
  const BodyTree tree = body_tree(robot);
  BodyPlacements placements(robot);
  Json json = {{"time_s", Json::array()},
               {"phase", Json::array()},
               {"q", Json::array()},
               {"v", Json::array()},
               {"a", nullptr},
               {"tau", Json::array()},
               {"in_contact", Json::array()},
               {"force_N", Json::array()},
               {"contact_position_m", Json::array()},
               {"link_placement", Json::array()},
               {"K", nullptr}};
  if (!samples.simulated) json["a"] = Json::array();
  if (!samples.gains.empty()) json["K"] = Json::array();
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const TrajectoryPoint& point = samples.points[i];
    json["time_s"].push_back(point.time);
    json["phase"].push_back(point.phase);
    json["q"].push_back(to_json(point.q));
    json["v"].push_back(to_json(point.v));
    if (!samples.simulated) json["a"].push_back(to_json(point.a));
    json["tau"].push_back(to_json(point.tau));
    json["in_contact"].push_back(samples.in_contact[i]);
    json["force_N"].push_back(triples(point.force));
    if (!samples.gains.empty()) json["K"].push_back(rows(samples.gains[i]));

    const std::vector<Eigen::Isometry3d>& bodies = placements.at(point.q);
    const std::vector<Eigen::Isometry3d> world = link_placements(links, bodies);
    Json in_world = Json::array(), relative = Json::array(), contacts = Json::array();
    for (std::size_t l = 0; l < links.size(); ++l) {
      const int parent = links[l].parent;
      in_world.push_back(to_json(world[l]));
      relative.push_back(to_json(parent < 0 ? world[l] : world[parent].inverse() * world[l]));
    }
    for (const BodyTree::Point& contact : tree.points) {
      contacts.push_back(to_json(Eigen::VectorXd(bodies[contact.body] * contact.position)));
    }
    json["link_placement"].push_back(std::move(in_world));
    json["contact_position_m"].push_back(std::move(contacts));
    in_parent.push_back(std::move(relative));
  }
  return json;
}

Json motion(const PlanRecord& plan, const MotionSamples& samples, Json& in_parent) {
  const MotionProblem& problem = plan.task.problem;
  const RobotModel& robot = problem.robot;
  const std::vector<RobotLink> links = link_tree(robot);
  return {{"format", kFormat},
          {"robot", robot.name()},
          {"task", problem.name},
          {"motion", samples.simulated ? "simulation" : "plan"},
          {"good", is_good(plan.plan)},
          {"mass_kg", robot.mass()},
          {"joints", robot.joint_names()},
          {"contacts", contact_names(robot)},
          {"links", links_json(links)},
          {"surfaces", surfaces_json(problem)},
          {"phases", phases_json(plan)},
          {"components", component_names(robot)},
          {"samples", samples_json(robot, samples, links, in_parent)}};
}

Json time_json(double time) {
  const auto nanoseconds = static_cast<long long>(std::llround(1e9 * time));
  return {{"sec", nanoseconds / 1'000'000'000}, {"nanosec", nanoseconds % 1'000'000'000}};
}

}  // namespace

std::string motion_json(const PlanRecord& plan, const MotionSamples& samples) {
  Json unused = Json::array();
  return compact(motion(plan, samples, unused));
}

std::string exchange_json(const PlanRecord& plan, const MotionSamples& samples) {
  Json in_parent = Json::array();
  Json json = motion(plan, samples, in_parent);
  json["link_in_parent"] = std::move(in_parent);
  json["one_a_time"] = samples.one_a_time();
  json["urdf"] = plan.task.problem.robot.description().urdf_text;
  return compact(json);
}

std::string joint_trajectory_json(const RobotModel& robot, const MotionSamples& samples) {
  const auto nu = robot.nu();
  Json points = Json::array();
  for (const std::size_t i : samples.one_a_time()) {
    const TrajectoryPoint& point = samples.points[i];
    points.push_back({{"positions", to_json(point.q.tail(nu))},
                      {"velocities", to_json(point.v.tail(nu))},
                      {"accelerations", samples.simulated ? Json::array() : to_json(point.a.tail(nu))},
                      {"effort", to_json(point.tau)},
                      {"time_from_start", time_json(point.time)}});
  }
  return compact({{"header", {{"stamp", {{"sec", 0}, {"nanosec", 0}}}, {"frame_id", ""}}},
                  {"joint_names", robot.joint_names()},
                  {"points", points}});
}

}  // namespace prowl
