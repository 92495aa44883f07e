#pragma once

#include "frame/gpu_scene.h"
#include "gpu/shader.h"

namespace oitlab::raster {

/// llvmpipe ends long loops early without an error. On it, shaders count their iterations.
bool verifiesLoops(const Device& device);

/// The macros that raster/fragments/team.glsl needs, for this device.
Defines teamDefines(const Device& device);

/// What a scene has, for raster/fragments/prepare.glsl and raster/triangles.glsl: HAS_OPAQUE,
/// HAS_UNSNAPPED, HAS_TEXTURES, HAS_GRADIENTS, HAS_ATTRIBUTES, HAS_SMOOTH. Shaders leave out the
/// code for the rest. `hasUnsnapped`: frames have triangles that cannot be snapped.
Defines sceneDefines(const GpuScene& scene, bool hasUnsnapped);

/// `first` and `more` together. Where both have a name, the value is that of `more`.
Defines with(Defines first, const Defines& more);

/// Those of `defines` that have one of `names`, which must all be there: pipelines that differ in
/// nothing are made once for all scenes.
Defines only(const Defines& defines, std::initializer_list<const char*> names);

}  // namespace oitlab::raster
