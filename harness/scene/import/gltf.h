#pragma once

#include <filesystem>

#include "scene/import/scene_folder.h"
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
///
/// Buffers and images are read from regular files in the folder of `path`, and with `allowOutside`
/// from others too; a file that names another one is refused (SceneFolder).
Scene loadGltf(const std::filesystem::path& path, bool allowOutside = false);

/// Asks `folder` for every file that the glTF file `path` names, without decoding images. Throws
/// InputError as loadGltf() does.
void findGltfFiles(const std::filesystem::path& path, SceneFolder& folder);

}  // namespace oitlab
