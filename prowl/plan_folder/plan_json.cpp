#include "prowl/plan_folder/plan_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "prowl/error.hpp"
#include "prowl/files/json_parse.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/text/shown_text.hpp"
#include "prowl/trajectory/phase_span.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

/// Version of schema/plan.schema.json. Increase it when keys change, and keep the promise of read_version.
constexpr int kSchemaVersion = 10;
constexpr int kOldestVersion = 1;  ///< its solver may lack newer keys; before version 3 phases have equal steps

/// As planned [s].
double phase_duration(const PlanRecord& record, std::size_t phase) {
  const Duration& asked = record.task.problem.phases[phase].duration;
  if (asked.is_fixed()) return asked.min;
  const PhaseSpan span = phase_span(record.plan.trajectory, phase).value_or(PhaseSpan{});
  return span.end - span.start;
}

Json problem_to_json(const PlanRecord& record) {
  const MotionProblem& problem = record.task.problem;
  Json phases = Json::array();
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    Json contacts = Json::array();
    for (const PhaseContact& c : phase.contacts) {
      contacts.push_back(problem.robot.contacts()[c.contact].name);
    }
    phases.push_back({{"name", phase.name},
                      {"duration_s", phase_duration(record, p)},
                      {"intervals", record.plan.mesh.phases[p].intervals()},
                      {"shares", record.plan.mesh.phases[p].shares()},
                      {"contacts", contacts}});
  }
  return {{"robot", problem.robot.name()},
          {"joints", problem.robot.joint_names()},
          {"phases", phases},
          {"interpolation", to_string(record.plan.trajectory.interpolation)},
          {"variables", record.plan.num_variables},
          {"constraints", record.plan.num_constraints}};
}

/// Column by column: half as long as one object per iteration.
Json convergence_to_json(const std::vector<MeshIteration>& iterations) {
  const char* const names[] = {"level", "iteration", "cost", "constraint_violation", "dual_violation", "seconds"};
  Json json = Json::object();
  for (const char* name : names) json[name] = Json::array();
  for (const MeshIteration& one : iterations) {
    const SolveProgress& p = one.progress;
    json["level"].push_back(one.level);
    json["iteration"].push_back(p.iteration);
    json["cost"].push_back(p.cost);
    json["constraint_violation"].push_back(p.constraint_violation);
    json["dual_violation"].push_back(p.dual_violation);
    json["seconds"].push_back(p.elapsed_seconds);
  }
  return json;
}

Json solver_to_json(const PlanRecord& record) {
  const SolveResult& result = record.plan.result;
  const SolverOptions& options = record.task.solver;
  Json levels = Json::array();
  for (const LevelResult& level : record.plan.levels) {
    levels.push_back({{"intervals", level.intervals},
                      {"status", to_string(level.status)},
                      {"iterations", level.iterations},
                      {"seconds", level.seconds},
                      {"cpu_seconds", level.cpu_seconds}});
  }
  return {{"name", record.plan.solver},
          {"hessian", to_string(record.plan.hessian)},
          {"message", result.message},
          {"cost", result.cost},
          {"constraint_violation", result.constraint_violation},
          {"dual_violation", result.dual_violation},
          {"iterations", result.iterations},
          {"pivoted_stages", result.pivoted_stages},
          {"seconds", result.seconds},
          {"cpu_seconds", result.times.cpu},
          {"evaluation",
           {{"values", result.times.values},
            {"derivatives", result.times.derivatives},
            {"linear_algebra", result.times.linear_algebra},
            {"guess", result.times.guess}}},
          {"levels", levels},
          {"convergence", convergence_to_json(record.iterations)},
          {"warm_start", record.warm_start},
          {"tolerance", options.tolerance},
          {"max_iterations", options.max_iterations},
          {"max_time_s", options.max_seconds}};
}

Json overrides_to_json(const TaskOverrides& overrides) {
  Json json = Json::object();
  if (overrides.intervals) json["intervals"] = *overrides.intervals;
  if (overrides.max_iterations) json["max_iterations"] = *overrides.max_iterations;
  if (overrides.max_seconds) json["max_time_s"] = *overrides.max_seconds;
  if (overrides.tolerance) json["tolerance"] = *overrides.tolerance;
  if (overrides.robust) json["robust"] = true;
  return json;
}

