#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace prowl::cli {

/// --help for a screen of columns(): names and choices of an option without what it excludes, needs or checks, which a
/// mistake is told of, and descriptions that go on below themselves.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* verb) const override;
};

}  // namespace prowl::cli
