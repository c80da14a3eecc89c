// prowl completion: scripts that complete the command line, from the verbs and options in CLI11.
// New verbs and options need no code here: type name (*.toml, DIR, FILE, PATH) and choices define
// their values.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"

namespace prowl::cli {
namespace {

/// Completion of a positional or of the value of an option.
struct Value {
  bool is_toml = false, is_folder = false, is_file = false;
  std::vector<std::string> choices;
};

struct Option {
  std::vector<std::string> names;  ///< "--out", "-h"
  std::string meaning, type;
  int values = 0;  ///< number of values
  bool repeats = false;
  Value value;
};

/// The command, a verb, or a subverb.
struct Verb {
  std::string path;  ///< "" for the command, "plan", "new robot"
  std::string name, meaning;
  std::vector<Option> options, positionals;
  std::vector<Verb> verbs;
};

/// From "DIR", "TASK.toml", "NAME:{riccati,fatrop,...}".
Value value_of(const std::string& type) {
  const auto has = [&type](const char* word) { return type.find(word) != std::string::npos; };
  Value value{.is_toml = has(".toml"),
              .is_folder = has("DIR"),
              .is_file = has("FILE") || has("PATH") || has("URDF"),
              .choices = {}};
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open != std::string::npos && close != std::string::npos) {
    value.choices = CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
  }
  return value;
}

Option option_of(const CLI::Option& option) {
  Option read;
  for (const std::string& name : option.get_lnames()) read.names.push_back("--" + name);
  for (const std::string& name : option.get_snames()) read.names.push_back("-" + name);
  read.meaning = option.get_description();
  const std::string type = option.get_type_name();
  read.type = type.substr(0, type.find(':'));
  read.values =
      option.get_items_expected_min() > 0 ? option.get_type_size_max() * std::max(1, option.get_expected_min()) : 0;
  read.repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  read.value = value_of(type);
  return read;
}

Verb describe_verb(const CLI::App& app, const std::string& path = "") {
  Verb verb{path, app.get_name(), app.get_description(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      verb.positionals.push_back(option_of(*option));
    } else if (!option->get_group().empty()) {
      verb.options.push_back(option_of(*option));
    }
  }
  for (const CLI::App* below : app.get_subcommands([](const CLI::App*) { return true; })) {
    verb.verbs.push_back(describe_verb(*below, path + (path.empty() ? "" : " ") + below->get_name()));
  }
  return verb;
}

std::string names_of(const std::vector<Verb>& verbs) {
  std::vector<std::string> names;
  for (const Verb& verb : verbs) names.push_back(verb.name);
  return fmt::format("{}", fmt::join(names, " "));
}

/// In single quotes, for all three shells; no text ends with a backslash.
std::string in_quotes(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + safe + "'";
}

std::string all_names(const std::vector<Option>& options) {
  std::vector<std::string> names;
  for (const Option& option : options) names.insert(names.end(), option.names.begin(), option.names.end());
  return fmt::format("{}", fmt::join(names, " "));
}

std::string bash_value(const Value& value) {
  if (!value.choices.empty())
    return fmt::format("words={}", in_quotes(fmt::format("{}", fmt::join(value.choices, " "))));
  return fmt::format("kinds='{}{}{}'", value.is_toml ? "toml " : "", value.is_folder ? "folder " : "",
                     value.is_file ? "file " : "");
}

struct BashCases {
  std::map<std::string, std::vector<std::string>> values;  ///< completion -> patterns "plan --solver"
  std::string verbs;
  std::vector<std::string> paths;  ///< of subverbs
};

void add_bash_cases(const Verb& verb, BashCases& cases) {
  for (const Option& option : verb.options) {
    if (option.values == 0) continue;
    for (const std::string& name : option.names)
      cases.values[bash_value(option.value)].push_back(in_quotes(verb.path + " " + name));
  }
  std::string argument = ":";
  if (!verb.verbs.empty()) {
    argument = "words=" + in_quotes(names_of(verb.verbs));
  } else if (!verb.positionals.empty()) {
    argument = bash_value(verb.positionals.front().value);
  }
  cases.verbs +=
      fmt::format("      {}) options={}; {} ;;\n", in_quotes(verb.path), in_quotes(all_names(verb.options)), argument);
  if (verb.path.find(' ') != std::string::npos) cases.paths.push_back(in_quotes(verb.path));
  for (const Verb& below : verb.verbs) add_bash_cases(below, cases);
}

std::string bash(const Verb& command) {
  BashCases cases;
  add_bash_cases(command, cases);
  std::string values;
  for (const auto& [value, patterns] : cases.values) {
    values += fmt::format("    {}) {}; is_value=1 ;;\n", fmt::join(patterns, "|"), value);
  }
  const std::string second = cases.paths.empty()
                                 ? ""
                                 : fmt::format(
                                       "  if ((COMP_CWORD > 2)); then case \"$verb ${{COMP_WORDS[2]}}\" in {}) "
                                       "verb+=\" ${{COMP_WORDS[2]}}\" ;; esac; fi\n",
                                       fmt::join(cases.paths, "|"));
  return fmt::format(R"(# Completion of prowl for bash: source <(prowl completion bash)
_prowl() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb= words= kinds= options= is_value= kind
  COMPREPLY=()
  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  if ((COMP_CWORD > 1)); then verb=${{COMP_WORDS[1]}}; fi
{}  case "$verb $before" in
{}  esac
  if [[ -z $is_value ]]; then
    case $verb in
{}    esac
    if [[ $word == -* ]]; then words=$options; kinds=; fi
  fi
  if [[ -n $words ]]; then mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word"); fi
  for kind in $kinds; do
    compopt -o filenames 2>/dev/null
    case $kind in
      toml) mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -X '!*.toml' -- "$word"; compgen -d -- "$word") ;;
      folder) mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -d -- "$word") ;;
      file) mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$word") ;;
    esac
  done
}}
complete -F _prowl prowl
)",
                     second, values, cases.verbs);
}

