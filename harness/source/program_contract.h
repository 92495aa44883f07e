#pragma once

#include <string>

#include "source/fragment_program.h"
#include "util/error.h"

namespace oitlab {

/// Throws InputError if the compiler's message for the source's shader is about the source but the
/// program is the reason. If it lacks a function that its access needs
/// (shaders/source/fragment.glsl), one line says which.
void explain(const FragmentProgram& program, const std::string& message);

/// Calls `make`, which compiles the program. Throws InputError when it does not compile.
template <typename Make>
auto makeProgram(const FragmentProgram& program, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    explain(program, error.what());
    throw;
  }
}

}  // namespace oitlab
