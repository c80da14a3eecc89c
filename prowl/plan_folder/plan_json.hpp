#pragma once

// Writes and reads plan.json. Not installed: shows nlohmann's library.
#include <nlohmann/json.hpp>

#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl {

nlohmann::ordered_json plan_to_json(const PlanRecord& record);
nlohmann::ordered_json certificate_to_json(const Certificate& certificate);

/// All but the trajectory. Throws InputError that names the key.
PlanRecord plan_from_json(const SourceText& source, const PackageSearch& search, const OwnTerms& own_terms = {});

}  // namespace prowl
