#include "prowl/task_file/task_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/mesh/first_mesh.hpp"
#include "prowl/motion/duration_limits.hpp"
#include "prowl/task_file/interval_shares.hpp"
#include "prowl/task_file/problem_fields.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "prowl/task_file/task_cost.hpp"
#include "prowl/task_file/task_gait.hpp"
#include "prowl/task_file/task_goals.hpp"
#include "prowl/task_file/task_payload.hpp"
#include "prowl/task_file/task_reference.hpp"
#include "prowl/task_file/task_robust.hpp"
#include "prowl/task_file/task_simulation.hpp"
#include "prowl/task_file/task_start.hpp"
#include "prowl/task_file/task_terms.hpp"
#include "prowl/task_file/task_tracking.hpp"
#include "prowl/task_file/toml/toml_value.hpp"
#include "prowl/text/name_check.hpp"

namespace prowl {
namespace {

constexpr int kMostFreeSteps = 200;
constexpr double kShortestNormal = 1e-6;

std::vector<Eigen::Vector2d> read_patch(const TomlValue& value) {
  std::vector<Eigen::Vector2d> corners;
  for (const TomlValue& corner : value.as_list()) {
    const std::vector<TomlValue> numbers = corner.as_list(2);
    corners.emplace_back(numbers[0].as_number(), numbers[1].as_number());
  }
  if (const std::string fault = Surface::patch_fault(corners); !fault.empty()) value.fail(fault);
  return corners;
}

std::vector<Surface> read_surfaces(const TomlTable& root) {
  std::vector<Surface> surfaces;
  for (const TomlTable& table : root.find_tables("surface")) {
    Surface surface;
    surface.name = table.need("name").as_name();
    for (const Surface& other : surfaces) {
      if (other.name == surface.name) table.need("name").fail("\"" + surface.name + "\" is already another surface");
    }
    if (const auto point = table.find("point_m")) surface.point = point->as_vector3();
    if (const auto normal = table.find("normal")) {
      surface.normal = normal->as_vector3();
      if (surface.normal.norm() < kShortestNormal) {
        normal->fail(fmt::format("too short for a direction; need a length of {:g} or more", kShortestNormal));
      }
      surface.normal.normalize();
    }
    if (const auto patch = table.find("patch_m")) surface.patch = read_patch(*patch);
    if (const auto friction = table.find("friction")) surface.friction = friction->as_number();
    surfaces.push_back(surface);
  }
  if (surfaces.empty()) surfaces.emplace_back();
  return surfaces;
}

struct ContactNames {
  std::vector<std::string> contacts, surfaces;
};

std::vector<PhaseContact> read_phase_contacts(const TomlValue& value, const ContactNames& names) {
  std::vector<PhaseContact> contacts;
  if (value.is_text() && value.as_text() == "all") {
    for (int c = 0; c < static_cast<int>(names.contacts.size()); ++c) contacts.push_back({c, 0});
    return contacts;
  }
  if (!value.is_list()) value.fail("need \"all\" or a list of contacts");
  for (const TomlValue& entry : value.as_list()) {
    PhaseContact contact;
    if (entry.is_table()) {
      const TomlTable table(entry, task_file_keys(), "phase.contacts");
      contact.contact = static_cast<int>(table.need("contact").as_one_of("contact", names.contacts));
      if (const auto surface = table.find("surface")) {
        contact.surface = static_cast<int>(surface->as_one_of("surface", names.surfaces));
      }
      if (const auto point = table.find("place_m")) contact.foothold = point->as_vector3();
      if (const auto unloaded = table.find("unloaded")) contact.unloaded = unloaded->as_boolean();
    } else {
      contact.contact = static_cast<int>(entry.as_one_of("contact", names.contacts));
    }
    for (const PhaseContact& other : contacts) {
      if (other.contact == contact.contact) entry.fail("this contact is in the list twice");
    }
    contacts.push_back(contact);
  }
  return contacts;
}

/// Phases of the file and their intervals, empty if the file does not say; for phases with free steps their key
/// `steps`.
struct FilePhases {
  std::vector<Phase> phases;
  std::vector<int> intervals;
  std::vector<std::optional<TomlValue>> free_steps;
};

FilePhases read_phases(const TomlTable& root, const ContactNames& names) {
  root.need("phase");
  FilePhases read;
  for (const TomlTable& table : root.find_tables("phase")) {
    Phase phase;
    const auto name = table.find("name");
    phase.name = name ? name->as_name() : fmt::format("phase {}", read.phases.size() + 1);
    for (const Phase& other : read.phases) {
      if (other.name == phase.name) table.value().fail("\"" + phase.name + "\" is already another phase");
    }
    phase.contacts = read_phase_contacts(table.need("contacts"), names);
    const TomlBounds duration = table.need("duration_s").as_range();
    phase.duration = {duration.lower, duration.upper};
    const auto intervals = table.find("intervals");
    if (intervals) read.intervals.push_back(intervals->as_integer());
    auto steps = table.find("steps");
    if (steps && steps->as_choice("kind of steps") == "equal") steps.reset();
    if (steps && !intervals) steps->fail("free steps need the key intervals: each interval has a duration of its own");
    if (steps && phase.duration.is_fixed()) {
      steps->fail("a fixed duration has no free steps; need duration_s = [min, max]");
    }
    read.phases.push_back(phase);
    read.free_steps.push_back(steps);
  }
  if (read.phases.empty()) root.need("phase").fail("an empty list is not allowed; need one phase or more");
  if (!read.intervals.empty() && read.intervals.size() < read.phases.size()) {
    for (const TomlTable& table : root.find_tables("phase")) {
      if (!table.find("intervals"))
        table.value().fail("no intervals, which other phases have; need all of them or none");
    }
  }
  return read;
}

/// Equal steps, `intervals` per phase.
Mesh mesh_of(const std::vector<int>& intervals) {
  Mesh mesh;
  for (const int count : intervals) mesh.phases.emplace_back(count);
  return mesh;
}

/// Splits a phase with free steps into phases of one interval: each step is a duration between the
/// phase's bounds / intervals. Moments stay at their nodes.
void split_free_steps(FilePhases& read, Mesh& mesh_of_file, const std::vector<PhaseFraction*>& moments) {
  std::vector<Phase> pieces;
  Mesh mesh;
  std::vector<int> first;
  for (std::size_t p = 0; p < read.phases.size(); ++p) {
    const Phase& phase = read.phases[p];
    first.push_back(static_cast<int>(pieces.size()));
    if (!read.free_steps[p]) {
      pieces.push_back(phase);
      mesh.phases.push_back(mesh_of_file.phases[p]);
      continue;
    }
    const int n = mesh_of_file.phases[p].intervals();
    if (n > kMostFreeSteps) {
      read.free_steps[p]->fail(
          fmt::format("{} free steps are not allowed; need at most {}: each is a phase of its own", n, kMostFreeSteps));
    }
    for (int i = 0; i < n; ++i) {
      Phase& step = pieces.emplace_back(phase);
      step.name = fmt::format("{} step {}", phase.name, i + 1);
      step.duration = {phase.duration.min / n, phase.duration.max / n};
      mesh.phases.emplace_back(1);
      if (i == 0) continue;
      for (PhaseContact& contact : step.contacts) contact.foothold.reset();  // landed in the first step
    }
  }
  for (PhaseFraction* moment : moments) {
    const auto p = static_cast<std::size_t>(moment->phase);
    const int node = read.free_steps[p] ? mesh_of_file.phases[p].node_at(moment->fraction).value() : 0;
    *moment = node == 0 ? PhaseFraction{first[p], moment->fraction} : PhaseFraction::end_of(first[p] + node - 1);
  }
  read.phases = std::move(pieces);
  mesh_of_file = std::move(mesh);
}

void check_lengths(const TomlTable& root, const FilePhases& read) {
  double seconds = 0.0;
  for (const Phase& phase : read.phases) seconds += phase.duration.max;
  if (seconds > kLongestMotion) {
    root.value().fail(
        fmt::format("phases of {:g} s in all are not allowed; need at most {:g} s", seconds, kLongestMotion));
  }
}

void check_intervals(const TomlTable& root, const Mesh& mesh) {
  if (const int total = mesh.num_intervals(); total > kMostIntervals) {
    root.value().fail(fmt::format("{} mesh intervals in all are not allowed; need at most {}", total, kMostIntervals));
  }
}

/// Throws InputError for overrides outside the ranges of the keys that they replace.
void check_overrides(const SourceText& task_file, const TaskOverrides& overrides) {
  const auto check = [&](const char* table, const char* name, auto value) {
    const NumberRange& range = file_key(task_file_keys(), table, name).range;
    if (!value || range.contains(*value)) return;
    throw InputError(fmt::format("{}: {} = {} in place of the file's is not allowed; need a number {}",
                                 task_file.path.string(), name, *value, range.limits()));
  };
  check("phase", "intervals", overrides.intervals);
  check("solver", "max_iterations", overrides.max_iterations);
  check("solver", "max_time_s", overrides.max_seconds);
  check("solver", "tolerance", overrides.tolerance);
}

SolverOptions read_solver(const TomlTable& root, const TaskOverrides& overrides) {
  SolverOptions options;
  if (const auto table = root.find_table("solver")) {
    if (const auto value = table->find("tolerance")) options.tolerance = value->as_number();
    if (const auto value = table->find("max_iterations")) options.max_iterations = value->as_integer();
    if (const auto value = table->find("max_time_s")) options.max_seconds = value->as_number();
  }
  options.max_iterations = overrides.max_iterations.value_or(options.max_iterations);
  options.max_seconds = overrides.max_seconds.value_or(options.max_seconds);
  options.tolerance = overrides.tolerance.value_or(options.tolerance);
  return options;
}

/// A problem with its mesh.
struct FileProblem {
  MotionProblem problem;
  Mesh mesh;
  bool has_intervals;
  std::vector<int> file_intervals;  ///< see Task
  std::optional<SourceText> reference_file;
};

FileProblem read_problem(const TomlTable& root, RobotModel robot, const SourceText& robot_file,
                         const TaskOverrides& overrides, const std::optional<SourceText>& stored_reference,
                         const std::filesystem::path& folder, const OwnTermReader& own_terms) {
  std::vector<Surface> surfaces = read_surfaces(root);
  ContactNames names;
  for (const ContactPoint& contact : robot.contacts()) names.contacts.push_back(contact.name);
  for (const Surface& surface : surfaces) names.surfaces.push_back(surface.name);
  TaskStart start = read_start(root, robot, robot_file, surfaces);
  const std::optional<TaskGait> gait = read_gait(root, robot, surfaces, start);
  FilePhases read = gait ? FilePhases{gait->phases, gait->intervals, {}} : read_phases(root, names);
  read.free_steps.resize(read.phases.size());
  check_lengths(root, read);
  const bool repeats = gait && gait->cycle;
  if (repeats) start.q = gait->cycle_start;
  fit_contacts(root, robot, surfaces, read.phases.front(), start);
  const bool has_intervals = !read.intervals.empty() || overrides.intervals;
  std::vector<int> file_intervals = read.intervals;
  if (file_intervals.empty()) {
    for (const PhaseMesh& phase : first_mesh(read.phases, {}).phases) file_intervals.push_back(phase.intervals());
  }
  std::optional<Mesh> equal_steps;
  if (overrides.intervals) {
    equal_steps = mesh_of(share_intervals(file_intervals, *overrides.intervals));
  } else if (has_intervals) {
    equal_steps = mesh_of(file_intervals);
  }
  if (equal_steps) check_intervals(root, *equal_steps);

  std::vector<BoundaryConstraint> constraints = {
      repeats ? BoundaryConstraint::unbounded(robot, "start", PhaseFraction::start_of(0), start.q)
              : start_constraint(robot, start)};
  for (BoundaryConstraint& goal : read_goals(root, robot, start, read.phases, equal_steps))
    constraints.push_back(std::move(goal));
  if (gait && gait->travel) {
    const auto& [displacement, rotation] = *gait->travel;
    constraints.push_back(arrival(robot, start, displacement, rotation, static_cast<int>(read.phases.size())));
  }
  std::vector<TermUse> terms = read_terms(root, robot, read.phases, equal_steps, own_terms);
  std::vector<PhaseFraction*> moments;
  for (BoundaryConstraint& constraint : constraints) moments.push_back(&constraint.at);
  for (TermUse& use : terms) moments.insert(moments.end(), {&use.from, &use.to});
  std::vector<PhaseFraction> nodes;
  for (const PhaseFraction* moment : moments) nodes.push_back(*moment);
  Mesh mesh = equal_steps ? std::move(*equal_steps) : first_mesh(read.phases, nodes);
  check_intervals(root, mesh);
  split_free_steps(read, mesh, moments);

  MotionProblem problem{.name = "",
                        .robot = std::move(robot),
                        .surfaces = std::move(surfaces),
                        .phases = std::move(read.phases),
                        .boundary_constraints = std::move(constraints),
                        .running_cost = {},
                        .terminal_cost = {},
                        .terms = std::move(terms),
                        .friction_model = {},
                        .swing_clearance = 0.0,
                        .least_load = kLeastLoadShare,
                        .goal_tolerance = {},
                        .cycle = gait ? gait->cycle : std::nullopt};
  const auto clearance = root.find("swing_clearance_m");
  problem.swing_clearance =
      clearance ? clearance->as_number() : kSwingClearanceShare * problem.robot.nominal_configuration()(2);
  if (const auto share = root.find("least_load")) problem.least_load = share->as_number();
  if (const auto model = root.find("friction_model")) {
    problem.friction_model =
        model->as_choice("friction model") == "cone" ? FrictionModel::cone : FrictionModel::pyramid;
  }
  // A mesh of the user's own may be too coarse to end the acceleration within its last interval.
  problem.stands_at_end = !has_intervals && can_stand_at_end(problem);
  read_costs(root, problem);
  std::optional<SourceText> reference_file = read_reference(root, folder, stored_reference, problem);
  return {std::move(problem), std::move(mesh), has_intervals, std::move(file_intervals), std::move(reference_file)};
}

std::filesystem::path robot_path(const TomlDocument& document, const SourceText& task_file, const TomlTable& root) {
  const auto robot = root.find("robot");
  if (!robot) document.read_with([&] { return root.need("robot"); });  // throws, also for a misspelt key
  return (task_file.path.parent_path() / robot->as_text()).lexically_normal();
}

TomlTable task_root(const TomlDocument& document) {
  document.refuse_key(
      "urdf", "this looks like a robot file; need a task file, which names its robot file with robot = \"...\"");
  document.check_all_keys(task_file_keys());
  return document.root(task_file_keys());
}

/// File name without extension, with '_' for characters not allowed in names.
std::string name_of_file(const std::filesystem::path& path) {
  std::string name = path.stem().string();
  for (char& c : name) {
    if (!is_name(std::string(1, c))) c = '_';
  }
  return name;
}

/// The robot; its errors are added to those of `document` and thrown as InputError.
RobotModel robot_of(const TomlDocument& document, const SourceText& robot_file, const PackageSearch& search,
                    const std::optional<SourceText>& urdf) {
  try {
    return load_robot(robot_file, search, {.urdf_copy = urdf});
  } catch (const InputError& error) {
    document.add_mistake(error.what());
    throw;
  }
}

Task read_document(const TomlDocument& document, const SourceText& task_file, const SourceText& robot_file,
                   const PackageSearch& search, const TaskOverrides& overrides, const StoredFiles& stored,
                   const OwnTerms& own_terms) {
  const TomlTable root = task_root(document);
  root.need("robot").as_text();
  check_overrides(task_file, overrides);
  const SolverOptions solver = read_solver(root, overrides);
  const TaskSimulation simulation = read_simulation(root);
  const std::filesystem::path folder = task_file.path.parent_path();
  auto [problem, mesh, has_intervals, file_intervals, reference_file] =
      read_problem(root, with_payloads(root, robot_of(document, robot_file, search, stored.urdf)), robot_file,
                   overrides, stored.reference, folder, OwnTermReader(own_terms, folder));
  const auto name = root.find("name");
  problem.name = name ? name->as_name() : name_of_file(task_file.path);
  try {
    validate(problem);
  } catch (const InputError& error) {
    throw InputError(in_terms_of_the_file(task_file, error.what()));
  }
  TrackingOptions tracking = read_tracking(root, problem.robot);
  const std::optional<Disturbances> robust = read_robust(root, problem, overrides.robust);
  const double planned = std::ranges::min(problem.surfaces, {}, &Surface::friction).friction;
  const std::optional<double> simulated_friction =
      simulation.friction.value_or(planned) < planned ? simulation.friction : std::nullopt;
  return {.problem = std::move(problem),
          .mesh = std::move(mesh),
          .has_intervals = has_intervals,
          .solver = solver,
          .tracking = std::move(tracking),
          .robust = robust,
          .success = simulation.success,
          .simulated_friction = simulated_friction,
          .task_file = task_file,
          .robot_file = robot_file,
          .reference_file = std::move(reference_file),
          .overrides = overrides,
          .own_terms = own_terms,
          .file_intervals = std::move(file_intervals)};
}

}  // namespace

Task parse_task(const SourceText& task_file, const SourceText& robot_file, const PackageSearch& search,
                const TaskOverrides& overrides, const StoredFiles& stored, const OwnTerms& own_terms) {
  const TomlDocument document(task_file);
  return document.read_with(
      [&] { return read_document(document, task_file, robot_file, search, overrides, stored, own_terms); });
}

Task read_task_text(const SourceText& task_file, const PackageSearch& search, const TaskOverrides& overrides,
                    const OwnTerms& own_terms) {
  const TomlDocument document(task_file);
  const TomlTable root = task_root(document);
  const std::filesystem::path robot = robot_path(document, task_file, root);
  std::error_code unknown;  // reported by read_text_file()
  if (!std::filesystem::exists(robot, unknown) && !unknown)
    root.need("robot").fail(fmt::format("no such file: {}", robot.string()));
  SourceText robot_file;
  try {
    robot_file = read_text_file(robot);
  } catch (const InputError& error) {
    root.need("robot").fail(error.what());
  }
  return parse_task(task_file, robot_file, search, overrides, {}, own_terms);
}

Task read_task_file(const std::filesystem::path& path, const PackageSearch& search, const TaskOverrides& overrides,
                    const OwnTerms& own_terms) {
  return read_task_text(read_text_file(path), search, overrides, own_terms);
}

std::string task_slug(const std::filesystem::path& task_file) {
  const std::filesystem::path path = std::filesystem::absolute(task_file).lexically_normal();
  const std::string folder = path.parent_path().filename().string();
  return folder.empty() ? path.stem().string() : folder + "_" + path.stem().string();
}

}  // namespace prowl
