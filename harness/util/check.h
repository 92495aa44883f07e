#pragma once

#include <cstdio>
#include <cstdlib>

#include <fmt/format.h>

/// Assertions for our own logic, kept in release builds: a measurement made by a program in a wrong
/// state is worth nothing. Never used for input (that is InputError).
#define OITLAB_CHECK(condition)                                          \
  do {                                                                   \
    if (!(condition)) [[unlikely]]                                       \
      ::oitlab::detail::checkFailed(#condition, __FILE__, __LINE__, ""); \
  } while (false)

/// Compares two printable values and prints both when they differ from what was claimed.
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
