#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace oitlab {

/// Seconds that the remaining cells take if they take as long as the done ones did on average; none
/// while no cell is done or the clock has not moved.
std::optional<double> estimateSecondsLeft(std::size_t done, std::size_t total,
                                          double elapsedSeconds);

/// "00:12", "12:34" or "1:02:03", rounded up to whole seconds; "100 h" and more in hours.
std::string formatSeconds(double seconds);

/// "[ 3/12] boxes reference 640x360   00:12 left": cells done, the cell now, the estimate. Cut to
/// `columns` at the label, so that a line that is rewritten in place never wraps.
std::string progressLine(std::size_t done, std::size_t total, std::string_view label,
                         std::optional<double> secondsLeft, std::size_t columns);

bool isTerminal(std::FILE* file);

/// How far a sweep is: one line, rewritten in place and cleared at the end. Where `out` is a file
/// or a pipe nothing is printed, or with `verbose` one plain line a cell.
class Progress {
 public:
  explicit Progress(std::size_t total, bool enabled = isTerminal(stderr), bool verbose = false,
                    std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A cell begins. `total` should count cells that are to be run: those that a resumed sweep
  /// already has would make the estimate too good.
  void begin(std::string_view label);

  /// The cell is done; after the last one the line is cleared.
  void finish();

  /// Clears the line, for a message that is to be printed in between; the next begin() shows it
  /// again.
  void clear();

 private:
  std::size_t total_;
  std::size_t done_ = 0;
  bool enabled_;
  bool verbose_;
  bool shown_ = false;
  std::FILE* out_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace oitlab
