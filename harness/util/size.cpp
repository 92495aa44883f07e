#include "util/size.h"

#include <cctype>

namespace oitlab {

std::optional<std::pair<std::uint32_t, std::uint32_t>> parseSize(const std::string& text) {
  const auto x = text.find('x');
  auto number = [](const std::string& digits) -> std::optional<std::uint32_t> {
    if (digits.empty() || digits.size() > 6) return std::nullopt;
    std::uint32_t value = 0;
    for (const char c : digits) {
      if (!std::isdigit(static_cast<unsigned char>(c))) return std::nullopt;
      value = value * 10 + std::uint32_t(c - '0');
    }
    return value;
  };
  if (x == std::string::npos) return std::nullopt;
  const auto width = number(text.substr(0, x));
  const auto height = number(text.substr(x + 1));
  if (!width || !height) return std::nullopt;
  return std::pair(*width, *height);
}

}  // namespace oitlab
