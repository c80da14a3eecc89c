#include "cli/options/shared_options.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "cli/screen/output.hpp"
#include "prowl/task_file/toml/file_keys.hpp"

namespace prowl::cli {
namespace {

CLI::Validator finite_number(const std::string& range, const std::function<bool(double)>& is_in_range) {
  return {[range, is_in_range](const std::string& text) {
            double value = 0.0;
            const bool ok = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && is_in_range(value);
            return ok ? std::string{} : fmt::format("{} is not allowed; need a finite number {}", text, range);
          },
          "NUMBER " + range};
}

}  // namespace

void add_plan_directory(CLI::App& verb, std::string& directory) {
  verb.add_option("directory", directory, "Folder that prowl plan wrote")->required()->type_name("DIR");
}

CLI::Option* add_folder(CLI::App& verb, const std::string& name, std::string& folder, const std::string& meaning) {
  const CLI::Validator is_named(
      [](const std::string& text) { return text.empty() ? std::string("is empty; need a folder") : std::string(); },
      "");
  return verb.add_option(name, folder, meaning)->check(is_named)->type_name("DIR");
}

void add_package_dirs(CLI::App& verb, std::vector<std::string>& folders) {
  CLI::Validator is_folder = CLI::ExistingDirectory;
  is_folder.description("");  // the help says DIR already
  verb.add_option("--package-dir", folders, "Folder that contains packages of package:// URIs; may be given again")
      ->check(is_folder)
      ->type_name("DIR")
      ->expected(1)
      ->take_all();
}

void add_json(CLI::App& verb, bool& json) {
  verb.add_flag("--json", json, "Print one JSON object on stdout, for errors too")->group(kOutputOptions);
  verb.add_flag_callback("--quiet", be_quiet, "No progress on stderr; warnings and errors stay")->group(kOutputOptions);
}

void add_solver_limits(CLI::App& verb, TaskOverrides& overrides) {
  const FileKeys& keys = task_file_keys();
  verb.add_option("--max-time", overrides.max_seconds,
                  "Limit: " + key_meaning(keys, "solver", "max_time_s") + " [s]; instead of solver.max_time_s")
      ->check(positive_number())
      ->type_name("S")
      ->group(kSolverOptions);
  verb.add_option("--max-iterations", overrides.max_iterations,
                  "Limit: " + key_meaning(keys, "solver", "max_iterations") + "; instead of solver.max_iterations")
      ->check(CLI::Range(1, std::numeric_limits<int>::max()))
      ->type_name("N")
      ->group(kSolverOptions);
  verb.add_option("--tolerance", overrides.tolerance,
                  "Tolerance " + key_meaning(keys, "solver", "tolerance") + "; instead of solver.tolerance")
      ->check(number_between(1e-12, 1e-2))
      ->type_name("X")
      ->group(kSolverOptions);
}

void add_hessian(CLI::App& verb, HessianKind& hessian) {
  const std::string exact = to_string(HessianKind::exact), gauss_newton = to_string(HessianKind::gauss_newton);
  verb.add_option_function<std::string>(
          "--hessian",
          [&hessian, exact](const std::string& name) {
            hessian = name == exact ? HessianKind::exact : HessianKind::gauss_newton;
          },
          "Second derivatives: exact (default), or gauss-newton, which takes those of the cost alone")
      ->check(CLI::IsMember({exact, gauss_newton}))
      ->type_name("NAME")
      ->group(kSolverOptions);
}

CLI::Validator positive_number() {
  return finite_number("> 0", [](double value) { return value > 0.0; });
}
CLI::Validator nonnegative_number() {
  return finite_number(">= 0", [](double value) { return value >= 0.0; });
}

CLI::Validator number_between(double lower, double upper) {
  return finite_number(fmt::format("from {} to {}", lower, upper),
                       [lower, upper](double value) { return value >= lower && value <= upper; });
}

CLI::Validator whole_number() {
  return {[](const std::string& text) {
            std::uint64_t number = 0;
            const char* const end = text.data() + text.size();
            const auto [rest, error] = std::from_chars(text.data(), end, number);
            const bool ok = error == std::errc() && rest == end;
            return ok ? std::string{}
                      : fmt::format("{} is not allowed; need a whole number from 0 to {}", text,
                                    std::numeric_limits<std::uint64_t>::max());
          },
          ""};  // the help says N already
}

void set_footer(CLI::App& verb, const std::vector<std::string>& examples, const std::string& exit_status) {
  std::string text = "Examples:\n";
  for (const std::string& example : examples) text += "  " + example + "\n";
  verb.footer(text + "\nExit status: " + exit_status);
}

}  // namespace prowl::cli
