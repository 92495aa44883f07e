#pragma once

#include <cstddef>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace oitlab {

/// "00:12", "12:34" or "1:02:03", rounded up to whole seconds; "100 h" and more in hours.
std::string formatSeconds(double seconds);

/// "[ 3/12] boxes reference 640x360   00:12 left": finished cells, the current cell, the estimate.
/// The label is cut so that the line has at most `columns`: a line that is rewritten must not wrap.
std::string progressLine(std::size_t done, std::size_t total, std::string_view label,
                         std::optional<double> secondsLeft, std::size_t columns);

bool isTerminal(std::FILE* file);

/// How far a sweep is: one line, rewritten in place and cleared at the end. Where `out` is a file
/// or a pipe nothing is printed.
class Progress {
 public:
  explicit Progress(std::size_t total, bool enabled = isTerminal(stderr), std::FILE* out = stderr)
      : total_(total), enabled_(enabled), out_(out) {}
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `total` should count cells that are to be run, without those that a resumed sweep already has.
  void show(std::size_t done, std::string_view label, std::optional<double> secondsLeft);

  /// Clears the line, for a message that is to be printed in between; the next show() brings it
  /// back.
  void clear();

 private:
  std::size_t total_;
  bool enabled_;
  bool shown_ = false;
  std::FILE* out_;
};

}  // namespace oitlab
