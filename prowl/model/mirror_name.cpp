#include "prowl/model/mirror_name.hpp"

#include <algorithm>
#include <utility>

namespace prowl {

namespace {

/// Exchanges left and right in all words that begin with one of the two (words: at the start, or after an underscore).
/// Unchanged if the first of these is a right one, or there is none.
std::string mirrored(std::string text, const std::string& left, const std::string& right) {
  bool is_first = true;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (at > 0 && text[at - 1] != '_') continue;
    const bool is_left = text.compare(at, left.size(), left) == 0;
    const bool is_right = !is_left && text.compare(at, right.size(), right) == 0;
    if (is_first && is_right) break;
    if (is_left) text.replace(at, left.size(), right);
    if (is_right) text.replace(at, right.size(), left);
    is_first = is_first && !is_left;
  }
  return text;
}

}  // namespace

std::optional<std::string> right_counterpart(const std::string& left, const std::vector<std::string>& names) {
  // Leg names of quadrupeds: (left, right) and (fore, hind or rear), in either order.
  static const std::vector<std::pair<std::string, std::string>> kWords = {
      {"left", "right"}, {"Left", "Right"}, {"LEFT", "RIGHT"}, {"lf", "rf"}, {"LF", "RF"}, {"lh", "rh"},
      {"LH", "RH"},      {"fl", "fr"},      {"FL", "FR"},      {"hl", "hr"}, {"HL", "HR"}, {"rl", "rr"},
      {"RL", "RR"},      {"l_", "r_"},      {"L_", "R_"},      {"L", "R"}};
  for (const auto& [left_word, right_word] : kWords) {
    std::string right = mirrored(left, left_word, right_word);
    if (right != left && std::find(names.begin(), names.end(), right) != names.end()) return right;
  }
  return std::nullopt;
}

}  // namespace prowl
