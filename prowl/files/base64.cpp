#include "prowl/files/base64.hpp"

#include <bit>
#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cstddef>

namespace prowl {
namespace {

static_assert(std::endian::native == std::endian::little);

std::string encode(std::span<const std::byte> bytes) {
  using namespace boost::archive::iterators;
  using Letters = base64_from_binary<transform_width<const char*, 6, 8>>;
  std::string whole(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t missing = (3 - whole.size() % 3) % 3;
  whole.append(missing, '\0');  // the iterators read three bytes at a time, also beyond an end
  std::string text(Letters(whole.data()), Letters(whole.data() + whole.size()));
  text.replace(text.size() - missing, missing, missing, '=');
  return text;
}

}  // namespace

std::string base64(std::span<const float> numbers) { return encode(std::as_bytes(numbers)); }
std::string base64(std::span<const std::uint32_t> numbers) { return encode(std::as_bytes(numbers)); }

}  // namespace prowl
