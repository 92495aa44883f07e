#include <algorithm>
#include <cstring>
#include <span>

#include "scene/import/gltf_parts.h"
#include "util/error.h"

namespace oitlab {
namespace {

template <typename T>
T load(const unsigned char* from) {
  T value;  // copied, because a faulty file may not be aligned
  std::memcpy(&value, from, sizeof value);
  return value;
}

// Normalised integers as floats: glTF 2.0, section 3.6.2.2.
template <typename T>
float loadInteger(const unsigned char* from, bool normalize) {
  const float value = float(load<T>(from));
  return normalize ? std::max(value / float(std::numeric_limits<T>::max()), -1.0f) : value;
}

}  // namespace

std::span<const unsigned char> gltfBytes(const GltfFile& file, int bufferView,
                                         const std::string& place) {
  const auto& views = file.model.bufferViews;
  if (bufferView < 0 || std::size_t(bufferView) >= views.size())
    fail<InputError>("{}: buffer view {} does not exist, the file has {}", place, bufferView,
                     views.size());
  const tinygltf::BufferView& view = views[std::size_t(bufferView)];
  const auto& buffers = file.model.buffers;
  if (view.buffer < 0 || std::size_t(view.buffer) >= buffers.size())
    fail<InputError>("{}: buffer {} does not exist, the file has {}", place, view.buffer,
                     buffers.size());
  const std::vector<unsigned char>& data = buffers[std::size_t(view.buffer)].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    fail<InputError>("{}: buffer view {} has {} bytes from offset {}, but its buffer only {} bytes",
                     place, bufferView, view.byteLength, view.byteOffset, data.size());
  return {data.data() + view.byteOffset, view.byteLength};
}

GltfAccessor::GltfAccessor(const GltfFile& file, int index, const std::string& place)
    : place_(place) {
  const auto& accessors = file.model.accessors;
  if (index < 0 || std::size_t(index) >= accessors.size())
    fail<InputError>("{}: accessor {} does not exist, the file has {}", place, index,
                     accessors.size());
  const tinygltf::Accessor& accessor = accessors[std::size_t(index)];
  if (accessor.sparse.isSparse)
    fail<InputError>("{}: accessor {} is sparse, which oitlab cannot read", place, index);
  const int bytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType));
  components_ = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type));
  if (bytes <= 0 || components_ <= 0)
    fail<InputError>("{}: accessor {} has component type {} and type {}, which glTF does not know",
                     place, index, accessor.componentType, accessor.type);
  componentType_ = accessor.componentType;
  normalized_ = accessor.normalized;
  count_ = accessor.count;
  if (count_ > 0xfffffff0u)
    fail<InputError>("{}: accessor {} has {} elements, expected less than 2^32", place, index,
                     count_);
  const std::span<const unsigned char> view = gltfBytes(file, accessor.bufferView, place);
  const std::size_t element = std::size_t(bytes) * std::size_t(components_);
  const std::size_t stride = file.model.bufferViews[std::size_t(accessor.bufferView)].byteStride;
  stride_ = stride == 0 ? element : stride;
  // In this order nothing overflows: in a valid file count is below 2^32 and stride below 2^8.
  const std::size_t available =
      accessor.byteOffset <= view.size() ? view.size() - accessor.byteOffset : 0;
  if (count_ > 0 && (available < element || (count_ - 1) > (available - element) / stride_))
    fail<InputError>(
        "{}: accessor {} needs {} elements of {} bytes, {} bytes apart, from offset {}, but its "
        "buffer view has {} bytes",
        place, index, count_, element, stride_, accessor.byteOffset, view.size());
  data_ = view.data() + (count_ > 0 ? accessor.byteOffset : 0);
}

float GltfAccessor::number(std::size_t element, int component, bool normalize) const {
  const unsigned char* at = data_ + element * stride_;
  const bool scaled = normalized_ || normalize;
  switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
      return load<float>(at + 4 * component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return loadInteger<std::uint8_t>(at + component, scaled);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return loadInteger<std::uint16_t>(at + 2 * component, scaled);
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return loadInteger<std::int8_t>(at + component, scaled);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return loadInteger<std::int16_t>(at + 2 * component, scaled);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return float(load<std::uint32_t>(at + 4 * component));
    case TINYGLTF_COMPONENT_TYPE_INT:
      return float(load<std::int32_t>(at + 4 * component));
    default:  // TINYGLTF_COMPONENT_TYPE_DOUBLE, which only tinygltf knows
      return float(load<double>(at + 8 * component));
  }
}

std::vector<std::uint32_t> GltfAccessor::indices(std::size_t limit) const {
  std::vector<std::uint32_t> result(count_);
  const auto read = [&]<typename T>(T) {
    for (std::size_t i = 0; i < count_; ++i) result[i] = load<T>(data_ + i * stride_);
  };
  if (components_ != 1) fail<InputError>("{}: indices are vectors, expected scalars", place_);
  switch (componentType_) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      read(std::uint8_t{});
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      read(std::uint16_t{});
      break;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      read(std::uint32_t{});
      break;
    default:
      fail<InputError>("{}: indices have component type {}, expected unsigned byte, short or int",
                       place_, componentType_);
  }
  for (std::size_t i = 0; i < count_; ++i)
    if (result[i] >= limit)
      fail<InputError>("{}: index {} is {}, but there are {} vertices", place_, i, result[i],
                       limit);
  return result;
}

}  // namespace oitlab
