#include "cli/verbs/python_verb.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/process/process.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "prowl/error.hpp"
#include "prowl/files/json_text.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kSignalled = 128;  ///< plus the signal number: exit status of a terminated process

/// Options of the command only, unknown to the package.
bool is_own(const std::string& option) { return option == "json" || option == "quiet" || option == "python"; }

/// Given options as "--name=value", positional arguments last.
std::vector<std::string> given_options(const CLI::App& verb) {
  std::vector<std::string> options, arguments = {"--"};
  for (const CLI::Option* option : verb.get_options()) {
    const bool is_flag = option->get_expected_max() == 0;
    for (const std::string& value : option->results()) {
      if (option->get_lnames().empty()) {
        arguments.push_back(value);
      } else if (const std::string& name = option->get_lnames().front(); !is_own(name)) {
        options.push_back("--" + name + (is_flag ? "" : "=" + value));
      }
    }
  }
  options.insert(options.end(), arguments.begin(), arguments.end());
  return options;
}

[[noreturn]] void raise(const std::string& kind, const std::string& message) {
  if (kind == "input") throw InputError(message);
  if (kind == "files") throw FileError(message);
  if (kind == "numerical") throw NumericalError(message);
  throw Error(message);
}

/// Handles the lines printed by _verb.py.
class Listener {
 public:
  explicit Listener(bool json) : json_(json) {}

  void operator()(const std::string& line) {
    Json said = Json::parse(line, nullptr, false);
    if (!said.is_object()) {  // printed by a library
      print_message(line + "\n");
    } else if (said.contains("message")) {
      print_message(said["message"].get<std::string>() + "\n");
    } else if (said.contains("progress")) {
      const Json& progress = said["progress"];
      if (!bar_) bar_.emplace(progress[2].get<std::string>(), progress[1].get<int>());
      bar_->show(progress[0].get<int>(), progress.size() > 3 ? progress[3].get<std::string>() : "");
    } else if (said.contains("note")) {
      print_progress(said["note"].get<std::string>() + "\n");
    } else if (said.contains("event")) {
      if (json_) print_bytes(said.dump() + "\n");
    } else {
      last_ = std::move(said);
    }
  }
  /// Error or result; null without one.
  const Json& last() const { return last_; }

 private:
  bool json_;
  std::optional<ProgressBar> bar_;
  Json last_;
};

}  // namespace

std::string default_python() {
  const char* const python = std::getenv("PROWL_PYTHON");
  return python ? python : PROWL_PYTHON;
}

fs::path python_package() {
  const fs::path prefix = program_path().parent_path().parent_path();
  std::error_code ignored;
  for (const fs::path& package : {prefix / "python/prowl", share_folder() / "python/prowl"}) {
    if (fs::exists(package / "_verb.py", ignored)) return package;
  }
  return prefix;  // site-packages/prowl/bin/prowl
}

void add_python(CLI::App& verb, std::string& python, const std::string& libraries) {
  verb.add_option("--python", python, fmt::format("Python with {}; default {}", libraries, python))->type_name("PATH");
}

int run_python_verb(const CLI::App& verb, const PythonVerb& arguments) {
  const fs::path script = python_package() / "_verb.py";
  std::error_code ignored;
  if (!fs::exists(script, ignored)) {
    throw FileError(fmt::format("{}: missing; prowl {} needs the Python package, which scripts/setup builds",
                                script.string(), verb.get_name()));
  }
  std::vector<std::string> command = {arguments.python, "-B", script.string(), verb.get_name()};
  for (const std::string& option : given_options(verb)) command.push_back(option);
  Listener listener(arguments.json);
  const int status = run_program(command, [&listener](const std::string& line) { listener(line); });
  if (status > kSignalled) {
    print_message(fmt::format("prowl: {} was terminated by signal {}\n", arguments.python, status - kSignalled));
    return status;
  }
  const Json& said = listener.last();
  if (said.contains("error")) raise(said["kind"], said["error"]);
  if (status != 0 || !said.contains("result")) {
    throw Error(fmt::format("{} {} failed with status {}", arguments.python, script.string(), status));
  }
  const int exit_status = said["result"].value("exit_status", 0);
  if (arguments.json) {
    Json result = {{"verb", verb.get_name()}, {"exit_status", exit_status}};
    result.update(said["result"]);
    print_bytes(json_text(result));
  } else {
    print_result(said["text"]);
  }
  return exit_status;
}

}  // namespace prowl::cli
