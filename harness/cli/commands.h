#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace oitlab {

/// Runs the chosen verb and returns the exit code.
using Action = std::function<int()>;

/// Exit codes (docs/design.md, "Errors").
enum ExitCode {
  exitDone = 0,
  exitSomeFailed = 1,
  exitBadInput = 2,
  exitNoDevice = 3,
  exitCannotWrite = 4,
  exitInternal = 5,
  exitSignal = 128  ///< plus the signal's number
};

// Each function adds a verb to the program, and sets `action` if the verb is given.
void addInfo(CLI::App& program, Action& action);
void addList(CLI::App& program, Action& action);
void addScene(CLI::App& program, Action& action);
void addRender(CLI::App& program, Action& action);
void addRun(CLI::App& program, Action& action);
void addCompare(CLI::App& program, Action& action);
void addDepth(CLI::App& program, Action& action);
void addAnalysis(CLI::App& program, Action& action);

}  // namespace oitlab
