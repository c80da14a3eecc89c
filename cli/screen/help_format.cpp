#include "cli/screen/help_format.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <utility>
#include <vector>

#include "cli/screen/terminal.hpp"

namespace prowl::cli {
namespace {

constexpr std::size_t kColumn = 30;  // where descriptions begin

/// Breaks text into lines of `width`. No line begins with an option, which would look like a new
/// entry.
std::vector<std::string> lines_of(const std::string& text, std::size_t width) {
  std::istringstream words(text);
  std::vector<std::string> lines(1);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    const bool fits = line.size() + 1 + word.size() <= width;
    if (line.empty()) {
      line = word;
    } else if (fits || word.starts_with("--")) {
      line += " " + word;
    } else {
      lines.push_back(word);
    }
  }
  return lines;
}

/// As wide as the screen.
std::string paragraph(const std::string& text) {
  return fmt::format("{}\n", fmt::join(lines_of(text, columns()), "\n"));
}

std::string entry(const std::string& name, const std::string& description) {
  constexpr std::size_t kNarrowest = 30;
  const std::vector<std::string> lines =
      lines_of(description, std::max(kNarrowest, columns() > kColumn ? columns() - kColumn : 0));
  const bool has_room = name.size() + 4 <= kColumn;
  std::string text = has_room ? fmt::format("  {:<{}}", name, kColumn - 2) : fmt::format("  {}\n", name);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += (i == 0 && has_room ? "" : std::string(kColumn, ' ')) + lines[i] + "\n";
  }
  return text;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  std::string text = CLI::Formatter::make_help(app, std::move(name), mode);
  for (std::size_t at = text.find("\n\n\n"); at != std::string::npos; at = text.find("\n\n\n", at)) text.erase(at, 1);
  if (const std::size_t status = text.rfind("\nExit status: "); status != std::string::npos)
    text = text.substr(0, status + 1) + paragraph(text.substr(status));
  if (const std::size_t usage = text.find("\nUsage: "); usage != std::string::npos)
    text = paragraph(text.substr(0, usage)) + text.substr(usage + 1);
  return text;
}

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(make_option_name(option, is_positional) + make_option_opts(option), make_option_desc(option));
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  if (option->get_type_size() == 0) return "";
  std::string type = option->get_type_name();
  // After a colon CLI11 appends descriptions of the checks: keep choices, drop ranges.
  if (const std::size_t colon = type.find(':'); colon != std::string::npos && type.find('{') == std::string::npos)
    type.erase(colon);
  const std::string& preset = option->get_default_str();
  return (type.empty() ? "" : " " + type) + (preset.empty() ? "" : "=" + preset) +
         (option->get_required() ? " " + get_label("REQUIRED") : "");
}

std::string HelpFormatter::make_subcommand(const CLI::App* verb) const {
  return entry(verb->get_name(), verb->get_description());
}

}  // namespace prowl::cli