std::string absolute_path(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

/// One object of plan.json; errors name the key that is missing or has the wrong type.
class Reader {
 public:
  Reader(std::string where, const Json& json) : where_(std::move(where)), json_(&json) {
    if (!json.is_object()) throw InputError(where_ + ": need an object");
  }

  Reader object(const char* key) const { return {where_ + "." + key, need(key)}; }
  bool has(const char* key) const { return json_->contains(key); }
  bool is_null(const char* key) const { return need(key).is_null(); }
  std::string text(const char* key) const { return get<std::string>(key, need(key).is_string(), "a string"); }
  int integer(const char* key) const {
    constexpr auto kLargest = std::numeric_limits<int>::max();
    const Json& value = need(key);  // unsigned if not negative, otherwise signed; 64 bits
    const bool fits = value.is_number_unsigned() ? value.get<std::uint64_t>() <= static_cast<std::uint64_t>(kLargest)
                                                 : value.is_number_integer() && value.get<std::int64_t>() >= -kLargest;
    return get<int>(key, fits, fmt::format("an integer from {} to {}", -kLargest, kLargest));
  }
  bool flag(const char* key) const { return get<bool>(key, need(key).is_boolean(), "true or false"); }
  /// null stands for NaN and the infinities, which JSON does not have.
  double number(const char* key) const {
    if (need(key).is_null()) return std::numeric_limits<double>::quiet_NaN();
    return get<double>(key, need(key).is_number(), "a number");
  }
  std::vector<Reader> list(const char* key) const {
    if (!need(key).is_array()) fail(key, "a list");
    std::vector<Reader> entries;
    for (const Json& entry : need(key))
      entries.emplace_back(fmt::format("{}.{}[{}]", where_, key, entries.size()), entry);
    return entries;
  }
  /// null as in number(). Indices among them are small enough to be exact.
  std::vector<double> numbers(const char* key) const {
    const Json& list = need(key);
    const auto is_number = [](const Json& entry) { return entry.is_number() || entry.is_null(); };
    if (!list.is_array() || !std::ranges::all_of(list, is_number)) fail(key, "numbers");
    std::vector<double> values;
    for (const Json& entry : list)
      values.push_back(entry.is_null() ? std::numeric_limits<double>::quiet_NaN() : entry.get<double>());
    return values;
  }
  std::vector<std::string> texts(const char* key) const {
    const Json& list = need(key);
    const auto is_text = [](const Json& entry) { return entry.is_string(); };
    return get<std::vector<std::string>>(key, list.is_array() && std::ranges::all_of(list, is_text), "strings");
  }
  const Json& json() const { return *json_; }
  const std::string& where() const { return where_; }
  [[noreturn]] void fail(const char* key, const std::string& needed) const {
    throw InputError(fmt::format("{}.{}: {} is not allowed; need {}", where_, key,
                                 shown(need(key).dump(-1, ' ', false, Json::error_handler_t::replace)), needed));
  }

 private:
  const Json& need(const char* key) const {
    const auto entry = json_->find(key);
    if (entry == json_->end()) throw InputError(fmt::format("{}.{}: missing", where_, key));
    return *entry;
  }
  template <typename T>
  T get(const char* key, bool right_type, const std::string& needed) const {
    if (!right_type) fail(key, needed);
    return need(key).get<T>();
  }

  std::string where_;
  const Json* json_;
};

/// Throws InputError unless this program reads that version.
int read_version(const Reader& plan) {
  const int version = plan.integer("schema_version");
  if (version > kSchemaVersion) {
    throw InputError(
        fmt::format("{}.schema_version: {}, written by a newer Prowl; this one reads {} to {}: use that Prowl, or plan "
                    "again with this one",
                    plan.where(), version, kOldestVersion, kSchemaVersion));
  }
  if (version < kOldestVersion) {
    throw InputError(fmt::format(
        "{}.schema_version: {} is no longer supported; need {} to {}: plan again with prowl plan; its task_file "
        "contains the task",
        plan.where(), version, kOldestVersion, kSchemaVersion));
  }
  return version;
}

SolveStatus read_status(const Reader& json) {
  const std::string name = json.text("status");
  std::string known;
  for (int s = 0; s <= static_cast<int>(SolveStatus::solver_failed); ++s) {
    const auto status = static_cast<SolveStatus>(s);
    if (name == to_string(status)) return status;
    known += (s == 0 ? "" : ", ") + std::string(to_string(status));
  }
  json.fail("status", "one of " + known);
}

CertificateGrade read_grade(const Reader& certificate) {
  const std::string name = certificate.text("grade");
  for (const CertificateGrade grade :
       {CertificateGrade::failed, CertificateGrade::draft, CertificateGrade::certified}) {
    if (name == to_string(grade)) return grade;
  }
  certificate.fail("grade", "failed, draft or certified");
}

Certificate read_certificate(const Reader& json, int version) {
  Certificate certificate;
  certificate.passed = json.flag("passed");
  certificate.grade = read_grade(json);
  for (const Reader& check : json.list("checks")) {
    certificate.checks.push_back({.name = check.text("name"),
                                  .worst = check.number("worst"),
                                  .limit = check.number("limit"),
                                  .unit = check.text("unit"),
                                  .time = check.number("time_s"),
                                  .where = check.text("where"),
                                  .passed = check.flag("passed"),
                                  .certified_limit = check.number("certified_limit")});
  }
  for (const Reader& interval : json.list("integration_errors")) {
    certificate.interval_errors.push_back(
        {.start = interval.number("start_s"),
         .end = interval.number("end_s"),
         .error = interval.number("error"),
         .where = interval.text("where"),
         .reintegration = version < 3 ? std::nan("") : interval.number("reintegration")});
  }
  certificate.redundant_contacts = json.texts("redundant_contacts");
  for (const Reader& phase : json.list("contact_ranks")) {
    certificate.contact_ranks.push_back({phase.text("phase"), phase.integer("rows"), phase.integer("rank")});
  }
  return certificate;
}

/// The mesh of the plan: that of the task, unless it was refined or stopped on a coarser one.
Mesh read_mesh(const Reader& plan, const MotionProblem& problem) {
  const std::vector<Reader> phases = plan.object("problem").list("phases");
  if (phases.size() != problem.phases.size()) {
    throw InputError(fmt::format("{}.problem.phases: {} phases; the task has {}", plan.where(), phases.size(),
                                 problem.phases.size()));
  }
  Mesh mesh;
  int left = kMostIntervals;
  for (const Reader& phase : phases) {
    const int intervals = phase.integer("intervals");
    if (intervals < 1 || intervals > left) phase.fail("intervals", fmt::format("1 to {}", left));
    left -= intervals;
    const std::vector<double> shares = phase.numbers("shares");
    if (shares.empty()) {
      mesh.phases.emplace_back(intervals);
      continue;
    }
    const auto is_step = [](double share) { return share > 0.0 && std::isfinite(share); };
    constexpr double kRounding = 1e-9;
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    if (std::ssize(shares) != intervals || !std::ranges::all_of(shares, is_step) || std::abs(sum - 1.0) > kRounding) {
      throw InputError(fmt::format("{}.shares: {} numbers with sum {:.6g}; need {} numbers > 0 with sum 1, or none",
                                   phase.where(), shares.size(), sum, intervals));
    }
    mesh.phases.emplace_back(shares);
  }
  try {
    find_boundary_nodes(problem, mesh);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}.problem.phases: {}", plan.where(), error.what()));
  }
  return mesh;
}

