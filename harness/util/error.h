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

/// The device stopped working (a crash of the driver, a hang that the system ended): nothing that
/// was made on it can be used any more. It can be opened anew.
struct DeviceLost : DeviceError {
  using DeviceError::DeviceError;
};

/// The device did not finish its work in time, and nobody knows whether it ever will. It is
/// abandoned (gpu/abandon.h).
struct DeviceHung : DeviceLost {
  using DeviceLost::DeviceLost;
};

/// Results cannot be written: the disk is full, the folder is gone or read-only. No input mends it,
/// and there is no point in measuring on: the program ends with exit code 4.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws an error with a formatted message: fail<InputError>("{}: no such file", path).
template <typename Error, typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
  throw Error(fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace oitlab
