#include "cli/options/shared_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "cli/process/program_files.hpp"
#include "cli/screen/output.hpp"
#include "prowl/error.hpp"
#include "prowl/simulation/perturbations.hpp"
#include "prowl/task_file/toml/file_keys.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl::cli {
CLI::Validator one_of(const std::vector<std::string>& names) {
  CLI::Validator known = CLI::IsMember(names);
  known.operation([names](std::string& value) {
    if (std::ranges::find(names, value) != names.end()) return std::string();
    return fmt::format("{} not in {{{}}}{}", value, fmt::join(names, ","), did_you_mean(value, names));
  });
  return known;
}

std::vector<Push> read_pushes(const std::vector<double>& numbers, double duration) {
  if (numbers.size() % 4 != 0) {
    throw InputError(
        fmt::format("--push: {} numbers; need four for each: time [s] and impulse in x, y, z [N s]", numbers.size()));
  }
  std::vector<Push> pushes;
  for (std::size_t i = 0; i < numbers.size(); i += 4) {
    const double* const push = &numbers[i];
    pushes.push_back({{push[1], push[2], push[3]}, push[0], duration});
  }
  return pushes;
}

CLI::Option* add_task(CLI::App& verb, std::string& task) {
  return verb.add_option("task", task, "Task file (docs/task-file.md), or a shipped task such as hyq/crouch")
      ->required()
      ->type_name("TASK.toml")
      ->transform(CLI::Validator([](std::string& name) { return name = find_task(name), std::string(); }, ""));
}

void add_plan_directory(CLI::App& verb, std::string& directory) {
  verb.add_option("directory", directory, "Plan folder, written by prowl plan")->required()->type_name("DIR");
}

CLI::Option* add_folder(CLI::App& verb, const std::string& name, std::string& folder, const std::string& meaning) {
  const CLI::Validator is_named(
      [](const std::string& text) { return text.empty() ? std::string("is empty; need a folder") : std::string(); },
      "");
  return verb.add_option(name, folder, meaning)->check(is_named)->type_name("DIR");
}

CLI::Option* add_only(CLI::App& verb, std::vector<std::string>& kinds) {
  const std::vector<std::string> known = perturbation_kinds();
  return verb
      .add_option("--only", kinds,
                  fmt::format("Perturbations to draw, comma-separated: {}; default: all", fmt::join(known, ", ")))
      ->check(one_of(known))
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->take_all();
}

void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders) {
  CLI::Validator is_folder = CLI::ExistingDirectory;
  is_folder.description("");  // DIR is in the help already
  verb.add_option("--package-dir", folders, "Folder with packages for package:// URIs; repeatable")
      ->check(is_folder)
      ->type_name("DIR")
      ->expected(1)
      ->take_all();
}

void add_allow_libraries(CLI::App& verb, bool& allows) {
  verb.add_flag("--allow-libraries", allows, "Run shared libraries of terms that the task file names");
}

void add_json(CLI::App& verb, bool& json) {
  verb.add_flag("--json", json, "Print one JSON object on stdout, also for errors")->group(kOutputOptions);
  verb.add_flag_callback("--quiet", be_quiet, "No progress on stderr; warnings and errors stay")->group(kOutputOptions);
}

void add_solver_limits(CLI::App& verb, TaskOverrides& overrides) {
  const auto add = [&](const char* option, auto& value, const char* name, const char* type) {
    const FileKey& key = file_key(task_file_keys(), "solver", name);
    const std::string unit = key.unit.empty() ? "" : fmt::format(" [{}]", key.unit);
    std::string meaning = fmt::format("{}{}; replaces solver.{}", key.meaning, unit, name);
    meaning.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning.front())));
    verb.add_option(option, value, meaning)->check(number_in(key.range))->type_name(type)->group(kSolverOptions);
  };
  add("--max-time", overrides.max_seconds, "max_time_s", "S");
  add("--max-iterations", overrides.max_iterations, "max_iterations", "N");
  add("--tolerance", overrides.tolerance, "tolerance", "X");
}

CLI::Option* add_intervals(CLI::App& verb, TaskOverrides& overrides) {
  return verb
      .add_option("--intervals", overrides.intervals,
                  "Number of mesh intervals, divided among the phases as in the task file")
      ->check(interval_count())
      ->type_name("N");
}

CLI::Validator interval_count() {
  const NumberRange& range = file_key(task_file_keys(), "phase", "intervals").range;
  return CLI::Range(static_cast<int>(range.lower), static_cast<int>(range.upper));
}

void add_hessian(CLI::App& verb, HessianKind& hessian) {
  const std::string exact = to_string(HessianKind::exact), gauss_newton = to_string(HessianKind::gauss_newton);
  verb.add_option_function<std::string>(
          "--hessian",
          [&hessian, exact](const std::string& name) {
            hessian = name == exact ? HessianKind::exact : HessianKind::gauss_newton;
          },
          "Second derivatives: exact (default), or gauss-newton: of the cost only")
      ->check(one_of({exact, gauss_newton}))
      ->type_name("NAME")
      ->group(kSolverOptions);
}

CLI::Validator number_in(const NumberRange& range) {
  return {[range](const std::string& text) {
            double value = 0.0;
            if (CLI::detail::lexical_cast(text, value) && range.contains(value)) return std::string();
            const bool is_huge = std::isfinite(value) && std::abs(value) > NumberRange::kLargest;
            return fmt::format("{} is not allowed; need a finite number {}{}", text, range.limits(),
                               is_huge ? fmt::format(", of at most {:g} in size", NumberRange::kLargest) : "");
          },
          "NUMBER " + range.limits()};
}

CLI::Validator whole_number(std::uint64_t lower, std::uint64_t upper) {
  return {[=](const std::string& text) {
            std::uint64_t number = 0;
            const char* const end = text.data() + text.size();
            const auto [rest, error] = std::from_chars(text.data(), end, number);
            const bool ok = error == std::errc() && rest == end && number >= lower && number <= upper;
            return ok ? std::string{}
                      : fmt::format("{} is not allowed; need a whole number from {} to {}", text, lower, upper);
          },
          ""};  // N is in the help already
}

CLI::Validator port_number() { return whole_number(0, std::numeric_limits<std::uint16_t>::max()); }

void set_footer(CLI::App& verb, const std::vector<std::string>& examples, const std::string& exit_status) {
  std::string text = "Examples:\n";
  for (const std::string& example : examples) text += "  " + example + "\n";
  verb.footer(text + "\nExit status: " + exit_status);
}

}  // namespace prowl::cli
