#pragma once

#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

namespace oitlab {

/// All that goes into a pipeline, byte by byte: its identity in a PipelineCache.
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

/// The pipelines of a device, in memory. A method that is made for one scene after another has its
/// shaders compiled by the driver once. Nothing of it is on disk: drivers keep caches of their own.
class PipelineCache {
 public:
  /// The pipeline of `key`; where there is none yet, what `make()` returns, which is kept. Passes
  /// on what `make` throws.
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
