#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace prowl::cli {

/// --help for columns(): names and choices of an option without exclusions, needs and checks
/// (errors mention them), and descriptions with a hanging indent.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
};

}  // namespace prowl::cli