Interpolation read_interpolation(const Reader& problem) {
  const std::string name = problem.text("interpolation");
  for (const Interpolation rule : {Interpolation::trapezoid, Interpolation::hermite}) {
    if (name == to_string(rule)) return rule;
  }
  problem.fail("interpolation",
               fmt::format("{} or {}", to_string(Interpolation::trapezoid), to_string(Interpolation::hermite)));
}

TaskOverrides read_overrides(const Reader& json) {
  TaskOverrides overrides;
  if (json.has("intervals")) overrides.intervals = json.integer("intervals");
  if (json.has("max_iterations")) overrides.max_iterations = json.integer("max_iterations");
  if (json.has("max_time_s")) overrides.max_seconds = json.number("max_time_s");
  if (json.has("tolerance")) overrides.tolerance = json.number("tolerance");
  if (json.has("robust")) overrides.robust = json.flag("robust");
  return overrides;
}

SourceText read_text(const Reader& file) { return {file.text("path"), file.text("text")}; }

SolveResult read_result(const Reader& plan, int version) {
  const Reader solver = plan.object("solver");
  SolveResult result;
  result.status = read_status(plan);
  result.message = solver.text("message");
  result.cost = solver.number("cost");
  result.constraint_violation = solver.number("constraint_violation");
  result.dual_violation = solver.number("dual_violation");
  result.iterations = solver.integer("iterations");
  result.pivoted_stages = version < 4 ? 0 : solver.integer("pivoted_stages");
  result.seconds = solver.number("seconds");
  if (version < 2 && !solver.has("cpu_seconds")) return result;
  result.times.cpu = solver.number("cpu_seconds");
  const Reader evaluation = solver.object("evaluation");
  result.times.values = evaluation.number("values");
  result.times.derivatives = evaluation.number("derivatives");
  result.times.linear_algebra = evaluation.number("linear_algebra");
  if (version >= 6) result.times.guess = evaluation.number("guess");
  return result;
}

