#include "source/program_contract.h"

#include <algorithm>

namespace oitlab {

std::string missingFunction(const FragmentProgram& program, const std::string& message) {
  // The first error counts: later ones may follow from it. One in the program's own file says
  // enough.
  const std::string inSource = "ERROR: source/";
  const auto first = message.find("ERROR: ");
  if (first == std::string::npos || message.compare(first, inSource.size(), inSource) != 0)
    return "";
  const std::string line = message.substr(first, message.find('\n', first) - first);
  const auto lacks = [&](const char* name) {
    return line.find(fmt::format("'{}'", name)) != std::string::npos;
  };

  const std::size_t sums = std::max<std::size_t>(program.sums.size(), 1);
  switch (program.access) {
    case Access::none:
      if (lacks("fragment")) return "void fragment(Fragment f)";
      break;
    case Access::blended:
      if (lacks("contribute"))
        return fmt::format("bool contribute(Fragment f, out vec4 c[{}])", sums);
      if (lacks("composite"))
        return fmt::format("bool composite(vec4 sums[{}], out vec4 color)", sums);
      break;
    case Access::exclusive:
      // An unknown type is a syntax error, which does not name it; the source has no other such
      // type.
      if (line.find("unexpected IDENTIFIER") != std::string::npos) return "struct PixelState";
      if (lacks("openPixel")) return "void openPixel(uvec2 pixel, out PixelState state)";
      if (lacks("addFragment")) return "bool addFragment(inout PixelState state, Fragment f)";
      if (lacks("closePixel")) return "bool closePixel(PixelState state, out vec4 color)";
      break;
  }
  return lacks("passRuns") ? "bool passRuns()" : "";
}

}  // namespace oitlab
