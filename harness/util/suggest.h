#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace oitlab {

/// " (did you mean 'x'?)" for the candidate closest to `found` by edit distance, when it is close
/// enough to be a slip (at most a third of the letters of `found`, at least one); failing that, for
/// the shortest candidate that begins with `found` ('ref' -> 'reference'); else "". Upper and lower
/// case are the same, a swap of two neighbouring letters is one slip, the first of equals wins.
std::string didYouMean(std::string_view found, const std::vector<std::string>& candidates);

/// "a, b, c" for messages.
std::string joinNames(const std::vector<std::string>& names);

}  // namespace oitlab
