#include "image/exr_header.h"

#include <cstdint>
#include <cstring>

#include "image/codec.h"
#include "util/error.h"

namespace oitlab {
namespace {

constexpr std::uint32_t severalParts = 0x1000;  // a bit of the version field

/// Reads from the front of the bytes. EXR is little-endian, as are all machines with Vulkan
/// drivers.
class Reader {
 public:
  Reader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  std::string_view take(std::size_t size, std::string_view what) {
    if (size > rest_.size())
      fail<InputError>("{}: bad EXR: {} of {} bytes, and the file ends after {}", name_, what, size,
                       rest_.size());
    const std::string_view taken = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return taken;
  }

  template <typename Number>
  Number number(std::string_view what) {
    Number value;
    std::memcpy(&value, take(sizeof value, what).data(), sizeof value);
    return value;
  }

  /// A text that ends with a zero byte.
  std::string_view text() {
    const std::size_t length = rest_.find('\0');
    if (length == std::string_view::npos)
      fail<InputError>("{}: bad EXR: the file ends in its header", name_);
    return take(length + 1, "a name").substr(0, length);
  }

 private:
  std::string_view rest_;
  const std::string& name_;
};

void checkWindow(std::string_view value, const std::string& name) {
  Reader reader(value, name);
  std::int64_t corners[4];  // x and y of the first pixel, then of the last
  for (std::int64_t& corner : corners) corner = reader.number<std::int32_t>("a data window");
  checkImageSize(corners[2] - corners[0] + 1, corners[3] - corners[1] + 1, name);
}

}  // namespace

void checkExrHeader(std::string_view bytes, const std::string& name) {
  Reader reader(bytes, name);
  reader.take(4, "the signature");
  const bool several = reader.number<std::uint32_t>("the version") & severalParts;
  // An attribute without a name ends a header; where there are several, an empty header ends them.
  for (bool empty = true;;) {
    const std::string_view attribute = reader.text();
    if (attribute.empty()) {
      if (empty || !several) return;
      empty = true;
      continue;
    }
    empty = false;
    reader.text();  // its type
    const auto size = reader.number<std::uint32_t>("the size of an attribute");
    const std::string_view value = reader.take(size, "an attribute");
    if (attribute == "dataWindow") checkWindow(value, name);
  }
}

}  // namespace oitlab