std::vector<LevelResult> read_levels(const Reader& solver, int version) {
  std::vector<LevelResult> levels;
  for (const Reader& level : solver.list("levels")) {
    levels.push_back({level.integer("intervals"), read_status(level), level.integer("iterations"),
                      level.number("seconds"),
                      version < 2 && !level.has("cpu_seconds") ? 0.0 : level.number("cpu_seconds")});
  }
  return levels;
}

HessianKind read_hessian(const Reader& solver, int version) {
  if (version < 2 && !solver.has("hessian")) return HessianKind::exact;
  const std::string name = solver.text("hessian");
  for (const HessianKind kind : {HessianKind::exact, HessianKind::gauss_newton}) {
    if (name == to_string(kind)) return kind;
  }
  solver.fail("hessian", fmt::format("{} or {}", to_string(HessianKind::exact), to_string(HessianKind::gauss_newton)));
}

std::vector<MeshIteration> read_convergence(const Reader& solver, int version) {
  if (version < 2 && !solver.has("convergence")) return {};
  const Reader columns = solver.object("convergence");
  const std::vector<double> level = columns.numbers("level"), iteration = columns.numbers("iteration");
  const std::vector<double> cost = columns.numbers("cost"), seconds = columns.numbers("seconds");
  const std::vector<double> primal = columns.numbers("constraint_violation"), dual = columns.numbers("dual_violation");
  std::vector<MeshIteration> iterations;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const auto at = [&](const std::vector<double>& column, const char* key) {
      if (column.size() != level.size()) columns.fail(key, "as many numbers as level");
      return column[i];
    };
    const auto count = [&](const std::vector<double>& column, const char* key) {
      const double value = at(column, key);
      if (!(value >= 0.0 && value <= 1e9)) columns.fail(key, "counts");
      return static_cast<int>(value);
    };
    iterations.push_back({count(level, "level"),
                          {.iteration = count(iteration, "iteration"),
                           .cost = at(cost, "cost"),
                           .constraint_violation = at(primal, "constraint_violation"),
                           .dual_violation = at(dual, "dual_violation"),
                           .elapsed_seconds = at(seconds, "seconds")}});
  }
  return iterations;
}

Json decay_to_json(const PhaseDecay& decay) {
  return {{"phase", decay.name},  {"start_s", decay.start},
          {"end_s", decay.end},   {"directions", decay.directions},
          {"worst", decay.worst}, {"worst_direction", decay.worst_direction},
          {"mean", decay.mean},   {"bandwidth_radps", decay.bandwidth}};
}

/// null without gains.
Json tracking_to_json(const PlanRecord& record) {
  if (!record.feedback) return nullptr;
  const FeedbackDesign& feedback = *record.feedback;
  Json phases = Json::array();
  for (const PhaseDecay& decay : feedback.decay) phases.push_back(decay_to_json(decay));
  return {{"step_s", record.task.tracking.step},
          {"samples", feedback.num_samples()},
          {"seconds", feedback.seconds},
          {"stands_on", feedback.stands_on},
          {"slowest_rate_per_s", feedback.slowest_rate},
          {"fastest_rate_per_s", feedback.fastest_rate},
          {"whole", decay_to_json(feedback.whole)},
          {"phases", phases}};
}

/// null if the plan was not to be robust.
Json robustness_to_json(const std::optional<Robustness>& robustness) {
  if (!robustness) return nullptr;
  Json sizes = Json::object();
  for (const DisturbanceKey& key : kDisturbanceKeys) sizes[key.name] = robustness->sizes.*key.size;
  return {{"share", robustness->share},
          {"solves", robustness->solves},
          {"tightest", robustness->tightest},
          {"sizes", sizes}};
}

std::optional<Robustness> read_robustness(const Reader& plan, int version) {
  if (version < 7 || plan.is_null("robustness")) return std::nullopt;
  const Reader json = plan.object("robustness"), sizes = json.object("sizes");
  Robustness robustness{
      .sizes = {}, .share = json.number("share"), .solves = json.integer("solves"), .tightest = json.text("tightest")};
  for (const DisturbanceKey& key : kDisturbanceKeys)
    robustness.sizes.*key.size = version < key.since ? 0.0 : sizes.number(key.name);
  return robustness;
}

Json reference_to_json(const Task& task) {
  if (!task.reference_file) return nullptr;
  return {{"path", absolute_path(task.reference_file->path)}, {"text", task.reference_file->text}};
}

std::optional<SourceText> read_reference_file(const Reader& plan, int version) {
  if (version < 10 || plan.is_null("reference_file")) return std::nullopt;
  return read_text(plan.object("reference_file"));
}

}  // namespace

