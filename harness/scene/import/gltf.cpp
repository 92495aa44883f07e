#include "scene/import/gltf.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <fstream>
#include <set>

#include <glm/gtc/quaternion.hpp>

#include "scene/import/gltf_parts.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

std::vector<unsigned char> readBytes(const std::filesystem::path& path) {
  checkRegularFile(path);
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  if (!stream) fail<InputError>("{}: cannot be opened for reading", path.string());
  const auto size = stream.tellg();
  if (size < 0 || std::uint64_t(size) > 0xffffffffu)
    fail<InputError>("{}: has {} bytes, expected at most 4 GiB", path.string(), std::int64_t(size));
  std::vector<unsigned char> bytes(std::size_t(size), 0);
  stream.seekg(0);
  if (!stream.read(reinterpret_cast<char*>(bytes.data()), size))
    fail<InputError>("{}: cannot be read", path.string());
  return bytes;
}

// Leaves images encoded, because only those that a base colour uses are decoded later. An image in
// a buffer view is read through the view later, because its range is not checked yet.
bool keepEncoded(tinygltf::Image* image, int, std::string*, std::string*, int, int,
                 const unsigned char* bytes, int size, void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

std::string firstLine(std::string text) {
  text.resize(std::min(text.find('\n'), text.size()));
  return text.empty() ? "not a glTF 2.0 file" : text;
}

/// How tinygltf reads the files that a glTF file names. An exception must not pass through
/// tinygltf's functions as another one, so the first is kept.
struct FileReader {
  SceneFolder& folder;
  std::exception_ptr refusal;

  std::filesystem::path find(const std::string& name) {
    try {
      return folder.find(name);
    } catch (const InputError&) {
      if (!refusal) refusal = std::current_exception();
      return {};
    }
  }
  bool read(const std::string& name, std::vector<unsigned char>* bytes, std::string* error) {
    try {
      *bytes = readBytes(find(name));
      return true;
    } catch (const InputError& unreadable) {
      *error = unreadable.what();
      return false;
    }
  }
};

/// Sets what tinygltf's newer versions ask for before they read a file; older ones lack the field.
template <typename Callbacks>
void setFileSize(Callbacks& callbacks) {
  if constexpr (requires { callbacks.GetFileSizeInBytes; })
    callbacks.GetFileSizeInBytes = [](std::size_t* size, std::string*, const std::string& name,
                                      void* reader) {
      std::error_code missing;
      const auto path = static_cast<FileReader*>(reader)->find(name);
      *size = std::size_t(std::filesystem::file_size(path, missing));
      return !missing;
    };
}

tinygltf::FsCallbacks callbacksOf(FileReader& reader) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.FileExists = [](const std::string& name, void* to) {
    return !static_cast<FileReader*>(to)->find(name).empty();
  };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* error,
                               const std::string& name, void* to) {
    return static_cast<FileReader*>(to)->read(name, bytes, error);
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                                void*) { return false; };
  setFileSize(callbacks);
  callbacks.user_data = &reader;
  return callbacks;
}

void parse(const std::filesystem::path& path, SceneFolder& folder, GltfFile& file) {
  const std::vector<unsigned char> bytes = readBytes(path);
  const bool binary = bytes.size() >= 4 && std::equal(bytes.begin(), bytes.begin() + 4, "glTF");
  tinygltf::TinyGLTF reader;
  reader.SetImageLoader(keepEncoded, nullptr);
  FileReader files{folder, nullptr};
  reader.SetFsCallbacks(callbacksOf(files));
  std::string error, ignored;
  const std::string base;  // empty: names come to the callbacks as they are in the file
  const auto size = static_cast<unsigned>(bytes.size());
  bool good = false;
  try {
    good =
        binary
            ? reader.LoadBinaryFromMemory(&file.model, &error, &ignored, bytes.data(), size, base)
            : reader.LoadASCIIFromString(&file.model, &error, &ignored,
                                         reinterpret_cast<const char*>(bytes.data()), size, base);
  } catch (const std::exception& exception) {  // faults that tinygltf's own checks miss
    error = exception.what();
  }
  if (files.refusal) std::rethrow_exception(files.refusal);
  if (!good) fail<InputError>("{}: {}", file.path, firstLine(error));

  for (const std::string& name : file.model.extensionsRequired)
    if (name != "KHR_mesh_quantization" && name != "KHR_texture_transform" &&
        name != "KHR_lights_punctual" && !name.starts_with("KHR_materials_"))
      fail<InputError>("{}: needs the extension {}, which oitlab cannot read", file.path, name);
}

