#pragma once

#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace oitlab {

/// The key of a pipeline in a PipelineCache: the bytes of everything that the pipeline is made
/// from.
class PipelineKey {
 public:
  template <typename T>
  PipelineKey& add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T>);
    return append(std::as_bytes(std::span(&value, 1)));
  }
  template <typename T>
  PipelineKey& add(const std::vector<T>& values) {
    static_assert(std::has_unique_object_representations_v<T>);
    add(values.size());
    return append(std::as_bytes(std::span(values)));
  }
  std::string hash() const;

 private:
  PipelineKey& append(std::span<const std::byte> bytes) {
    text_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return *this;
  }
  std::string text_;
};

/// The pipelines of a device, in memory: the driver compiles a method's shaders once, although a
/// method is made anew for each scene. Nothing is stored on disk, where drivers have their own
/// caches.
class PipelineCache {
 public:
  /// The pipeline with this key. If there is none yet, it is the one that `make()` returns. Throws
  /// what `make` throws.
  template <typename Make>
  vk::Pipeline findOrMake(const PipelineKey& key, Make&& make) {
    const std::string hash = key.hash();
    auto found = pipelines_.find(hash);
    if (found == pipelines_.end()) found = pipelines_.emplace(hash, make()).first;
    return *found->second;
  }

  std::size_t size() const { return pipelines_.size(); }

 private:
  std::map<std::string, vk::raii::Pipeline> pipelines_;
};

}  // namespace oitlab
