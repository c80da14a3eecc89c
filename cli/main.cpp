#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

#include "cli/process/exit_status.hpp"
#include "cli/screen/help_format.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/error.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/text/nearest_name.hpp"

namespace {

using namespace prowl::cli;

std::string version_text() {
  std::string text;
  for (const auto& [name, version] : prowl::all_versions()) {
    const std::string line = fmt::format("{} {}", name, version);
    text = name == "prowl" ? fmt::format("{}{}{}", line, text.empty() ? "" : "\n", text)
                           : fmt::format("{}{}{}", text, text.empty() ? "" : "\n", line);
  }
  return text;
}

/// "plan " if that is the first argument and a verb, else "".
std::string first_verb(const CLI::App& app, int argc, const char* const* argv) {
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (argc > 1 && verb->get_name() == argv[1]) return verb->get_name() + " ";
  }
  return "";
}

/// "; did you mean '--json'?" for the first unknown verb or option, else "".
std::string suggestion(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back(verb->get_name());
  if (argc < 2) return "";
  const std::string first = argv[1];
  const bool is_verb = std::find(verbs.begin(), verbs.end(), first) != verbs.end();
  if (!is_verb && !first.starts_with('-')) return prowl::did_you_mean(first, verbs);
  std::vector<std::string> options;
  const CLI::App* verb = is_verb ? app.get_subcommand(first) : &app;
  if (is_verb && argc > 2) {  // a verb may have subverbs
    for (const CLI::App* below : verb->get_subcommands([&](const CLI::App* any) { return any->get_name() == argv[2]; }))
      verb = below;
  }
  for (const CLI::Option* option : verb->get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  for (int i = 1; i < argc; ++i) {
    const std::string argument(argv[i], std::find(argv[i], argv[i] + std::string_view(argv[i]).size(), '='));
    if (!argument.starts_with("--")) continue;
    if (std::find(options.begin(), options.end(), argument) == options.end())
      return prowl::did_you_mean(argument, options);
  }
  return "";
}

/// The first unexpected argument (CLI11 lists all, last first, with option values); "" without one.
std::string unexpected(const CLI::App& app, bool lacks_a_verb) {
  const std::vector<std::string> remaining = app.remaining(true);
  if (remaining.empty()) return "";
  const std::string& first = remaining.front();
  if (first.starts_with('-') && first.size() > 1) return "unknown option " + first.substr(0, first.find('='));
  return (lacks_a_verb ? "unknown command '" : "unexpected argument '") + first + "'";
}

/// Message for a missing verb or subverb.
std::string missing_verb(const CLI::App& app, int argc, const char* const* argv) {
  const CLI::App* verb = &app;
  for (int i = 1; i < argc; ++i) {
    for (const CLI::App* below : verb->get_subcommands([&](const CLI::App* any) { return any->get_name() == argv[i]; }))
      verb = below;
  }
  std::string names;
  for (const CLI::App* below : verb->get_subcommands([](const CLI::App*) { return true; }))
    names += (names.empty() ? "" : ", ") + below->get_name();
  return "a command is missing; need one of: " + names;
}

std::string parse_message(const CLI::App& app, const CLI::ParseError& error, int argc, const char* const* argv) {
  const bool lacks_a_verb = std::string_view(error.what()) == "A subcommand is required";
  std::string message = error.what();
  if (lacks_a_verb || dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const std::string other = unexpected(app, lacks_a_verb);
    message = !other.empty() ? other : lacks_a_verb ? missing_verb(app, argc, argv) : message;
  }
  return message + suggestion(app, argc, argv);
}

/// The verb of a command line, or "" if it names none.
std::string verb_of(int argc, const char* const* argv) { return argc > 1 && argv[1][0] != '-' ? argv[1] : ""; }

/// Shortens very long messages in the middle: names come first, the remedy last.
std::string readable(const std::string& message) {
  constexpr std::size_t kFirst = 2000, kLast = 1000;  // bytes; a screen of 80 columns shows 2000
  if (message.size() <= kFirst + kLast) return message;
  return fmt::format("{} ... {}", message.substr(0, kFirst), message.substr(message.size() - kLast));
}

/// To stderr and, with --json, to stdout as well.
int report_error(int argc, const char* const* argv, const std::string& text, int status, const std::string& hint = "") {
  const std::string message = readable(text);
  print_message(fmt::format("prowl: {}{}\n", message, hint));
  if (asks_for_json(argc, argv)) print_json_error(verb_of(argc, argv), status, message);
  return status;
}

int run(int argc, char** argv) {
  int status = kPassed;
  CLI::App app("Prowl plans whole-body motions of legged robots and checks them.", "prowl");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n  prowl robot robots/hyq.toml            show a robot as Prowl reads it\n"
      "  prowl plan tasks/hyq/crouch.toml       plan a motion into out/hyq_crouch\n"
      "  prowl report out/hyq_crouch            replay it in a browser\n"
      "  prowl simulate out/hyq_crouch          run it in MuJoCo\n"
      "  prowl diagnose tasks/hyq/crouch.toml   find out why there is no plan\n"
      "  prowl new robot URDF                   start with your own robot\n"
      "  prowl doctor                           check this machine\n\n"
      "For help: prowl VERB --help");
  add_plan_command(app, status);
  add_check_command(app, status);
  add_diagnose_command(app, status);
  add_robot_command(app, status);
  add_simulate_command(app, status);
  add_sweep_command(app, status);
  add_mpc_command(app, status);
  add_compare_command(app, status);
  add_figures_command(app, status);
  add_report_command(app, status);
  add_view_command(app, status);
  add_export_command(app, status);
  add_batch_command(app, status);
  add_library_command(app, status);
  add_retarget_command(app, status);
  add_new_command(app, status);
  add_doctor_command(app, status);
  add_completion_command(app, status);
  if (argc == 1) {
    print_result(app.help());
    return kBadInput;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text);
      print_result(text.str());
      return kPassed;
    }
    return report_error(argc, argv, parse_message(app, error, argc, argv), kBadInput,
                        "\nFor help: prowl " + first_verb(app, argc, argv) + "--help");
  }
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  const auto report = [&](const std::exception& error, int status) {
    return report_error(argc, argv, error.what(), status);
  };
  open_standard_streams();
  try {
    return run(argc, argv);
  } catch (const prowl::InputError& error) {
    return report(error, kBadInput);
  } catch (const prowl::FileError& error) {
    return report(error, kFiles);
  } catch (const std::filesystem::filesystem_error& error) {
    return report(error, kFiles);
  } catch (const prowl::NumericalError& error) {
    return report(error, kNumericalFailure);
  } catch (const std::exception& error) {
    return report(error, kUnexpected);
  }
}
