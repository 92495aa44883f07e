#pragma once

#include <cstdint>

namespace oitlab {

/// PCG-XSH-RR 64/32 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
/// Algorithms for Random Number Generation", 2014). The distributions of standard libraries differ,
/// but a generated scene must be the same everywhere.
class Pcg32 {
 public:
  explicit Pcg32(std::uint64_t seed, std::uint64_t stream = 0) : increment_(2 * stream + 1) {
    next();
    state_ += seed;
    next();
  }

  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005u + increment_;
    const auto shifted = std::uint32_t(((old >> 18) ^ old) >> 27);
    const auto turn = std::uint32_t(old >> 59);
    return (shifted >> turn) | (shifted << (-turn & 31u));
  }

  /// Uniform in [0, 1), a multiple of 2^-24, which a float represents exactly.
  float uniform() { return float(next() >> 8) * 0x1p-24f; }

  /// Uniform in [low, high).
  float uniform(float low, float high) { return low + (high - low) * uniform(); }

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

}  // namespace oitlab