nlohmann::ordered_json certificate_to_json(const Certificate& certificate) {
  Json checks = Json::array();
  for (const CertificateCheck& check : certificate.checks) {
    checks.push_back({{"name", check.name},
                      {"worst", check.worst},
                      {"limit", check.limit},
                      {"certified_limit", check.certified_limit},
                      {"unit", check.unit},
                      {"time_s", check.time},
                      {"where", check.where},
                      {"passed", check.passed}});
  }
  Json intervals = Json::array();
  for (const IntervalError& interval : certificate.interval_errors) {
    intervals.push_back({{"start_s", interval.start},
                         {"end_s", interval.end},
                         {"error", interval.error},
                         {"where", interval.where},
                         {"reintegration", interval.reintegration}});
  }
  Json ranks = Json::array();
  for (const ContactRank& rank : certificate.contact_ranks) {
    ranks.push_back({{"phase", rank.phase}, {"rows", rank.rows}, {"rank", rank.rank}});
  }
  return {{"passed", certificate.passed},
          {"grade", to_string(certificate.grade)},
          {"checks", checks},
          {"integration_errors", intervals},
          {"redundant_contacts", certificate.redundant_contacts},
          {"contact_ranks", ranks}};
}

nlohmann::ordered_json plan_to_json(const PlanRecord& record) {
  const Task& task = record.task;
  const RobotDescription& robot = task.problem.robot.description();
  return {{"schema_version", kSchemaVersion},
          {"name", task.problem.name},
          {"status", to_string(record.plan.result.status)},
          {"good", is_good(record.plan)},
          {"finished", record.plan.result.status == SolveStatus::converged},
          {"reasons", record.plan.reasons},
          {"hints", record.plan.hints},
          {"certificate", certificate_to_json(record.plan.certificate)},
          {"solver", solver_to_json(record)},
          {"tracking", tracking_to_json(record)},
          {"robustness", robustness_to_json(record.robustness)},
          {"problem", problem_to_json(record)},
          {"versions", record.versions},
          {"overrides", overrides_to_json(task.overrides)},
          {"task_file", {{"path", absolute_path(task.task_file.path)}, {"text", task.task_file.text}}},
          {"robot_file", {{"path", absolute_path(task.robot_file.path)}, {"text", task.robot_file.text}}},
          {"urdf", {{"path", robot.urdf.string()}, {"text", robot.urdf_text}}},
          {"reference_file", reference_to_json(task)}};
}

PlanRecord plan_from_json(const SourceText& source, const PackageSearch& search, const OwnTerms& own_terms) {
  const Json json = parse_json(source);
  const Reader plan(source.path.string() + ": plan", json);
  const int version = read_version(plan);

  const SourceText urdf = read_text(plan.object("urdf"));
  PlanRecord record{.task = parse_task(read_text(plan.object("task_file")), read_text(plan.object("robot_file")),
                                       search, read_overrides(plan.object("overrides")),
                                       {.urdf = urdf, .reference = read_reference_file(plan, version)}, own_terms),
                    .plan = {},
                    .versions = {},
                    .feedback = {},
                    .iterations = {},
                    .warm_start = {}};
  const RobotDescription& robot = record.task.problem.robot.description();
  if (as_utf8(robot.urdf_text) != urdf.text) {
    throw InputError(
        fmt::format("{}: {} has changed since the plan was made; need the old URDF, or no file there: "
                    "Prowl then uses the copy in plan.json",
                    source.path.string(), robot.urdf.string()));
  }
  record.plan.mesh = version >= 3 ? read_mesh(plan, record.task.problem) : record.task.mesh;
  record.plan.result = read_result(plan, version);
  record.plan.solver = plan.object("solver").text("name");
  record.plan.levels = read_levels(plan.object("solver"), version);
  record.plan.hessian = read_hessian(plan.object("solver"), version);
  record.iterations = read_convergence(plan.object("solver"), version);
  record.warm_start = plan.object("solver").text("warm_start");
  record.plan.certificate = read_certificate(plan.object("certificate"), version);
  record.robustness = read_robustness(plan, version);
  record.plan.reasons = plan.texts("reasons");
  record.plan.hints = plan.texts("hints");
  if (version >= 5) record.plan.trajectory.interpolation = read_interpolation(plan.object("problem"));
  record.plan.num_variables = plan.object("problem").integer("variables");
  record.plan.num_constraints = plan.object("problem").integer("constraints");
  const Reader versions = plan.object("versions");
  for (const auto& entry : versions.json().items()) record.versions[entry.key()] = versions.text(entry.key().c_str());
  return record;
}

}  // namespace prowl