/// Escapes for [ ] and colons of _arguments; _describe needs only colons.
std::string zsh_text(const std::string& text, const std::string& special = "[]:") {
  std::string safe;
  for (const char c : text) safe += (special.find(c) == std::string::npos ? "" : "\\") + std::string(1, c);
  return safe;
}

std::string zsh_action(const Value& value) {
  if (!value.choices.empty()) return fmt::format("({})", fmt::join(value.choices, " "));
  if (value.is_toml) return "_files -g \"*.toml\"";  // and folders
  if (value.is_folder) return "_files -/";
  return value.is_file ? "_files" : " ";
}

std::string zsh_specs(const Verb& verb) {
  std::string specs;
  for (const Option& option : verb.options) {
    for (const std::string& name : option.names) {
      std::string spec = (option.repeats ? "*" : "") + name + "[" + zsh_text(option.meaning) + "]";
      for (int i = 0; i < option.values; ++i)
        spec += fmt::format(":{}:{}", zsh_text(option.type), zsh_action(option.value));
      specs += " \\\n        " + in_quotes(spec);
    }
  }
  for (std::size_t i = 0; i < verb.positionals.size(); ++i) {
    const Option& positional = verb.positionals[i];
    specs += " \\\n        " +
             in_quotes(fmt::format("{}:{}:{}", i + 1, zsh_text(positional.type), zsh_action(positional.value)));
  }
  return specs;
}

std::string zsh_body(const Verb& verb) {
  if (verb.verbs.empty()) return fmt::format("_arguments{}", zsh_specs(verb));
  std::string names, cases;
  for (const Verb& below : verb.verbs) {
    names += fmt::format("    {}\n", in_quotes(below.name + ":" + zsh_text(below.meaning, ":")));
    cases += fmt::format("      {}) {} ;;\n", below.name, zsh_body(below));
  }
  return fmt::format(R"(state= verbs=(
{})
  _arguments -C{} '1:verb:->verb' '*::argument:->argument'
  case $state in
    verb) _describe verb verbs ;;
    argument) case $line[1] in
{}    esac ;;
  esac)",
                     names, zsh_specs(verb), cases);
}

std::string zsh(const Verb& command) {
  return fmt::format(R"(#compdef prowl
# Completion of prowl for zsh: source <(prowl completion zsh), after compinit
_prowl() {{
  local state line
  local -a verbs
  {}
}}
if [[ $funcstack[1] == _prowl ]]; then _prowl "$@"; else compdef _prowl prowl; fi
)",
                     zsh_body(command));
}

std::string fish_value(const Value& value) {
  if (!value.choices.empty()) return fmt::format(" -a {}", in_quotes(fmt::format("{}", fmt::join(value.choices, " "))));
  if (value.is_toml) return " -a '(__fish_complete_suffix .toml)'";
  if (value.is_folder) return " -a '(__fish_complete_directories)'";
  return value.is_file ? " -F" : "";
}

std::string fish_option(const Option& option) {
  std::string text;
  for (const std::string& name : option.names) {
    text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (option.values > 0) text += (option.value.is_file ? " -r" : " -x") + fish_value(option.value);
  return text + " -d " + in_quotes(option.meaning);
}

void add_fish_lines(const Verb& verb, std::string& text) {
  const char* const where =
      verb.verbs.empty() ? "__prowl_in" : "__prowl_at";  // subverbs only directly after their verb
  const std::string here = fmt::format("complete -c prowl -n '{} {}'", where, verb.path);
  for (const Option& option : verb.options) text += here + fish_option(option) + "\n";
  for (const Option& positional : verb.positionals) text += here + fish_value(positional.value) + "\n";
  for (const Verb& below : verb.verbs) {
    text += fmt::format("{} -a {} -d {}\n", here, below.name, in_quotes(below.meaning));
    add_fish_lines(below, text);
  }
}

std::string fish(const Verb& command) {
  std::string text = R"(# Completion of prowl for fish: prowl completion fish | source
function __prowl_at  # true if the words after the command are exactly these
  set -l words (commandline -opc)
  test "$words[2..-1]" = "$argv"
end
function __prowl_in  # true if the words after the command begin with these
  set -l words (commandline -opc)
  string match -q -- "$argv *" "$words[2..-1] "
end
complete -c prowl -f
)";
  add_fish_lines(command, text);
  return text;
}

}  // namespace

void add_completion_command(CLI::App& app, int& status) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* const verb = app.add_subcommand("completion", "Print a script that completes this command in a shell");
  verb->add_option("shell", *shell, "Shell of the script")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}))
      ->type_name("SHELL");
  set_footer(
      *verb,
      {"prowl completion bash > ~/.local/share/bash-completion/completions/prowl",
       "prowl completion zsh > ~/.zfunc/_prowl", "prowl completion fish > ~/.config/fish/completions/prowl.fish"},
      "0, 2 bad input. Installation: docs/command-line.md.");
  verb->callback([shell, &app, &status] {
    const Verb command = describe_verb(app);
    print_bytes(*shell == "bash" ? bash(command) : *shell == "zsh" ? zsh(command) : fish(command));
    status = kPassed;
  });
}

}  // namespace prowl::cli
