#include "source/program_defines.h"

#include <fmt/format.h>

namespace oitlab {

Defines programDefines(const FragmentProgram& program) {
  Defines defines = program.defines;
  defines["FRAGMENT_PROGRAM"] = program.file;
  defines["ACCESS"] = std::to_string(int(program.access));
  if (program.isConditional) defines["PASS_CONDITION"] = "1";
  if (program.access != Access::blended) return defines;
  // No spaces in values: a variant's label is separated by them.
  std::string operations, initial;
  const auto add = [&](int operation, const glm::vec4& v) {
    const char* comma = operations.empty() ? "" : ",";
    operations += fmt::format("{}{}", comma, operation);
    initial += fmt::format("{}vec4({:.9g},{:.9g},{:.9g},{:.9g})", comma, v.x, v.y, v.z, v.w);
  };
  for (const FragmentSum& sum : program.sums) add(sum.operation, sum.initial);
  if (program.isOnTarget()) add(COMBINE_OVER, glm::vec4(0));
  defines["CONTRIBUTIONS"] = std::to_string(std::max<std::size_t>(program.sums.size(), 1));
  defines["OPERATIONS"] = operations;
  defines["INITIAL_SUMS"] = initial;
  defines["ON_TARGET"] = program.isOnTarget() ? "1" : "0";
  return defines;
}

}  // namespace oitlab
