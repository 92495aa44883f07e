#include "util/suggest.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace oitlab {
namespace {

std::string lowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

/// The optimal string alignment distance: insertions, deletions, substitutions and swaps of
/// neighbours cost 1 each. Swaps are common typing errors, so they must not count as two.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> beforeLast(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    beforeLast.swap(last);
    last.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, substitution});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], beforeLast[j - 2] + 1);
    }
  }
  return row[b.size()];
}

/// Whether it is an abbreviation. A single letter is too short to guess from.
bool abbreviates(const std::string& shorter, const std::string& whole) {
  return shorter.size() >= 2 && whole.size() > shorter.size() && whole.starts_with(shorter);
}

}  // namespace

std::string didYouMean(std::string_view found, const std::vector<std::string>& candidates) {
  const std::string lowerFound = lowerCase(found);
  const std::size_t slipLimit = std::max<std::size_t>(1, lowerFound.size() / 3);
  const std::string* closestSlip = nullptr;
  const std::string* shortestWhole = nullptr;
  std::size_t closestDistance = slipLimit + 1;
  for (const std::string& candidate : candidates) {
    const std::string lowerCandidate = lowerCase(candidate);
    const std::size_t distance = editDistance(lowerFound, lowerCandidate);
    // If the distance is the length of the word no letter is the same: it is another word.
    const bool sharesLetters = distance < std::max(lowerFound.size(), lowerCandidate.size());
    if (sharesLetters && distance < closestDistance) {
      closestDistance = distance;
      closestSlip = &candidate;
    }
    if (abbreviates(lowerFound, lowerCandidate) &&
        (!shortestWhole || candidate.size() < shortestWhole->size()))
      shortestWhole = &candidate;
  }
  const std::string* best = closestSlip ? closestSlip : shortestWhole;
  return best ? fmt::format(" (did you mean '{}'?)", *best) : "";
}

std::string joinNames(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace oitlab
