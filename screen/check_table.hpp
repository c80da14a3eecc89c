#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "prowl/certificate/certificate.hpp"

namespace prowl {

/// Whether a check passes, but keeps the plan from grade certified.
bool is_draft(const CertificateCheck& check);

/// What stands between limit and place: the share of the limit that is used, or the time of the worst value.
enum class CheckColumn { used, time };

inline constexpr std::size_t kAnyWidth = std::numeric_limits<std::size_t>::max();

/// The checks with worst value, limit, place and verdict, a row each, under a heading. A screen of fewer `columns` than
/// that takes has places cut, and then columns left out: times, places, limits, values; names and verdicts stay.
std::string check_table(const std::vector<const CertificateCheck*>& checks, CheckColumn fourth,
                        std::size_t columns = kAnyWidth);

}  // namespace prowl
