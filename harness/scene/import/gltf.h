#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Reads a glTF 2.0 file (.glb or .gltf) through tinygltf: the triangles of its scene with base
/// colour and alpha, and its cameras as views. Primitive ids follow the file: nodes depth first,
/// then primitives, then triangles. Faults that can be repaired are, and are counted in
/// Scene::repairs. For others it throws InputError with file and place. loadScene() adds the bounds
/// and the default view.
///
/// KHR_materials_transmission becomes opacity: baseColor.a is multiplied by 1 - transmissionFactor.
/// Thus a clear pane is invisible, unless there is an opacity override. The material becomes BLEND.
/// A MASK material keeps its cut-out: its cutoff is scaled by the same factor.
Scene loadGltf(const std::filesystem::path& path);

}  // namespace oitlab
