#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace oitlab {

/// Writes small GLB files, valid or not: `json` may be changed in any way before write().
class GlbBuilder {
 public:
  enum Type { byte = 5120, ubyte = 5121, ushort = 5123, uint = 5125, real = 5126 };

  nlohmann::json json{{"asset", {{"version", "2.0"}}}, {"scene", 0}};

  GlbBuilder() { json["scenes"] = {{{"nodes", nlohmann::json::array()}}}; }

  int bufferView(const void* data, std::size_t size) {
    while (bin_.size() % 4 != 0) bin_.push_back(0);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bin_.size()}, {"byteLength", size}});
    bin_.insert(bin_.end(), static_cast<const char*>(data), static_cast<const char*>(data) + size);
    return int(json["bufferViews"].size()) - 1;
  }

  /// `type` is "SCALAR", "VEC2", "VEC3", "VEC4"; T matches `component`.
  template <typename T>
  int accessor(const std::vector<T>& data, Type component, const char* type,
               bool normalized = false) {
    const std::size_t width = type[0] == 'S' ? 1 : std::size_t(type[3] - '0');
    const int view = bufferView(data.data(), data.size() * sizeof(T));
    json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", int(component)},
                                 {"count", data.size() / width},
                                 {"type", type},
                                 {"normalized", normalized}});
    return int(json["accessors"].size()) - 1;
  }

  int positions(const std::vector<float>& xyz) { return accessor(xyz, real, "VEC3"); }

  /// Adds a mesh of one primitive and returns it. `extra` has indices, material and mode.
  int mesh(const nlohmann::json& attributes,
           const nlohmann::json& extra = nlohmann::json::object()) {
    nlohmann::json primitive = extra;
    primitive["attributes"] = attributes;
    json["meshes"].push_back({{"name", "m"}, {"primitives", {primitive}}});
    return int(json["meshes"].size()) - 1;
  }

  /// Adds a node. It is in the scene unless it is a child of another node.
  int node(const nlohmann::json& node, bool inScene = true) {
    json["nodes"].push_back(node);
    const int index = int(json["nodes"].size()) - 1;
    if (inScene) json["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::string bytes() {
    while (bin_.size() % 4 != 0) bin_.push_back(0);
    if (!bin_.empty() && !json.contains("buffers"))
      json["buffers"] = {{{"byteLength", bin_.size()}}};
    std::string text = json.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::string file = "glTF" + word(2) +
                       word(12 + 8 + text.size() + (bin_.empty() ? 0 : 8 + bin_.size())) +
                       word(text.size()) + "JSON" + text;
    if (!bin_.empty())
      file += word(bin_.size()) + std::string("BIN\0", 4) + std::string(bin_.data(), bin_.size());
    return file;
  }

  std::string write(const std::filesystem::path& path) { return writeFile(path, bytes()); }

  static std::string writeFile(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

 private:
  static std::string word(std::size_t value) {
    const auto number = std::uint32_t(value);
    std::string text(4, '\0');
    std::memcpy(text.data(), &number, 4);
    return text;
  }

  std::vector<char> bin_;
};

}  // namespace oitlab
