#pragma once

#include <filesystem>

#include "scene/import/scene_folder.h"
#include "scene/scene.h"

namespace oitlab {

/// Reads a Wavefront OBJ file with its MTL libraries through tinyobjloader. It reads polygons as
/// fans of triangles (primitive ids in the file's order), normals, texture coordinates (flipped to
/// v down), and materials with Kd, d or Tr, map_Kd and map_d, whose red channel becomes the
/// texture's alpha. A material with d < 1 or a transparent texture is BLEND, any other is OPAQUE.
/// Textures are searched beside the MTL file. Faults that can be repaired are, and are counted in
/// Scene::repairs: missing libraries, materials and textures, non-finite numbers, polygons with
/// repeated corners. For an invalid index or number it throws InputError with file and line.
/// loadScene() adds the bounds and the default view.
///
/// Libraries and textures are read from regular files in the folder of `path`, and with
/// `allowOutside` from others too; a file that names another one is refused (SceneFolder).
Scene loadObj(const std::filesystem::path& path, bool allowOutside = false);

/// Asks `folder` for every file that the OBJ file `path` and its libraries name, without decoding
/// textures. Throws InputError as loadObj() does for files that are refused.
void findObjFiles(const std::filesystem::path& path, SceneFolder& folder);

}  // namespace oitlab
