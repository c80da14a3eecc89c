#include "prowl/plan_folder/trajectory_csv.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "prowl/error.hpp"
#include "prowl/files/csv_table.hpp"

namespace prowl {
namespace {

using Row = std::vector<double>;

void append(Row& row, const Eigen::VectorXd& values) { row.insert(row.end(), values.begin(), values.end()); }

bool touches(const Phase& phase, int contact) {
  return std::any_of(phase.contacts.begin(), phase.contacts.end(), [&](const auto& c) { return c.contact == contact; });
}

Row to_row(const MotionProblem& problem, const TrajectoryPoint& point) {
  Row row = {point.time, static_cast<double>(point.phase)};
  const auto nu = problem.robot.nu();
  append(row, point.q.head<7>());
  append(row, point.v.head<6>());
  append(row, point.a.head<6>());
  append(row, point.q.tail(nu));
  append(row, point.v.tail(nu));
  append(row, point.a.tail(nu));
  append(row, point.tau);
  for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) {
    row.push_back(touches(problem.phases[point.phase], c) ? 1.0 : 0.0);
    append(row, point.force.segment<3>(3 * c));
  }
  return row;
}

/// `row` of a node of the given phase.
TrajectoryPoint from_row(const RobotModel& robot, std::size_t phase, const Row& row) {
  TrajectoryPoint point{
      .time = row[0], .phase = static_cast<int>(phase), .q = {}, .v = {}, .a = {}, .tau = {}, .force = {}};
  const double* next = row.data() + 2;
  const auto take = [&next](auto&& target) {
    target = Eigen::Map<const Eigen::VectorXd>(next, target.size());
    next += target.size();
  };
  const auto nu = robot.nu();
  point.q.resize(robot.nq());
  point.v.resize(robot.nv());
  point.a.resize(robot.nv());
  point.tau.resize(nu);
  point.force.resize(3 * static_cast<Eigen::Index>(robot.contacts().size()));
  take(point.q.head(7));
  take(point.v.head(6));
  take(point.a.head(6));
  take(point.q.tail(nu));
  take(point.v.tail(nu));
  take(point.a.tail(nu));
  take(point.tau);
  for (Eigen::Index c = 0; c < point.force.size(); c += 3) {
    ++next;  // contact_<name>: see check_row
    take(point.force.segment(c, 3));
  }
  return point;
}

Row parse_row(const std::string& where, std::string_view line, const std::vector<std::string>& columns) {
  Row row = csv_numbers(where, line, columns);
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (std::isfinite(row[i])) continue;
    throw InputError(fmt::format("{}: {}: \"{}\" is not allowed; need a finite number", where, columns[i],
                                 split_text(line, ',')[i]));
  }
  return row;
}

/// Throws InputError unless the row is of the given phase, with its contacts and a unit quaternion.
void check_row(const std::string& where, const MotionProblem& problem, std::size_t phase, const Row& row) {
  const auto refuse = [&](const std::string& column, double value, const std::string& needed) {
    throw InputError(fmt::format("{}: {}: {} is not allowed; need {}", where, column, value, needed));
  };
  if (row[1] != static_cast<double>(phase)) refuse("phase", row[1], fmt::format("{}, as in the task's mesh", phase));
  const double norm = Eigen::Map<const Eigen::Vector4d>(row.data() + 5).norm();
  if (std::abs(norm - 1.0) > 1e-6) refuse("norm of base_qx ... base_qw", norm, "a unit quaternion");
  const std::vector<ContactPoint>& contacts = problem.robot.contacts();
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const double flag = row[row.size() - 4 * (contacts.size() - c)];
    const double expected = touches(problem.phases[phase], static_cast<int>(c)) ? 1.0 : 0.0;
    if (flag != expected) refuse("contact_" + contacts[c].name, flag, fmt::format("{}, as in the task", expected));
  }
}

/// Throws InputError unless the nodes from `first` on fit the phase that starts at `begin`. Returns its end [s].
double check_times(const std::string& file, const Phase& phase, const PhaseMesh& mesh, double begin,
                   const TrajectoryPoint* first, std::size_t line) {
  constexpr double kRounding = 1e-9;  // of the time
  const double duration = phase.duration.is_fixed() ? phase.duration.min : first[mesh.intervals()].time - begin;
  const double slack = kRounding * (1.0 + begin + phase.duration.max);
  if (duration < phase.duration.min - slack || duration > phase.duration.max + slack) {
    throw InputError(fmt::format("{}:{}: phase '{}' lasts {} s; the task allows {} to {} s", file,
                                 line + static_cast<std::size_t>(mesh.intervals()), phase.name, duration,
                                 phase.duration.min, phase.duration.max));
  }
  for (int node = 0; node <= mesh.intervals(); ++node) {
    const double time = begin + mesh.node_time(node, duration);
    if (std::abs(first[node].time - time) <= slack) continue;
    throw InputError(fmt::format("{}:{}: time_s: {} is not allowed; need {}, as in the task's mesh", file,
                                 line + static_cast<std::size_t>(node), first[node].time, time));
  }
  return begin + duration;
}

