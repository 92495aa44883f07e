#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace oitlab {

/// " (did you mean 'x'?)" for the candidate closest to `found` by edit distance, when it is close
/// enough to be a slip (at most a third of the letters, at least one); else "".
std::string didYouMean(std::string_view found, const std::vector<std::string>& candidates);

/// "a, b, c" for messages.
std::string joinNames(const std::vector<std::string>& names);

}  // namespace oitlab
