#include "frame/gpu_scene.h"

#include <numeric>

#include "scene/atlas.h"
#include "util/random.h"

namespace oitlab {
namespace {

/// Fisher-Yates with our own generator, because std::shuffle differs between standard libraries.
void shuffle(std::vector<std::uint32_t>& items, std::uint64_t seed) {
  Pcg32 random(seed);
  for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[random.next() % i]);
}

std::vector<std::uint32_t> indicesOf(const Scene& scene, const std::vector<std::uint32_t>& ids) {
  std::vector<std::uint32_t> indices;
  indices.reserve(ids.size() * 3);
  for (const std::uint32_t id : ids)
    for (int corner = 0; corner < 3; ++corner) indices.push_back(scene.triangles[id][corner]);
  return indices;
}

/// The atlas in device memory. Where a scene has no such textures it is a single white texel, so
/// that the descriptor is always valid.
GpuImage uploadAtlas(const Device& device, MemoryLedger& ledger, const Atlas& atlas,
                     const std::string& name) {
  GpuImage::Description description{
      name, vk::Format::eR8G8B8A8Srgb,
      1,    1,
      1,    vk::ImageUsageFlagBits::eSampled | vk::ImageUsageFlagBits::eTransferDst};
  std::vector<LevelData> levels;
  std::vector<std::vector<std::uint8_t>> decoded;
  const std::array<std::uint8_t, 4> white{255, 255, 255, 255};
  if (atlas.width == 0) {
    levels.push_back({0, 1, 1, std::as_bytes(std::span(white))});
  } else {
    const bool compressed = device.info().has("textureCompressionBC");
    description.width = std::uint32_t(atlas.width);
    description.height = std::uint32_t(atlas.height);
    description.levels = std::uint32_t(atlas.levels.size());
    if (compressed)
      description.format = atlas.alpha ? vk::Format::eBc3SrgbBlock : vk::Format::eBc1RgbSrgbBlock;
    // On devices without BC formats the same texels are uploaded decoded, so that images are equal.
    for (std::size_t i = 0; i < atlas.levels.size() && !compressed; ++i)
      decoded.push_back(decodeAtlasLevel(atlas, i));
    for (std::size_t i = 0; i < atlas.levels.size(); ++i) {
      const Atlas::Level& level = atlas.levels[i];
      levels.push_back({std::uint32_t(i), std::uint32_t(level.width), std::uint32_t(level.height),
                        std::as_bytes(std::span(compressed ? level.blocks : decoded[i]))});
    }
  }
  GpuImage image(device, ledger, description);
  uploadImage(device, image, levels);
  return image;
}

}  // namespace

GpuScene::GpuScene(const Device& device, const Scene& scene,
                   std::optional<std::uint64_t> shuffleSeed)
    : scene_(scene) {
  std::vector<std::uint32_t> opaque;
  for (std::uint32_t id = 0; id < scene.triangles.size(); ++id)
    (scene.alphaModeOf(scene.triangles[id]) == AlphaMode::blend ? submission_ : opaque)
        .push_back(id);
  if (shuffleSeed) {
    shuffle(opaque, *shuffleSeed);
    shuffle(submission_, *shuffleSeed + 1);
  }
  opaqueCount_ = std::uint32_t(opaque.size());
  transparentCount_ = std::uint32_t(submission_.size());

  const SceneAtlases atlases = buildAtlases(scene);
  opaqueAtlas_ = uploadAtlas(device, memory_, atlases.opaque, "opaque atlas");
  transparentAtlas_ = uploadAtlas(device, memory_, atlases.transparent, "transparent atlas");

  std::vector<GpuMaterial> materials;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    const AtlasPlacement& place = atlases.ofMaterial[i];
    materials.push_back({material.baseColor, place.rect, std::uint32_t(material.alphaMode),
                         material.alphaCutoff, place.atlas, material.ignoreVertexAlpha});
  }
  materials_ = uploadBuffer(device, memory_, "materials", materials);
  vertices_ = uploadBuffer(device, memory_, "vertices", scene.vertices);
  opaqueIndices_ = uploadBuffer(device, memory_, "opaque indices", indicesOf(scene, opaque));
  transparentIndices_ =
      uploadBuffer(device, memory_, "transparent indices", indicesOf(scene, submission_));
  transparentIds_ = uploadBuffer(device, memory_, "transparent ids", submission_);
}

}  // namespace oitlab
