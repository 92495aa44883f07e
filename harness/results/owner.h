#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace oitlab {

/// A process that measures into a results folder, which any number of processes on any number of
/// machines may share.
struct Owner {
  std::string token;    ///< different for each claim: 16 hexadecimal digits
  std::string host;     ///< for people
  std::string machine;  ///< a boot of a machine, and the process namespace within it
  int process = 0;
  std::string started;  ///< when the process started, as the machine counts: pids are used again

  /// This process, with a new token.
  static Owner self();

  nlohmann::json toJson() const;
  /// What is missing stays empty.
  static Owner fromJson(const nlohmann::json& json);

  /// "process 4711 on host"; "another process" where that is not known.
  std::string describe() const;

  /// Surely at its end: it ran on this machine, and there is no such process now. False where that
  /// cannot be known.
  bool isDead() const;
};

}  // namespace oitlab
