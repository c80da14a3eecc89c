#include "alternatives/compare_table.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Rows = std::vector<std::vector<std::string>>;

/// A line that came to an end, with numbers that do not fit few digits.
ComparedRun finished() {
  FormulationRun run{.formulation = {},
                     .solver = "Riccati 1",
                     .nodes = 9,
                     .num_variables = 594,
                     .num_constraints = 540,
                     .jacobian_nonzeros = 12870,
                     .hessian_nonzeros = 13446,
                     .result = {},
                     .motion = {},
                     .certificate = {},
                     .contacts = {1.0 / 3.0 * 1e-3, 1e-300},
                     .inverse_dynamics = {}};
  run.inverse_dynamics = {.worst_torque = 2.0 / 3.0, .worst_base_force = 1e-7 / 3.0, .cost = 1e7 / 3.0};
  run.result.status = SolveStatus::converged;
  run.result.cost = std::numbers::pi * 1e7;
  run.result.iterations = 7;
  run.result.seconds = 0.1 + 0.2;
  run.result.times = {.cpu = 2.0 / 3.0, .values = 0.01, .derivatives = 0.02, .linear_algebra = 0.03};
  run.certificate.grade = CertificateGrade::draft;
  run.certificate.checks = {{.name = "contact drift", .worst = 1.23e-4, .limit = 1e-3, .unit = "m"},
                            {.name = "re-integration", .worst = 4.5e-5, .limit = 5e-4, .unit = "-"},
                            {.name = "friction cone", .worst = 9.0, .limit = 8.0, .unit = "N"}};
  return {.solver = "riccati", .intervals = 8, .nodes = 9, .run = run};
}

ComparedRun refused(const std::string& solver, const std::string& reason) {
  return {.solver = solver, .intervals = 8, .nodes = 9, .run = {}, .reason = reason};
}

CompareRecord record_of(std::vector<ComparedRun> runs, const std::string& task = "stand") {
  const int asked = static_cast<int>(runs.size());
  return {.task = task,
          .robot = "HyQ",
          .options = {},
          .asked = asked,
          .versions = {{"prowl", "0.1.0"}},
          .runs = std::move(runs)};
}

/// By RFC 4180.
Rows read_csv(const std::string& text) {
  Rows rows = {{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted) {
      if (c != '"') {
        rows.back().back() += c;
      } else if (i + 1 < text.size() && text[i + 1] == '"') {
        rows.back().back() += text[++i];
      } else {
        quoted = false;
      }
    } else if (c == '"') {
      quoted = true;
    } else if (c == ',') {
      rows.back().emplace_back();
    } else if (c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  EXPECT_EQ(rows.back(), std::vector<std::string>{""}) << "the last line has no end";
  rows.pop_back();
  return rows;
}

/// Cells of the table, without spaces around them and with escapes undone.
Rows read_markdown(const std::string& text) {
  Rows rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("|")) continue;
    std::vector<std::string> cells = {""};
    for (std::size_t i = 1; i < line.size(); ++i) {
      if (line[i] == '\\') {
        cells.back() += line[++i];
      } else if (line[i] == '|') {
        cells.emplace_back();
      } else {
        cells.back() += line[i];
      }
    }
    EXPECT_EQ(cells.back(), "") << "the line goes on behind its last |: " << line;
    cells.pop_back();
    for (std::string& cell : cells) {
      const std::size_t begin = cell.find_first_not_of(' ');
      cell = begin == std::string::npos ? "" : cell.substr(begin, cell.find_last_not_of(' ') - begin + 1);
    }
    rows.push_back(cells);
  }
  return rows;
}

std::string cell(const Rows& rows, const std::string& column, std::size_t row) {
  const auto found = std::ranges::find(rows.front(), column);
  if (found == rows.front().end()) return "no column " + column;
  return rows.at(row).at(static_cast<std::size_t>(found - rows.front().begin()));
}

