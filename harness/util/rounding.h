#pragma once

#include <cstdint>
#include <type_traits>

namespace oitlab {

/// a / b rounded up, for unsigned a and b > 0. It does not overflow.
template <typename A, typename B>
constexpr std::common_type_t<A, B> divideUp(A a, B b) {
  static_assert(std::is_unsigned_v<A> && std::is_unsigned_v<B>);
  return a / b + (a % b != 0);
}

/// The smallest multiple of b that is at least a.
template <typename A, typename B>
constexpr std::common_type_t<A, B> roundUp(A a, B b) {
  return divideUp(a, b) * b;
}

/// The new capacity of a buffer that was too small for `counted` items: a sixteenth more, and a
/// few, so that a slowly moving camera does not make the buffer grow in every frame.
constexpr std::uint64_t withSlack(std::uint64_t counted) {
  return counted + counted / 16 + 64;
}

}  // namespace oitlab
