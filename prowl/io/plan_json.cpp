#include "prowl/io/plan_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchemaVersion = 1;

Json problem_to_json(const PlanRecord& record) {
  const MotionProblem& problem = record.task.problem;
  Json phases = Json::array();
  for (const Phase& phase : problem.phases) {
    Json contacts = Json::array();
    for (const PhaseContact& c : phase.contacts) {
      contacts.push_back(problem.robot.contacts()[static_cast<std::size_t>(c.contact)].name);
    }
    phases.push_back({{"name", phase.name},
                      {"duration_s", phase.duration.min},
                      {"intervals", phase.intervals},
                      {"contacts", contacts}});
  }
  return {{"robot", problem.robot.name()},
          {"joints", problem.robot.joint_names()},
          {"phases", phases},
          {"variables", record.plan.num_variables},
          {"constraints", record.plan.num_constraints}};
}

Json solver_to_json(const PlanRecord& record) {
  const SolveResult& result = record.plan.result;
  const SolverOptions& options = record.task.solver;
  return {{"message", result.message},
          {"cost", result.cost},
          {"constraint_violation", result.constraint_violation},
          {"dual_violation", result.dual_violation},
          {"iterations", result.iterations},
          {"seconds", result.seconds},
          {"evaluation_seconds", result.evaluation_seconds},
          {"tolerance", options.tolerance},
          {"max_iterations", options.max_iterations},
          {"max_time_s", options.max_seconds}};
}

Json overrides_to_json(const TaskOverrides& overrides) {
  Json json = Json::object();
  if (overrides.intervals) json["intervals"] = *overrides.intervals;
  if (overrides.max_iterations) json["max_iterations"] = *overrides.max_iterations;
  if (overrides.max_seconds) json["max_time_s"] = *overrides.max_seconds;
  return json;
}

std::string absolute_path(const std::filesystem::path& path) {
  return std::filesystem::absolute(path).lexically_normal().string();
}

/// One object of plan.json; every access names the key that is missing or of the wrong type.
class Reader {
 public:
  Reader(std::string where, const Json& json) : where_(std::move(where)), json_(&json) {
    if (!json.is_object()) throw InputError(where_ + ": need an object");
  }