std::string heading(const RobotModel& robot) { return fmt::format("{}", fmt::join(trajectory_columns(robot), ",")); }

}  // namespace

std::vector<std::string> trajectory_columns(const RobotModel& robot) {
  std::vector<std::string> columns = {
      "time_s",          "phase",           "base_px_m",      "base_py_m",    "base_pz_m",    "base_qx",
      "base_qy",         "base_qz",         "base_qw",        "base_vx_mps",  "base_vy_mps",  "base_vz_mps",
      "base_wx_radps",   "base_wy_radps",   "base_wz_radps",  "base_ax_mps2", "base_ay_mps2", "base_az_mps2",
      "base_dwx_radps2", "base_dwy_radps2", "base_dwz_radps2"};
  for (const auto& joint : robot.joint_names()) columns.push_back("q_" + joint + "_rad");
  for (const auto& joint : robot.joint_names()) columns.push_back("v_" + joint + "_radps");
  for (const auto& joint : robot.joint_names()) columns.push_back("a_" + joint + "_radps2");
  for (const auto& joint : robot.joint_names()) columns.push_back("tau_" + joint + "_Nm");
  for (const ContactPoint& contact : robot.contacts()) {
    columns.push_back("contact_" + contact.name);
    for (const char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("f_{}_{}_N", contact.name, axis));
  }
  return columns;
}

std::string trajectory_to_csv(const MotionProblem& problem, const Trajectory& trajectory) {
  std::string text = fmt::format("{}\n", fmt::join(trajectory_columns(problem.robot), ","));
  for (const TrajectoryPoint& point : trajectory.nodes) {
    fmt::format_to(std::back_inserter(text), "{}\n", fmt::join(to_row(problem, point), ","));
  }
  return text;
}

std::size_t longest_trajectory(const MotionProblem& problem, const Mesh& mesh) {
  constexpr std::size_t kLongestCell = 64;  // with its comma; a double needs 25, other programs may write more digits
  return heading(problem.robot).size() + 2 +
         static_cast<std::size_t>(mesh.num_nodes()) * trajectory_columns(problem.robot).size() * kLongestCell;
}

Trajectory trajectory_from_csv(const MotionProblem& problem, const Mesh& mesh, const SourceText& source) {
  const std::string file = source.path.string();
  const std::vector<std::string> columns = trajectory_columns(problem.robot);
  const auto rows = static_cast<std::size_t>(mesh.num_nodes());
  const auto ends = static_cast<std::size_t>(std::count(source.text.begin(), source.text.end(), '\n'));
  if (ends > rows + 1) throw InputError(fmt::format("{}: {} rows; the task's mesh has {} nodes", file, ends - 1, rows));
  std::vector<std::string_view> lines = split_text(source.text, '\n');
  const bool ends_with_line = lines.back().empty();
  if (ends_with_line) lines.pop_back();
  if (lines.empty() || lines[0] != heading(problem.robot)) {
    throw InputError(fmt::format("{}:1: the columns are not those of {}", file, problem.robot.name()));
  }
  if (lines.size() != rows + 1) {
    throw InputError(fmt::format("{}: {} rows; the task's mesh has {} nodes", file, lines.size() - 1, rows));
  }
  if (!ends_with_line) throw InputError(fmt::format("{}: the last line has no line end; the file is cut short", file));
  Trajectory trajectory;
  double begin = 0.0;
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const std::size_t first = trajectory.nodes.size();
    for (int node = 0; node <= mesh.phases[p].intervals(); ++node) {
      const std::size_t line = trajectory.nodes.size() + 1;
      const std::string where = fmt::format("{}:{}", file, line + 1);
      const Row row = parse_row(where, lines[line], columns);
      check_row(where, problem, p, row);
      trajectory.nodes.push_back(from_row(problem.robot, p, row));
    }
    begin = check_times(file, problem.phases[p], mesh.phases[p], begin, &trajectory.nodes[first], first + 2);
  }
  return trajectory;
}

Trajectory sample_uniformly(const Trajectory& trajectory, double step) {
  const double end = trajectory.duration();
  if (!(step > 0.0) || end / step > kMostUniformSamples)
    throw InputError(fmt::format("step: {} s is too fine for a motion of {} s", step, end));
  Trajectory samples;
  for (long i = 0; static_cast<double>(i) * step < end - 1e-9 * step; ++i) {
    samples.nodes.push_back(sample(trajectory, static_cast<double>(i) * step));
  }
  samples.nodes.push_back(sample(trajectory, end));
  return samples;
}

}  // namespace prowl
