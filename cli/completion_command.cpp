// prowl completion: what a shell needs to complete the command line, from the tree of verbs and options that CLI11 has. A new
// verb or option needs nothing here: what its values are is told by its type name (*.toml, DIR, FILE, PATH) and its choices.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <memory>

#include "commands.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "shared_options.hpp"

namespace prowl::cli {
namespace {

/// What stands for a positional or for the value of an option.
struct Value {
  bool is_toml = false, is_folder = false, is_file = false;
  std::vector<std::string> choices;
};

struct Option {
  std::vector<std::string> names;  ///< "--out", "-h"
  std::string meaning, type;
  int values = 0;  ///< that follow it
  bool repeats = false;
  Value value;
};

struct Verb {
  std::string name, meaning;
  std::vector<Option> options, positionals;
};

/// From "DIR", "TASK.toml", "NAME:{riccati,fatrop,ipopt}".
Value value_of(const std::string& type) {
  const auto has = [&type](const char* word) { return type.find(word) != std::string::npos; };
  Value value{.is_toml = has(".toml"), .is_folder = has("DIR"), .is_file = has("FILE") || has("PATH") || has("URDF"), .choices = {}};
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
  read.values = option.get_items_expected_min() > 0 ? option.get_type_size_max() * std::max(1, option.get_expected_min()) : 0;
  read.repeats = option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
  read.value = value_of(type);
  return read;
}

/// With the options of the verbs below it (prowl new robot), whose names are its first word, whatever they take the second.
Verb verb_of(const CLI::App& app) {
  Verb verb{app.get_name(), app.get_description(), {}, {}};
  const auto is_new = [&verb](const Option& option) {
    return std::none_of(verb.options.begin(), verb.options.end(), [&](const Option& known) { return known.names == option.names; });
  };
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) {
      verb.positionals.push_back(option_of(*option));
    } else if (!option->get_group().empty()) {
      verb.options.push_back(option_of(*option));
    }
  }
  const auto below = app.get_parent() ? app.get_subcommands([](const CLI::App*) { return true; }) : std::vector<const CLI::App*>{};
  if (below.empty()) return verb;
  Option which{.names = {}, .meaning = "", .type = "VERB"}, object{.names = {}, .meaning = "", .type = "FILE"};
  for (const CLI::App* app_below : below) {
    const Verb inner = verb_of(*app_below);
    which.value.choices.push_back(inner.name);
    std::copy_if(inner.options.begin(), inner.options.end(), std::back_inserter(verb.options), is_new);
    for (const Option& positional : inner.positionals) {
      object.value.is_toml = object.value.is_toml || positional.value.is_toml;
      object.value.is_file = object.value.is_file || positional.value.is_file;
    }
  }
  which.value.is_file = object.value.is_file;  // where a shell does not tell the words apart
  verb.positionals = {which, object};
  return verb;
}

std::vector<Verb> verbs_of(const CLI::App& app) {
  std::vector<Verb> verbs;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; })) verbs.push_back(verb_of(*verb));
  return verbs;
}

/// In single quotes, for all three shells: none of our texts ends in a backslash.
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
  const std::string kinds = fmt::format("kinds='{}{}{}'", value.is_toml ? "toml " : "", value.is_folder ? "folder " : "", value.is_file ? "file " : "");
  if (value.choices.empty()) return kinds;
  return fmt::format("words={}; {}", in_quotes(fmt::format("{}", fmt::join(value.choices, " "))), kinds);
}

std::string bash(const CLI::App& app) {
  const std::vector<Verb> verbs = verbs_of(app);
  std::map<std::string, std::vector<std::string>> patterns;  // by what completes the value
  std::string values, options;
  std::vector<std::string> names;
  for (const Verb& verb : verbs) {
    names.push_back(verb.name);
    for (const Option& option : verb.options) {
      if (option.values == 0) continue;
      for (const std::string& name : option.names) patterns[bash_value(option.value)].push_back(in_quotes(verb.name + " " + name));
    }
    options += fmt::format("      {}) options={}; {} ;;\n", verb.name, in_quotes(all_names(verb.options)),
                           verb.positionals.empty() ? ":" : bash_value(verb.positionals.front().value));
  }
  for (const auto& [value, words] : patterns) values += fmt::format("    {}) {}; is_value=1 ;;\n", fmt::join(words, "|"), value);
  return fmt::format(R"(# Completion of prowl for bash: source <(prowl completion bash)
_prowl() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} verb= words= kinds= options= is_value= kind
  COMPREPLY=()
  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${{COMP_WORDS[COMP_CWORD-2]}}; fi
  if ((COMP_CWORD > 1)); then verb=${{COMP_WORDS[1]}}; fi
  case "$verb $before" in
{}  esac
  if [[ -z $is_value ]]; then
    case $verb in
      '') words={}; options={} ;;
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
                     values, in_quotes(fmt::format("{}", fmt::join(names, " "))), in_quotes(all_names(verb_of(app).options)), options);
}

