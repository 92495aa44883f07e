#pragma once

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

/// An assertion about the program's own logic. It is also in release builds, because the
/// measurements of a program in a wrong state are worthless. Wrong input is not its business: that
/// is an InputError.
#define OITLAB_CHECK(condition)                                          \
  do {                                                                   \
    if (!(condition)) [[unlikely]]                                       \
      ::oitlab::detail::checkFailed(#condition, __FILE__, __LINE__, ""); \
  } while (false)

/// Asserts a comparison of two printable values, and prints both when it is false.
#define OITLAB_CHECK_OP(a, op, b)                                                  \
  do {                                                                             \
    const auto& checkA = (a);                                                      \
    const auto& checkB = (b);                                                      \
    if (!(checkA op checkB)) [[unlikely]]                                          \
      ::oitlab::detail::checkFailed(#a " " #op " " #b, __FILE__, __LINE__,         \
                                    fmt::format("{} against {}", checkA, checkB)); \
  } while (false)

namespace oitlab::detail {

[[noreturn]] inline void checkFailed(const char* what, const char* file, int line,
                                     const std::string& values) {
  fmt::print(stderr, "oitlab: internal error: {}:{}: check failed: {} {}\n", file, line, what,
             values);
  std::abort();
}

}  // namespace oitlab::detail