TEST(CompareTable, KeepsNumbersAsTheyAre) {
  const CompareRecord record = record_of({finished()});
  const FormulationRun& run = *record.runs[0].run;
  const Rows csv = read_csv(compare_csv(record));
  ASSERT_EQ(csv.size(), 2u);
  const auto number = [&csv](const char* key) { return std::stod(cell(csv, key, 1)); };
  EXPECT_EQ(number("cost"), run.result.cost);
  EXPECT_EQ(number("seconds"), 0.1 + 0.2);
  EXPECT_EQ(number("seconds_per_iteration"), (0.1 + 0.2) / 7);
  EXPECT_EQ(number("cpu_seconds"), 2.0 / 3.0);
  EXPECT_EQ(number("evaluation_seconds"), 0.01 + 0.02);
  EXPECT_EQ(number("node_contact_velocity_m_s"), run.contacts.velocity);
  EXPECT_EQ(cell(csv, "node_contact_acceleration_m_s2", 1), "1e-300");
  EXPECT_EQ(number("task_cost"), 1e7 / 3.0);
  EXPECT_EQ(number("inverse_dynamics_torque_share"), 2.0 / 3.0);
  EXPECT_EQ(number("base_force_share_of_weight"), 1e-7 / 3.0);
  EXPECT_EQ(number("contact_drift_m"), 1.23e-4);
  EXPECT_EQ(number("reintegration_error"), 4.5e-5);
  EXPECT_EQ(number("variables_per_node"), 66.0);
  EXPECT_EQ(number("constraints_per_node"), 60.0);
  EXPECT_EQ(cell(csv, "worst_check", 1), "friction cone");
  EXPECT_EQ(number("worst_check_share_of_limit"), 9.0 / 8.0);
  EXPECT_EQ(cell(csv, "contact_velocity_m_s", 1), "") << "there is no such check";
  EXPECT_EQ(cell(csv, "grade", 1), "draft");
}

// The same columns in the same order, and the same in them.
TEST(CompareTable, SaysTheSameInCsvAndJson) {
  ComparedRun failed = finished();
  failed.run->result.status = SolveStatus::iteration_limit;
  failed.run->result.message = "no end, \"so far\"";
  const CompareRecord record = record_of({finished(), refused("fatrop", "not a chain, of stages"), failed});
  const Rows csv = read_csv(compare_csv(record));
  const auto table = nlohmann::ordered_json::parse(compare_json(record));
  EXPECT_EQ(table.at("schema_version"), 1);
  ASSERT_EQ(table.at("runs").size(), 3u);
  ASSERT_EQ(csv.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) {
    std::size_t column = 0;
    for (const auto& [key, value] : table.at("runs")[i].items()) {
      ASSERT_LT(column, csv[0].size());
      EXPECT_EQ(csv[0][column], key);
      const std::string& text = csv[i + 1].at(column++);
      if (value.is_null()) EXPECT_EQ(text, "") << key;
      if (value.is_string()) EXPECT_EQ(text, value.get<std::string>()) << key;
      if (value.is_number()) EXPECT_EQ(std::stod(text), value.get<double>()) << key;
    }
    EXPECT_EQ(column, csv[i + 1].size());
  }
}

TEST(CompareTable, HasALineForWhatWasNotRun) {
  const std::string reason = "Fatrop takes chains of stages only";
  const CompareRecord record = record_of({finished(), refused("fatrop", reason)});
  const json line = json::parse(compare_json(record)).at("runs")[1];
  EXPECT_EQ(line.at("status"), "not run");
  EXPECT_EQ(line.at("note"), reason);
  EXPECT_EQ(line.at("intervals"), 8);
  for (const char* key : {"variables", "iterations", "cost", "grade", "worst_check", "contact_drift_m"}) {
    EXPECT_TRUE(line.at(key).is_null()) << key;
  }
  const Rows markdown = read_markdown(compare_markdown(record));
  ASSERT_EQ(markdown.size(), 4u);
  EXPECT_EQ(cell(markdown, "solver", 3), "fatrop");
  EXPECT_EQ(cell(markdown, "status", 3), "not run");
  EXPECT_EQ(cell(markdown, "cost", 3), "");
  EXPECT_EQ(cell(markdown, "note", 3), reason);
  EXPECT_EQ(cell(markdown, "note", 2), "");
}

TEST(CompareTable, QuotesTheSolverWhereItDidNotConverge) {
  ComparedRun failed = finished();
  failed.run->result.message = "words";
  EXPECT_EQ(json::parse(compare_json(record_of({failed}))).at("runs")[0].at("note"), nullptr);
  failed.run->result.status = SolveStatus::infeasible;
  EXPECT_EQ(json::parse(compare_json(record_of({failed}))).at("runs")[0].at("note"), "words");
}

TEST(CompareTable, EscapesWhatMeansSomethingToAFormat) {
  const std::string nasty = "a|b, \"c\" \\d *e* `f` <g>\n[h]";
  const CompareRecord record = record_of({finished(), refused("x|y", nasty)}, nasty);
  const Rows csv = read_csv(compare_csv(record));
  ASSERT_EQ(csv.size(), 3u);
  for (const auto& row : csv) EXPECT_EQ(row.size(), csv[0].size());
  EXPECT_EQ(cell(csv, "task", 1), nasty);
  EXPECT_EQ(cell(csv, "note", 2), nasty);
  EXPECT_EQ(json::parse(compare_json(record)).at("name"), nasty);
  const std::string text = compare_markdown(record);
  const Rows markdown = read_markdown(text);
  ASSERT_EQ(markdown.size(), 4u);
  for (const auto& row : markdown) EXPECT_EQ(row.size(), markdown[0].size());
  EXPECT_EQ(cell(markdown, "solver", 3), "x|y");
  EXPECT_EQ(cell(markdown, "note", 3), "a|b, \"c\" \\d *e* `f` &lt;g> [h]");
  EXPECT_THAT(text, AllOf(HasSubstr("task a\\|b"), Not(HasSubstr("<g>"))));
}

