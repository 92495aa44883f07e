#pragma once

#include <optional>
#include <string>
#include <vector>

namespace oitlab {

/// A Python that can import all of `modules`; empty when there is none. The first `python3` of the
/// path may be the user's own and lack them although the system's has them, so both are tried,
/// unless OITLAB_PYTHON names the one to use. Prints to stderr when it is not the first.
std::optional<std::string> findPython(const std::vector<std::string>& modules);

/// The candidates of findPython(), in order.
std::vector<std::string> pythonCandidates();

/// Runs `python -m oitlab_analysis arguments...` with the package of this source tree; its output
/// goes where ours does. Returns its exit code, or 127 when it cannot be run.
int runAnalysis(const std::string& python, const std::vector<std::string>& arguments);

}  // namespace oitlab
