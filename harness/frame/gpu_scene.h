#pragma once

#include <optional>

#include "gpu/gpu_image.h"
#include "scene/scene.h"

namespace oitlab {

/// A scene in device memory, split into the triangles that the opaque pass draws and those that
/// methods blend.
class GpuScene {
 public:
  /// Uploads `scene`, which must outlive this. With `shuffleSeed` the triangles are submitted in a
  /// random order and keep their primitive ids: the image of an exact method must not change.
  GpuScene(const Device& device, const Scene& scene, std::optional<std::uint64_t> shuffleSeed = {});

  const Scene& scene() const { return scene_; }
  const MemoryLedger& memory() const { return memory_; }
  std::uint32_t opaqueCount() const { return opaqueCount_; }            ///< triangles
  std::uint32_t transparentCount() const { return transparentCount_; }  ///< triangles

  const Buffer& vertices() const { return vertices_; }
  const Buffer& materials() const { return materials_; }
  const Buffer& opaqueIndices() const { return opaqueIndices_; }
  const Buffer& transparentIndices() const { return transparentIndices_; }
  const Buffer& transparentIds() const { return transparentIds_; }
  const GpuImage& opaqueAtlas() const { return opaqueAtlas_; }
  const GpuImage& transparentAtlas() const { return transparentAtlas_; }

  /// Primitive ids of the transparent triangles in submission order.
  const std::vector<std::uint32_t>& submission() const { return submission_; }

 private:
  const Scene& scene_;
  MemoryLedger memory_;
  std::uint32_t opaqueCount_ = 0, transparentCount_ = 0;
  std::vector<std::uint32_t> submission_;
  Buffer vertices_, materials_, opaqueIndices_, transparentIndices_, transparentIds_;
  GpuImage opaqueAtlas_, transparentAtlas_;
};

}  // namespace oitlab
