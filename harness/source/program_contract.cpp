#include "source/program_contract.h"

#include <algorithm>

namespace oitlab {
namespace {

/// The declaration that the program lacks; empty if the first line of errors has another reason.
std::string missingDeclaration(const FragmentProgram& program, const std::string& line) {
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
      // An unknown type is a syntax error, which does not name it. The source has no other one.
      if (line.find("unexpected IDENTIFIER") != std::string::npos) return "struct PixelState";
      if (lacks("openPixel")) return "void openPixel(uvec2 pixel, out PixelState state)";
      if (lacks("addFragment")) return "bool addFragment(inout PixelState state, Fragment f)";
      if (lacks("closePixel")) return "bool closePixel(PixelState state, out vec4 color)";
      break;
  }
  return lacks("passRuns") ? "bool passRuns()" : "";
}

}  // namespace

void explain(const FragmentProgram& program, const std::string& message) {
  // The first error counts: later ones may follow from it. One in the program's own file says
  // enough.
  const std::string inSource = "ERROR: source/";
  const auto first = message.find("ERROR: ");
  if (first == std::string::npos || message.compare(first, inSource.size(), inSource) != 0) return;
  const std::string line = message.substr(first, message.find('\n', first) - first);
  if (const std::string missing = missingDeclaration(program, line); !missing.empty())
    fail<InputError>(
        "shaders/{}: has no {}; its access needs it, as shaders/source/fragment.glsl says",
        program.file, missing);
  fail<InputError>(
      "shaders/{}: the errors are behind its end; a bracket or a semicolon may be missing there, "
      "or a name may be one of the source's. {}",
      program.file, message);
}

}  // namespace oitlab
