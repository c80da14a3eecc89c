#include "alternatives/compare_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <variant>

#include "prowl/files/json_text.hpp"

namespace prowl {
namespace {

/// Empty, a name, a count or a quantity.
using Cell = std::variant<std::monostate, std::string, int, double>;
using Value = std::function<Cell(const CompareRecord&, const ComparedRun&)>;

struct Column {
  enum class Kind { choice, figure };
  std::string key;      ///< in CSV and JSON, with its SI unit
  std::string heading;  ///< in Markdown, with its unit; "": not in Markdown
  Value value;
  std::string format = "{:.3g}";  ///< of a quantity in Markdown
  double scale = 1.0;             ///< converts the unit of the key to that of the heading
  Kind kind = Kind::figure;
};

Value of_run(Cell (*value)(const FormulationRun&)) {
  return [value](const CompareRecord&, const ComparedRun& line) { return line.run ? value(*line.run) : Cell{}; };
}

Value of_check(const char* name) {
  return [name](const CompareRecord&, const ComparedRun& line) {
    const CertificateCheck* const check = line.run ? line.run->certificate.find(name) : nullptr;
    return check ? Cell{check->worst} : Cell{};
  };
}

Value of_worst(Cell (*value)(const CertificateCheck&)) {
  return [value](const CompareRecord&, const ComparedRun& line) {
    const CertificateCheck* const check = line.run ? line.run->worst_check() : nullptr;
    return check ? value(*check) : Cell{};
  };
}

/// Not every solver counts them.
Cell iterations(const FormulationRun& run) { return run.result.iterations > 0 ? Cell{run.result.iterations} : Cell{}; }

Cell seconds_per_iteration(const FormulationRun& run) {
  return run.result.iterations > 0 ? Cell{run.seconds_per_iteration()} : Cell{};
}

Cell status(const CompareRecord&, const ComparedRun& line) {
  return line.run ? to_string(line.run->result.status) : "not run";
}

Cell note(const CompareRecord&, const ComparedRun& line) {
  if (!line.run) return line.reason;
  return line.run->result.status == SolveStatus::converged ? Cell{} : Cell{line.run->result.message};
}

std::vector<Column> choices() {
  std::vector<Column> columns;
  const auto add = [&columns](const char* key, Cell (*value)(const CompareRecord&, const ComparedRun&)) {
    columns.push_back({.key = key, .heading = key, .value = value, .kind = Column::Kind::choice});
  };
  add("task", [](const CompareRecord& record, const ComparedRun&) -> Cell { return record.task; });
  add("robot", [](const CompareRecord& record, const ComparedRun&) -> Cell { return record.robot; });
  add("intervals", [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.intervals; });
  add("nodes", [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.nodes; });
  add("dynamics", [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.formulation.dynamics; });
  add("transcription",
      [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.formulation.transcription; });
  add("contact", [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.formulation.contact; });
  add("orientation",
      [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.formulation.orientation; });
  add("solver", [](const CompareRecord&, const ComparedRun& line) -> Cell { return line.solver; });
  columns.push_back({.key = "solver_version",
                     .heading = "version",
                     .value = of_run([](const FormulationRun& run) -> Cell {
                       return run.solver.empty() ? Cell{} : Cell{run.solver};
                     }),
                     .kind = Column::Kind::choice});
  add("hessian", [](const CompareRecord& record, const ComparedRun&) -> Cell { return to_string(record.hessian); });
  add("guess", [](const CompareRecord& record, const ComparedRun&) -> Cell { return record.guess; });
  return columns;
}

/// Sizes of the program and effort of the solver.
std::vector<Column> effort() {
  using Run = FormulationRun;
  return {
      {"variables", "variables", of_run([](const Run& run) -> Cell { return run.num_variables; })},
      {"variables_per_node", "per node", of_run([](const Run& run) -> Cell { return run.variables_per_node(); }),
       "{:.1f}"},
      {"constraints", "constraints", of_run([](const Run& run) -> Cell { return run.num_constraints; })},
      {"constraints_per_node", "per node", of_run([](const Run& run) -> Cell { return run.constraints_per_node(); }),
       "{:.1f}"},
      {"jacobian_nonzeros", "Jacobian non-zeros", of_run([](const Run& run) -> Cell { return run.jacobian_nonzeros; })},
      {"hessian_nonzeros", "Hessian non-zeros", of_run([](const Run& run) -> Cell { return run.hessian_nonzeros; })},
      {"status", "status", status},
      {"iterations", "iterations", of_run(iterations)},
      {"seconds", "time [s]", of_run([](const Run& run) -> Cell { return run.result.seconds; })},
      {"seconds_per_iteration", "per iteration [ms]", of_run(seconds_per_iteration), "{:.3g}", 1e3},
      {"cpu_seconds", "CPU [s]", of_run([](const Run& run) -> Cell { return run.result.times.cpu; })},
      {"evaluation_seconds", "evaluation [s]",
       of_run([](const Run& run) -> Cell { return run.result.times.evaluation(); })},
      {"linear_algebra_seconds", "", of_run([](const Run& run) -> Cell { return run.result.times.linear_algebra; })},
  };
}

/// Quality of the motion.
std::vector<Column> outcome() {
  using Run = FormulationRun;
  using Check = CertificateCheck;
  return {
      {"cost", "cost", of_run([](const Run& run) -> Cell { return run.result.cost; }), "{:.7g}"},
      {"constraint_violation", "", of_run([](const Run& run) -> Cell { return run.result.constraint_violation; })},
      {"dual_violation", "", of_run([](const Run& run) -> Cell { return run.result.dual_violation; })},
      {"grade", "grade", of_run([](const Run& run) -> Cell { return to_string(run.certificate.grade); })},
      {"worst_check", "worst check", of_worst([](const Check& check) -> Cell { return check.name; })},
      {"worst_check_share_of_limit", "of its limit",
       of_worst([](const Check& check) -> Cell { return share_of_limit(check); })},
      {"worst_check_worst", "", of_worst([](const Check& check) -> Cell { return check.worst; })},
      {"worst_check_limit", "", of_worst([](const Check& check) -> Cell { return check.limit; })},
      {"worst_check_unit", "", of_worst([](const Check& check) -> Cell { return check.unit; })},
      {"reintegration_error", "re-integration [-]", of_check("re-integration"), "{:.2g}"},
      {"contact_drift_m", "drift [mm]", of_check("contact drift"), "{:.2g}", 1e3},
      {"contact_velocity_m_s", "contact velocity [mm/s]", of_check("contact velocity"), "{:.2g}", 1e3},
      {"node_contact_velocity_m_s", "J v [mm/s]", of_run([](const Run& run) -> Cell { return run.contacts.velocity; }),
       "{:.2g}", 1e3},
      {"node_contact_acceleration_m_s2", "d(J v)/dt [mm/s²]",
       of_run([](const Run& run) -> Cell { return run.contacts.acceleration; }), "{:.2g}", 1e3},
      {"task_cost", "cost of the task", of_run([](const Run& run) -> Cell { return run.inverse_dynamics.cost; }),
       "{:.7g}"},
      {"inverse_dynamics_torque_share", "torque [of limit]",
       of_run([](const Run& run) -> Cell { return run.inverse_dynamics.worst_torque; })},
      {"base_force_share_of_weight", "residual on the base [weight]",
       of_run([](const Run& run) -> Cell { return run.inverse_dynamics.worst_base_force; }), "{:.2g}"},
      {"note", "note", note},
  };
}

const std::vector<Column>& columns() {
  static const std::vector<Column> all = [] {
    std::vector<Column> columns;
    for (const auto& group : {choices(), effort(), outcome()})
      columns.insert(columns.end(), group.begin(), group.end());
    return columns;
  }();
  return all;
}

/// Quoted if necessary (RFC 4180).
std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted;
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return '"' + quoted + '"';
}

/// One line, with Markdown and HTML escaped.
std::string markdown_text(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '<') {
      escaped += "&lt;";
      continue;
    }
    if (std::string_view("\\|`*[").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c == '\n' || c == '\r' ? ' ' : c;
  }
  return escaped;
}

