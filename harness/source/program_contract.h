#pragma once

#include <string>

#include "source/fragment_program.h"
#include "util/error.h"

namespace oitlab {

/// What a program lacks of the functions that its access needs (shaders/source/fragment.glsl): its
/// declaration. `message` is that of the compiler for the source's shader. Empty if the message has
/// another reason.
std::string missingFunction(const FragmentProgram& program, const std::string& message);

/// Calls `make`, which compiles the program. Throws InputError, which says in one line what the
/// program lacks; other errors pass.
template <typename Make>
auto makeProgram(const FragmentProgram& program, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    const std::string missing = missingFunction(program, error.what());
    if (missing.empty()) throw;
    fail<InputError>(
        "shaders/{}: has no {}; its access needs it, as shaders/source/fragment.glsl says",
        program.file, missing);
  }
}

}  // namespace oitlab