glm::dmat4 localMatrix(const tinygltf::Node& node) {
  glm::dmat4 local(1.0);
  if (node.matrix.size() == 16) {
    for (int i = 0; i < 16; ++i) local[i / 4][i % 4] = node.matrix[std::size_t(i)];
    return local;
  }
  if (node.rotation.size() == 4) {
    const glm::dquat turn(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (glm::length(turn) > 0.0) local = glm::mat4_cast(glm::normalize(turn));
  }
  for (int i = 0; i < 3; ++i) {
    if (node.scale.size() == 3) local[i] *= node.scale[std::size_t(i)];
    if (node.translation.size() == 3) local[3][i] = node.translation[std::size_t(i)];
  }
  return local;
}

// A camera looks down -Z of its node. The distance of its target does not change the image.
void addView(const GltfFile& file, const tinygltf::Node& node, const glm::dmat4& world,
             Scene& scene) {
  if (std::size_t(node.camera) >= file.model.cameras.size())
    return scene.repaired("cameras that do not exist skipped");
  const tinygltf::Camera& from = file.model.cameras[std::size_t(node.camera)];
  const Camera camera{.eye = glm::vec3(world[3]),
                      .target = glm::vec3(world[3] - glm::normalize(world[2])),
                      .up = glm::vec3(glm::normalize(world[1])),
                      .fovY = float(from.perspective.yfov),
                      .near = float(from.perspective.znear)};
  const auto finite = [](glm::vec3 v) { return std::isfinite(v.x + v.y + v.z); };
  if (from.type != "perspective") return scene.repaired("orthographic cameras skipped");
  if (!finite(camera.eye) || !finite(camera.target) || !finite(camera.up) ||
      camera.eye == camera.target || !(camera.fovY > 0.0f && camera.fovY < 3.1415926f) ||
      !(camera.near > 0.0f && std::isfinite(camera.near)))
    return scene.repaired("cameras with unusable values skipped");
  const std::string wanted = !from.name.empty()   ? from.name
                             : !node.name.empty() ? node.name
                                                  : fmt::format("camera{}", node.camera);
  std::string name = wanted;
  for (int i = 2; scene.views.contains(name); ++i) name = fmt::format("{}-{}", wanted, i);
  scene.views[name] = camera;
}

void addMesh(const GltfFile& file, const tinygltf::Node& node, const glm::dmat4& world,
             const std::vector<GltfMaterial>& materials, Scene& scene) {
  if (std::size_t(node.mesh) >= file.model.meshes.size())
    fail<InputError>("{}: node '{}': mesh {} does not exist, the file has {}", file.path, node.name,
                     node.mesh, file.model.meshes.size());
  const tinygltf::Mesh& mesh = file.model.meshes[std::size_t(node.mesh)];
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = mesh.primitives[i];
    const std::string place =
        fmt::format("{}: mesh {} '{}', primitive {}", file.path, node.mesh, mesh.name, i);
    // The last of `materials` is for primitives without a material.
    if (primitive.material >= int(materials.size()) - 1)
      fail<InputError>("{}: material {} does not exist, the file has {}", place, primitive.material,
                       materials.size() - 1);
    const auto material =
        primitive.material >= 0 ? std::size_t(primitive.material) : materials.size() - 1;
    readGltfPrimitive(file, primitive, world, materials[material], place, scene);
  }
}

// The root nodes: those of the file's scene or, in a file without scenes, all nodes without a
// parent.
std::vector<int> rootNodes(const tinygltf::Model& model) {
  if (!model.scenes.empty()) {
    const bool named =
        model.defaultScene >= 0 && std::size_t(model.defaultScene) < model.scenes.size();
    return model.scenes[named ? std::size_t(model.defaultScene) : 0].nodes;
  }
  std::set<int> children;
  for (const tinygltf::Node& node : model.nodes)
    children.insert(node.children.begin(), node.children.end());
  std::vector<int> roots;
  for (int i = 0; i < int(model.nodes.size()); ++i)
    if (!children.contains(i)) roots.push_back(i);
  return roots;
}

void addNodes(const GltfFile& file, const std::vector<GltfMaterial>& materials, Scene& scene) {
  struct Visit {
    int node;
    glm::dmat4 parent;
  };
  // An explicit stack, because a file may nest nodes deeper than the program's stack allows.
  std::vector<Visit> stack;
  const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack.push_back({*node, parent});
  };
  std::vector<bool> seen(file.model.nodes.size());
  push(rootNodes(file.model), glm::dmat4(1.0));
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    if (visit.node < 0 || std::size_t(visit.node) >= seen.size())
      fail<InputError>("{}: node {} does not exist, the file has {}", file.path, visit.node,
                       seen.size());
    if (seen[std::size_t(visit.node)])
      fail<InputError>("{}: node {} is reached twice, expected a tree", file.path, visit.node);
    seen[std::size_t(visit.node)] = true;
    const tinygltf::Node& node = file.model.nodes[std::size_t(visit.node)];
    const glm::dmat4 world = visit.parent * localMatrix(node);
    if (node.mesh >= 0) addMesh(file, node, world, materials, scene);
    if (node.camera >= 0) addView(file, node, world, scene);
    push(node.children, world);
  }
}

}  // namespace

void findGltfFiles(const std::filesystem::path& path, SceneFolder& folder) {
  SceneBudget budget(path.string());
  GltfFile file{.path = path.string(), .budget = budget, .model = {}};
  parse(path, folder, file);
}

Scene loadGltf(const std::filesystem::path& path, bool allowOutside) {
  SceneBudget budget(path.string());
  GltfFile file{.path = path.string(), .budget = budget, .model = {}};
  SceneFolder folder(path, allowOutside);
  parse(path, folder, file);
  Scene scene;
  scene.name = path.stem().string();
  const std::vector<GltfMaterial> materials = readGltfMaterials(file, scene);
  addNodes(file, materials, scene);
  if (scene.triangles.empty()) {
    std::string repairs;
    for (const Repair& repair : scene.repairs)
      repairs += fmt::format("; {}: {}", repair.what, repair.count);
    fail<InputError>("{}: its scene has no triangles{}", file.path, repairs);
  }
  return scene;
}

}  // namespace oitlab
