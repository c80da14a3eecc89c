#include "prowl/model/mirror_name.hpp"

#include <algorithm>
#include <utility>

namespace prowl {

namespace {

/// Replaces every `from` that begins a word (at the start, or after an underscore).
std::string replace_words(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
    if (at == 0 || text[at - 1] == '_') text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace

std::optional<std::string> right_counterpart(const std::string& left, const std::vector<std::string>& names) {
  // Leg names of quadrupeds: (left, right) and (fore, hind or rear), in either order.
  static const std::vector<std::pair<std::string, std::string>> kWords = {
      {"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}, {"lf", "rf"}, {"LF", "RF"}, {"lh", "rh"}, {"LH", "RH"},
      {"fl", "fr"},      {"FL", "FR"},      {"hl", "hr"},      {"HL", "HR"}, {"rl", "rr"}, {"RL", "RR"}, {"l_", "r_"},
      {"L_", "R_"},      {"L", "R"}};
  for (const auto& [left_word, right_word] : kWords) {
    const std::string right = replace_words(left, left_word, right_word);
    if (right != left && std::find(names.begin(), names.end(), right) != names.end()) return right;
  }
  return std::nullopt;
}

}  // namespace prowl
