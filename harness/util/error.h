#pragma once

#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace oitlab {

/// Something that the user gave is wrong: a file, a name or a value. The message says where, what
/// was found and what was expected. The program ends with exit code 2.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device cannot do what is asked: there is none, it lacks a feature, or it has too little
/// memory. Before the first cell the program ends with exit code 3. In a cell, the cell becomes a
/// row with this message as the reason.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws an error with a formatted message: fail<InputError>("{}: no such file", path).
template <typename Error, typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace oitlab
