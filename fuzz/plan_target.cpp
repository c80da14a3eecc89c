// plan.json, with the texts of task, robot and URDF in it.
#include "input.hpp"
#include "prowl/plan_folder/plan_json.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  const SourceText source{"plan.json", fuzz::text_of(data, size)};
  fuzz::takes_or_refuses([&] {
    plan_to_json(plan_from_json(source, {})).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  });
  return 0;
}
