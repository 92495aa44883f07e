#pragma once

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace oitlab {

/// The seconds for the remaining cells if they take as long as the finished ones did on average.
/// Empty while no cell is finished or no time has passed.
std::optional<double> estimateSecondsLeft(std::size_t done, std::size_t total,
                                          double elapsedSeconds);

/// "00:12", "12:34" or "1:02:03", rounded up to whole seconds; "100 h" and more in hours.
std::string formatSeconds(double seconds);

/// "[ 3/12] boxes reference 640x360   00:12 left": finished cells, the current cell, the estimate.
/// The label is cut so that the line has at most `columns`: a line that is rewritten must not wrap.
std::string progressLine(std::size_t done, std::size_t total, std::string_view label,
                         std::optional<double> secondsLeft, std::size_t columns);

bool isTerminal(std::FILE* file);

/// Shows the progress of a sweep in one line, which is rewritten in place and cleared at the end.
/// If `out` is a file or a pipe it prints nothing, or with `verbose` one plain line per cell.
class Progress {
 public:
  explicit Progress(std::size_t total, bool enabled = isTerminal(stderr), bool verbose = false,
                    std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// A cell starts. `total` should count the cells that will be run: with the cells that a resumed
  /// sweep already has, the estimate would be too low.
  void begin(std::string_view label);

  /// The cell is finished. After the last one the line is cleared.
  void finish();

  /// Clears the line before another message is printed. The next begin() shows it again.
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
