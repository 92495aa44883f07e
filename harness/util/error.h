#pragma once

#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace oitlab {

/// Something the user gave is wrong: a file, a name, a value. The message names the place, what was
/// found and what was wanted. The program ends with exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device cannot do what is asked: none there, a missing feature, not enough memory. A program
/// that meets it before any cell ran ends with exit code 3; a cell that meets it becomes a row with
/// this message as its reason.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// `throw` with an fmt format string: fail<InputError>("{}: no such file", path).
template <typename Error, typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace oitlab
