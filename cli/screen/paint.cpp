#include "cli/screen/paint.hpp"

#include <fmt/color.h>

#include <algorithm>
#include <array>
#include <sstream>
#include <string_view>

namespace prowl::cli {
namespace {

using Style = fmt::text_style;

const Style kGood = fmt::fg(fmt::terminal_color::green), kCareful = fmt::fg(fmt::terminal_color::yellow),
            kBad = fmt::fg(fmt::terminal_color::red), kHeading = fmt::emphasis::bold;

struct Word {
  std::string_view text;
  const Style& style;
};

/// At the end of a row, behind two spaces.
const std::array kVerdicts{Word{"pass", kGood}, Word{"draft", kCareful}, Word{"FAIL", kBad}};
/// At the beginning of a line.
const std::array kBeginnings{Word{"note:", kCareful},     Word{"warning:", kCareful},    Word{"WARNING:", kBad},
                             Word{"prowl:", kBad},        Word{"failed:", kBad},         Word{"Usage:", kHeading},
                             Word{"Examples:", kHeading}, Word{"Exit status:", kHeading}};
/// Behind "certificate: ".
const std::array kResults{Word{"passed", kGood}, Word{"FAILED", kBad}};
/// Behind "grade: ".
const std::array kGrades{Word{"certified", kGood}, Word{"draft", kCareful}, Word{"failed", kBad}};

std::string painted(std::string_view word, const Style& style) { return fmt::format(style, "{}", word); }

/// Paints the first of `words` found directly behind `label`.
template <class Words>
void paint_behind(std::string& line, std::string_view label, const Words& words) {
  const std::size_t at = line.find(label);
  if (at == std::string::npos) return;
  for (const Word& word : words) {
    if (line.compare(at + label.size(), word.text.size(), word.text) != 0) continue;
    line.replace(at + label.size(), word.text.size(), painted(word.text, word.style));
    return;
  }
}

/// "Mesh:" on its own line.
bool is_heading(std::string_view line) {
  return line.size() > 1 && line.ends_with(':') && line.find_first_of(" .") == std::string_view::npos;
}

std::string painted_line(std::string line) {
  for (const Word& word : kVerdicts) {
    const std::string end = "  " + std::string(word.text);
    if (!line.starts_with("  ") || !line.ends_with(end)) continue;
    return line.substr(0, line.size() - word.text.size()) + painted(word.text, word.style);
  }
  if (line.starts_with("certificate: ")) {
    paint_behind(line, "grade: ", kGrades);
    paint_behind(line, "certificate: ", kResults);
    return line;
  }
  const std::size_t first = std::min(line.find_first_not_of(' '), line.size());
  for (const Word& word : kBeginnings) {
    if (line.compare(first, word.text.size(), word.text) != 0) continue;
    return line.replace(first, word.text.size(), painted(word.text, word.style));
  }
  return is_heading(line) ? painted(line, kHeading) : line;
}

}  // namespace

std::string paint(const std::string& text) {
  std::istringstream lines(text);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    result += painted_line(line);
    if (!lines.eof()) result += "\n";
  }
  return result;
}

}  // namespace prowl::cli
