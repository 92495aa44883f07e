#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace oitlab {

/// " (did you mean 'x'?)" for the candidate with the smallest edit distance to `found`, if the
/// distance is at most a third of the letters of `found` (at least 1). Otherwise it is the shortest
/// candidate that starts with `found`, such as 'reference' for 'ref', or else "". The case of
/// letters does not matter, a swap of two neighbouring letters is one edit, and of equal candidates
/// the first is taken.
std::string didYouMean(std::string_view found, const std::vector<std::string>& candidates);

/// "a, b, c", for messages.
std::string joinNames(const std::vector<std::string>& names);

}  // namespace oitlab
