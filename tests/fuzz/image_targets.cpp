// Image files that `oitlab compare` reads.
#include <stdexcept>

#include "fuzz/targets.h"
#include "image/codec.h"

namespace oitlab {
namespace {

void decodeAndCheck(Image (*decode)(std::string_view, const std::string&), std::string_view bytes) {
  parseOrRefuse([&] {
    const Image image = decode(bytes, "fuzz");
    if (image.rgba.size() != std::size_t(image.width) * std::size_t(image.height) * 4)
      throw std::logic_error("an image of another size than it says");
  });
}

}  // namespace

void fuzzPng(std::string_view bytes) {
  decodeAndCheck(decodePng, bytes);
}

void fuzzExr(std::string_view bytes) {
  decodeAndCheck(decodeExr, bytes);
}

}  // namespace oitlab