  Reader object(const char* key) const { return {where_ + "." + key, need(key)}; }
  bool has(const char* key) const { return json_->contains(key); }
  std::string text(const char* key) const { return get<std::string>(key, need(key).is_string(), "a string"); }
  int integer(const char* key) const { return get<int>(key, need(key).is_number_integer(), "an integer"); }
  bool flag(const char* key) const { return get<bool>(key, need(key).is_boolean(), "true or false"); }
  /// null stands for NaN and the infinities, which JSON does not have.
  double number(const char* key) const {
    if (need(key).is_null()) return std::numeric_limits<double>::quiet_NaN();
    return get<double>(key, need(key).is_number(), "a number");
  }
  std::vector<Reader> list(const char* key) const {
    if (!need(key).is_array()) fail(key, "a list");
    std::vector<Reader> entries;
    for (const Json& entry : need(key)) entries.emplace_back(fmt::format("{}.{}[{}]", where_, key, entries.size()), entry);
    return entries;
  }
  std::vector<std::string> texts(const char* key) const {
    const Json& list = need(key);
    const auto is_text = [](const Json& entry) { return entry.is_string(); };
    return get<std::vector<std::string>>(key, list.is_array() && std::ranges::all_of(list, is_text), "strings");
  }
  const Json& json() const { return *json_; }
  [[noreturn]] void fail(const char* key, const std::string& needed) const {
    throw InputError(fmt::format("{}.{}: {} is not allowed; need {}", where_, key, need(key).dump(), needed));
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

SolveStatus read_status(const Reader& plan) {
  const std::string name = plan.text("status");
  std::string known;
  for (int s = 0; s <= static_cast<int>(SolveStatus::solver_failed); ++s) {
    const auto status = static_cast<SolveStatus>(s);
    if (name == to_string(status)) return status;
    known += (s == 0 ? "" : ", ") + std::string(to_string(status));
  }
  plan.fail("status", "one of " + known);
}

Grade read_grade(const Reader& certificate) {
  const std::string name = certificate.text("grade");
  for (const Grade grade : {Grade::failed, Grade::draft, Grade::certified}) {
    if (name == to_string(grade)) return grade;
  }
  certificate.fail("grade", "failed, draft or certified");
}

Certificate read_certificate(const Reader& json) {
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
    certificate.interval_errors.push_back({.start = interval.number("start_s"),
                                           .end = interval.number("end_s"),
                                           .error = interval.number("error"),
                                           .where = interval.text("where")});
  }
  certificate.redundant_contacts = json.texts("redundant_contacts");
  return certificate;
}

TaskOverrides read_overrides(const Reader& json) {
  TaskOverrides overrides;
  if (json.has("intervals")) overrides.intervals = json.integer("intervals");
  if (json.has("max_iterations")) overrides.max_iterations = json.integer("max_iterations");
  if (json.has("max_time_s")) overrides.max_seconds = json.number("max_time_s");
  return overrides;
}

SolveResult read_result(const Reader& plan) {
  const Reader solver = plan.object("solver");
  SolveResult result;
  result.status = read_status(plan);
  result.message = solver.text("message");
  result.cost = solver.number("cost");
  result.constraint_violation = solver.number("constraint_violation");
  result.dual_violation = solver.number("dual_violation");
  result.iterations = solver.integer("iterations");
  result.seconds = solver.number("seconds");
  result.evaluation_seconds = solver.number("evaluation_seconds");
  return result;
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
                         {"where", interval.where}});
  }
  return {{"passed", certificate.passed},
          {"grade", to_string(certificate.grade)},
          {"checks", checks},
          {"integration_errors", intervals},
          {"redundant_contacts", certificate.redundant_contacts}};
}

nlohmann::ordered_json plan_to_json(const PlanRecord& record) {
  const Task& task = record.task;
  return {{"schema_version", kSchemaVersion},
          {"name", task.problem.name},
          {"status", to_string(record.plan.result.status)},
          {"finished", record.plan.result.status == SolveStatus::converged},
          {"certificate", certificate_to_json(record.plan.certificate)},
          {"solver", solver_to_json(record)},
          {"problem", problem_to_json(record)},
          {"versions", record.versions},
          {"overrides", overrides_to_json(task.overrides)},
          {"task_file", {{"path", absolute_path(task.task_file.path)}, {"text", task.task_file.text}}},
          {"robot_file", {{"path", absolute_path(task.robot_file.path)}, {"text", task.robot_file.text}}}};
}

PlanRecord plan_from_json(const SourceText& source, const PackageSearch& search) {
  Json json;
  try {
    json = Json::parse(source.text);
  } catch (const nlohmann::json::parse_error& error) {
    throw InputError(fmt::format("{}: {}", source.path.string(), error.what()));
  }
  const Reader plan(source.path.string() + ": plan", json);
  if (plan.integer("schema_version") != kSchemaVersion) plan.fail("schema_version", std::to_string(kSchemaVersion));

  const Reader task = plan.object("task_file");
  const Reader robot = plan.object("robot_file");
  PlanRecord record{.task = parse_task({task.text("path"), task.text("text")}, {robot.text("path"), robot.text("text")},
                                       search, read_overrides(plan.object("overrides"))),
                    .plan = {},
                    .versions = {}};
  record.plan.result = read_result(plan);
  record.plan.certificate = read_certificate(plan.object("certificate"));
  record.plan.num_variables = plan.object("problem").integer("variables");
  record.plan.num_constraints = plan.object("problem").integer("constraints");
  const Reader versions = plan.object("versions");
  for (const auto& entry : versions.json().items()) record.versions[entry.key()] = versions.text(entry.key().c_str());
  return record;
}

}  // namespace prowl
