#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "gpu/pipeline.h"
#include "source/access.h"

namespace oitlab {

/// What a fragment program may do with a pixel (shaders/source/fragment.glsl).
enum class Access {
  none = ACCESS_NONE,           ///< it has its own buffers and atomics
  blended = ACCESS_BLENDED,     ///< it contributes to sums
  exclusive = ACCESS_EXCLUSIVE  ///< it keeps a state that one invocation at a time changes
};

/// One sum per pixel of a blended program.
struct FragmentSum {
  vk::Format format;      ///< of the image, where it lies in one; in registers it is float32
  glm::vec4 initial;      ///< without fragments
  int operation;          ///< COMBINE_ADD or COMBINE_ATTENUATE
  const char* name = "";  ///< of the image in the list of memory
};

/// What a method does with each transparent fragment, written once in GLSL, for any source.
struct FragmentProgram {
  std::string file;  ///< below shaders/
  Access access = Access::none;
  Defines defines = {};
  /// Of a blended program. Empty: it has one contribution, a straight colour that is put over the
  /// target itself (COMBINE_OVER), in the order in which fragments come.
  std::vector<FragmentSum> sums = {};
  /// Fragment::id is used. Hardware needs a feature for it (geometryShader).
  bool needsId = true;
  /// The program declares bool passRuns(): false in passes that have nothing to do. With hardware,
  /// FragmentRun::draw says the same.
  bool isConditional = false;
  /// Only with hardware, for programs without sums: the format and the operations of
  /// FragmentRun::depthStencil.
  vk::Format depthStencilFormat = vk::Format::eUndefined;
  vk::StencilOpState stencil = {};

  bool isOnTarget() const { return access == Access::blended && sums.empty(); }
  bool dependsOnOrder() const { return access == Access::exclusive || isOnTarget(); }
};

}  // namespace oitlab