/// Within [ ] and between colons of _arguments.
std::string zsh_text(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += (c == '[' || c == ']' || c == ':' ? "\\" : "") + std::string(1, c);
  return safe;
}

std::string zsh_action(const Value& value) {
  if (!value.choices.empty()) return fmt::format("({})", fmt::join(value.choices, " "));
  if (value.is_toml) return "_files -g \"*.toml\"";  // and folders, to go into
  if (value.is_folder) return "_files -/";
  return value.is_file ? "_files" : " ";
}

std::string zsh_specs(const Verb& verb) {
  std::string specs;
  for (const Option& option : verb.options) {
    for (const std::string& name : option.names) {
      std::string spec = (option.repeats ? "*" : "") + name + "[" + zsh_text(option.meaning) + "]";
      for (int i = 0; i < option.values; ++i) spec += fmt::format(":{}:{}", zsh_text(option.type), zsh_action(option.value));
      specs += " \\\n        " + in_quotes(spec);
    }
  }
  for (std::size_t i = 0; i < verb.positionals.size(); ++i) {
    const Option& positional = verb.positionals[i];
    specs += " \\\n        " + in_quotes(fmt::format("{}:{}:{}", i + 1, zsh_text(positional.type), zsh_action(positional.value)));
  }
  return specs;
}

std::string zsh(const CLI::App& app) {
  std::string names, cases;
  for (const Verb& verb : verbs_of(app)) {
    names += fmt::format("    {}\n", in_quotes(verb.name + ":" + zsh_text(verb.meaning)));
    cases += fmt::format("      {}) _arguments{} ;;\n", verb.name, zsh_specs(verb));
  }
  return fmt::format(R"(#compdef prowl
# Completion of prowl for zsh: source <(prowl completion zsh), after compinit
_prowl() {{
  local state line
  local -a verbs
  verbs=(
{})
  _arguments -C{} '1:verb:->verb' '*::argument:->argument'
  case $state in
    verb) _describe verb verbs ;;
    argument) case $line[1] in
{}    esac ;;
  esac
}}
if [[ $funcstack[1] == _prowl ]]; then _prowl "$@"; else compdef _prowl prowl; fi
)",
                     names, zsh_specs(verb_of(app)), cases);
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

std::string fish(const CLI::App& app) {
  std::string text = "# Completion of prowl for fish: prowl completion fish | source\ncomplete -c prowl -f\n";
  for (const Option& option : verb_of(app).options) text += "complete -c prowl -n __fish_use_subcommand" + fish_option(option) + "\n";
  for (const Verb& verb : verbs_of(app)) {
    text += fmt::format("complete -c prowl -n __fish_use_subcommand -a {} -d {}\n", verb.name, in_quotes(verb.meaning));
    const std::string in_verb = fmt::format("complete -c prowl -n '__fish_seen_subcommand_from {}'", verb.name);
    for (const Option& option : verb.options) text += in_verb + fish_option(option) + "\n";
    for (const Option& positional : verb.positionals) text += in_verb + fish_value(positional.value) + "\n";
  }
  return text;
}

}  // namespace

void add_completion_command(CLI::App& app, int& status) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* const verb = app.add_subcommand("completion", "Print what a shell needs to complete this command");
  verb->add_option("shell", *shell, "Whose script to print")
      ->required()->check(CLI::IsMember({"bash", "zsh", "fish"}))->type_name("SHELL");
  set_footer(*verb, {"prowl completion bash > ~/.local/share/bash-completion/completions/prowl", "prowl completion zsh > ~/.zfunc/_prowl",
                     "prowl completion fish > ~/.config/fish/completions/prowl.fish"},
             "0, 2 bad input. What else a shell needs: docs/command-line.md.");
  verb->callback([shell, &app, &status] {
    print_result(*shell == "bash" ? bash(app) : *shell == "zsh" ? zsh(app) : fish(app));
    status = kPassed;
  });
}

}  // namespace prowl::cli
