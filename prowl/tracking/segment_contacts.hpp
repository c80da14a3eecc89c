#pragma once

#include <vector>

#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// Indices of the contacts in stance during a segment, ascending.
inline std::vector<int> contacts_of(const TrackingPlan::Segment& segment) {
  std::vector<int> contacts;
  for (std::size_t c = 0; c < segment.in_contact.size(); ++c) {
    if (segment.in_contact[c]) contacts.push_back(static_cast<int>(c));
  }
  return contacts;
}

}  // namespace prowl
