#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Reads a glTF 2.0 file (.glb or .gltf) through tinygltf: the triangles of its scene with base
/// colour, alpha and cameras (as views). Primitive ids follow the file: nodes depth first,
/// primitives, triangles. What can be mended is, and is counted in Scene::repairs; for the rest
/// InputError, naming file and place. Bounds and the default view are left to loadScene().
///
/// KHR_materials_transmission becomes opacity: baseColor.a is scaled by 1 - transmissionFactor,
/// exactly, so that a clear pane is invisible (an opacity override makes it seen). The material
/// becomes BLEND; a MASK one keeps its cut-out, its cutoff scaled alike.
Scene loadGltf(const std::filesystem::path& path);

}  // namespace oitlab