struct CsvText {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::string& text) const { return csv_text(text); }
  std::string operator()(auto number) const { return fmt::format("{}", number); }
};

struct MarkdownText {
  const Column& column;
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::string& text) const { return markdown_text(text); }
  std::string operator()(int number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const {
    return fmt::format(fmt::runtime(column.format), number * column.scale);
  }
};

struct JsonValue {
  nlohmann::ordered_json operator()(std::monostate) const { return nullptr; }
  nlohmann::ordered_json operator()(const auto& value) const { return value; }
};

bool is_text(const CompareRecord& record, const Column& column) {
  return std::ranges::any_of(record.runs, [&](const ComparedRun& line) {
    return std::holds_alternative<std::string>(column.value(record, line));
  });
}

bool is_empty(const CompareRecord& record, const Column& column) {
  return std::ranges::all_of(record.runs,
                             [&](const ComparedRun& line) { return column.value(record, line) == Cell{}; });
}

bool is_the_same_in_all(const CompareRecord& record, const Column& column) {
  return std::ranges::all_of(record.runs, [&](const ComparedRun& line) {
    return column.value(record, line) == column.value(record, record.runs.front());
  });
}

/// Number of UTF-8 characters.
std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count_if(text, [](unsigned char c) { return (c & 0xC0) != 0x80; }));
}

