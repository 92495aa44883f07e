#pragma once

#include "frame/target.h"
#include "source/fragment_program.h"

namespace oitlab {

/// The macros that every source defines for a program: its own, FRAGMENT_PROGRAM, ACCESS, and for
/// blended ones CONTRIBUTIONS, OPERATIONS, INITIAL_SUMS, ON_TARGET.
Defines programDefines(const FragmentProgram& program);

}  // namespace oitlab
