// A message of the page of prowl mpc --view.
#include "input.hpp"
#include "prowl/report_page/online_wish.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  fuzz::takes_or_refuses([&] { parse_wish(fuzz::text_of(data, size)); });
  return 0;
}