std::string padded(const std::string& text, std::size_t columns, bool to_the_left) {
  const std::string space(columns - std::min(columns, width(text)), ' ');
  return to_the_left ? text + space : space + text;
}

/// True if the column is in the Markdown table; choices common to all lines are listed above it.
bool is_shown(const CompareRecord& record, const Column& column) {
  if (column.heading.empty() || is_empty(record, column)) return false;
  return column.kind != Column::Kind::choice || !is_the_same_in_all(record, column);
}

/// One column with heading and rule, padded to equal width, except for notes, which may be long.
std::vector<std::string> markdown_column(const CompareRecord& record, const Column& column) {
  std::vector<std::string> cells = {column.heading};
  for (const ComparedRun& line : record.runs)
    cells.push_back(std::visit(MarkdownText{column}, column.value(record, line)));
  const bool left = is_text(record, column);
  std::size_t widest = 3;  // of "--:"
  for (const std::string& cell : cells) widest = std::max(widest, width(cell));
  if (column.key == "note") widest = width(column.heading);
  for (std::string& cell : cells) cell = padded(cell, widest, left);
  cells.insert(cells.begin() + 1, left ? std::string(widest, '-') : std::string(widest - 1, '-') + ":");
  return cells;
}

std::string markdown_heading(const CompareRecord& record) {
  std::vector<std::string> same;
  for (const Column& column : columns()) {
    if (column.kind != Column::Kind::choice || !is_the_same_in_all(record, column)) continue;
    const std::string value = std::visit(MarkdownText{column}, column.value(record, record.runs.front()));
    same.push_back(column.heading + " " + value);
  }
  const SolverOptions& options = record.options;
  std::string text = fmt::format("In all lines: {}; tolerance {:g}, at most {} iterations and {:g} s each.\n",
                                 fmt::join(same, ", "), options.tolerance, options.max_iterations, options.max_seconds);
  if (!record.interrupted()) return text;
  return text + fmt::format("\nInterrupted: {} of {} runs were finished.\n", record.runs.size(), record.asked);
}

}  // namespace

std::string compare_markdown(const CompareRecord& record) {
  if (record.runs.empty()) return "Nothing was run.\n";
  std::vector<std::string> lines(record.runs.size() + 2, "|");
  for (const Column& column : columns()) {
    if (!is_shown(record, column)) continue;
    const std::vector<std::string> cells = markdown_column(record, column);
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] += " " + cells[i] + " |";
  }
  return fmt::format("{}\n{}\n", markdown_heading(record), fmt::join(lines, "\n"));
}

std::string compare_csv(const CompareRecord& record) {
  std::vector<std::string> cells;
  for (const Column& column : columns()) cells.push_back(column.key);
  std::string text = fmt::format("{}\n", fmt::join(cells, ","));
  for (const ComparedRun& line : record.runs) {
    cells.clear();
    for (const Column& column : columns()) cells.push_back(std::visit(CsvText{}, column.value(record, line)));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return text;
}

std::string compare_json(const CompareRecord& record) {
  using Json = nlohmann::ordered_json;
  Json json = {{"schema_version", 1},
               {"name", record.task},
               {"robot", record.robot},
               {"hessian", to_string(record.hessian)},
               {"guess", record.guess},
               {"tolerance", record.options.tolerance},
               {"max_iterations", record.options.max_iterations},
               {"max_time_s", record.options.max_seconds},
               {"interrupted", record.interrupted()},
               {"runs_asked", record.asked},
               {"runs", Json::array()},
               {"versions", record.versions}};
  for (const ComparedRun& line : record.runs) {
    Json run = Json::object();
    for (const Column& column : columns()) run[column.key] = std::visit(JsonValue{}, column.value(record, line));
    json["runs"].push_back(std::move(run));
  }
  return json_text(json);
}

}  // namespace prowl