TEST(CompareTable, ShowsUnitsThatAreReadable) {
  const Rows markdown = read_markdown(compare_markdown(record_of({finished()})));
  ASSERT_EQ(markdown.size(), 3u);
  EXPECT_EQ(cell(markdown, "drift [mm]", 2), "0.12");
  EXPECT_EQ(cell(markdown, "J v [mm/s]", 2), "0.33");
  EXPECT_EQ(cell(markdown, "per iteration [ms]", 2), "42.9");
  EXPECT_EQ(cell(markdown, "of its limit", 2), "1.12");
  EXPECT_EQ(cell(markdown, "cost", 2), "3.141593e+07");
  EXPECT_EQ(cell(markdown, "contact velocity [mm/s]", 2), "no column contact velocity [mm/s]") << "nothing is in it";
  EXPECT_EQ(cell(markdown, "drift [mm]", 1).back(), ':') << "numbers to the right";
  EXPECT_EQ(cell(markdown, "grade", 1).back(), '-');
}

// Lines are as wide as each other, also where characters have several bytes, but for notes.
TEST(CompareTable, LinesUp) {
  CompareRecord record = record_of({finished(), finished()});
  record.runs[0].solver = "größer";
  std::istringstream lines(compare_markdown(record));
  std::vector<std::size_t> widths;
  for (std::string line; std::getline(lines, line);) {
    const auto characters = std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; });
    if (line.starts_with("|")) widths.push_back(static_cast<std::size_t>(characters));
  }
  ASSERT_EQ(widths.size(), 4u);
  EXPECT_THAT(widths, ElementsAre(widths[0], widths[0], widths[0], widths[0]));
}

TEST(CompareTable, SaysOnceWhatIsTheSame) {
  ComparedRun finer = finished();
  finer.intervals = 16;
  finer.nodes = 17;
  const std::string text = compare_markdown(record_of({finished(), finer}));
  EXPECT_THAT(
      text,
      HasSubstr(
          "task stand, robot HyQ, dynamics inverse, transcription trapezoid, contact stabilised, orientation se3, "
          "solver riccati, version Riccati 1, hessian exact, guess smooth; tolerance 1e-06, at most 300 iterations and "
          "300 s each."));
  const Rows markdown = read_markdown(text);
  EXPECT_EQ(cell(markdown, "intervals", 2), "8");
  EXPECT_EQ(cell(markdown, "intervals", 3), "16");
  EXPECT_EQ(cell(markdown, "nodes", 3), "17");
  EXPECT_EQ(cell(markdown, "solver", 2), "no column solver");
}

TEST(CompareTable, SaysWhatIsMissing) {
  CompareRecord record = record_of({finished()});
  EXPECT_EQ(json::parse(compare_json(record)).at("interrupted"), false);
  EXPECT_THAT(compare_markdown(record), Not(HasSubstr("nterrupted")));
  record.asked = 3;
  const json table = json::parse(compare_json(record));
  EXPECT_EQ(table.at("interrupted"), true);
  EXPECT_EQ(table.at("runs_asked"), 3);
  EXPECT_THAT(compare_markdown(record), HasSubstr("Interrupted: 1 of 3 runs were finished."));
}

TEST(CompareTable, KnowsWhatIsNoNumber) {
  ComparedRun broken = finished();
  broken.run->result.cost = std::numeric_limits<double>::quiet_NaN();
  broken.run->result.iterations = 0;
  broken.run->certificate.checks = {
      {.name = "finite numbers, unit quaternions", .worst = std::nan(""), .limit = 1e-6, .unit = "-"}};
  const CompareRecord record = record_of({broken});
  const json line = json::parse(compare_json(record)).at("runs")[0];
  EXPECT_TRUE(line.at("cost").is_null());
  EXPECT_TRUE(line.at("seconds_per_iteration").is_null()) << "no iteration took any time";
  EXPECT_TRUE(line.at("worst_check_share_of_limit").is_null());
  const Rows csv = read_csv(compare_csv(record));
  EXPECT_TRUE(std::isnan(std::stod(cell(csv, "cost", 1))));
  EXPECT_TRUE(std::isinf(std::stod(cell(csv, "worst_check_share_of_limit", 1))));
  EXPECT_EQ(cell(csv, "worst_check", 1), "finite numbers, unit quaternions");
  EXPECT_EQ(cell(csv, "seconds_per_iteration", 1), "");
}

}  // namespace
}  // namespace prowl
