#pragma once

#include <filesystem>

#include "scene/scene.h"

namespace oitlab {

/// Reads a Wavefront OBJ file with its MTL libraries through tinyobjloader: polygons as fans of
/// triangles (primitive ids in the file's order), normals, texture coordinates (turned to v down),
/// materials with Kd, d or Tr, map_Kd and map_d (its red channel becomes the texture's alpha). A
/// material with d < 1 or a transparent texture is BLEND, another OPAQUE. Textures are looked for
/// beside the MTL. What can be mended is, and is counted in Scene::repairs (missing libraries,
/// materials and textures, non-finite numbers, polygons of repeated corners); an index or number
/// that cannot be meant is an InputError, naming file and line. Bounds and the default view are
/// left to loadScene().
Scene loadObj(const std::filesystem::path& path);

}  // namespace oitlab
