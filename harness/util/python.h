#pragma once

#include <optional>
#include <string>
#include <vector>

namespace oitlab {

/// A Python that can import all of `modules`. The first `python3` of the path may be one of the
/// user's own without them, although the system's has them: both are tried, unless OITLAB_PYTHON
/// names the one to use. Says on stderr when it is not the first. Nothing when there is none.
std::optional<std::string> findPython(const std::vector<std::string>& modules);

/// What findPython() tries, in its order.
std::vector<std::string> pythonCandidates();

/// Runs `python -m oitlab_analysis arguments...` with the package of this source tree and its
/// output as ours; its exit code, or 127 when it cannot be run.
int runAnalysis(const std::string& python, const std::vector<std::string>& arguments);

}  // namespace oitlab
