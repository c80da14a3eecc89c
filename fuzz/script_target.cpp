// A script of online control, as prowl mpc --script reads it.
#include "input.hpp"
#include "prowl/online/script_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace prowl;
  fuzz::takes_or_refuses([&] { read_script({"script.toml", fuzz::text_of(data, size)}); });
  return 0;
}
