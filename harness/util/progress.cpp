#include "util/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oitlab {
namespace {

std::size_t terminalColumns(std::FILE* file) {
  winsize size{};
  const bool known = ioctl(fileno(file), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

}  // namespace

std::string formatSeconds(double seconds) {
  const auto whole = std::uint64_t(std::ceil(std::max(seconds, 0.0)));
  const std::uint64_t hours = whole / 3600;
  if (hours >= 100) return fmt::format("{} h", hours);
  if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, whole / 60 % 60, whole % 60);
  return fmt::format("{:02}:{:02}", whole / 60, whole % 60);
}

std::string progressLine(std::size_t done, std::size_t total, std::string_view label,
                         std::optional<double> secondsLeft, std::size_t columns) {
  const std::string totalText = std::to_string(total);
  const std::string head = fmt::format("[{:>{}}/{}] ", done, totalText.size(), totalText);
  const std::string tail =
      secondsLeft ? fmt::format("   {} left", formatSeconds(*secondsLeft)) : "";
  const std::size_t taken = head.size() + tail.size();
  return head + std::string(label.substr(0, columns - std::min(columns, taken))) + tail;
}

bool isTerminal(std::FILE* file) {
  return isatty(fileno(file)) == 1;
}

void Progress::show(std::size_t done, std::string_view label, std::optional<double> secondsLeft) {
  if (!enabled_) return;
  clear();
  // A terminal wraps once its last column is written.
  const std::size_t columns = terminalColumns(out_) - 1;
  fmt::print(out_, "{}", progressLine(done, total_, label, secondsLeft, columns));
  std::fflush(out_);
  shown_ = true;
}

void Progress::clear() {
  if (!shown_) return;
  // Go to the first column and erase to the end of the line.
  fmt::print(out_, "\r\x1b[K");
  std::fflush(out_);
  shown_ = false;
}

}  // namespace oitlab
