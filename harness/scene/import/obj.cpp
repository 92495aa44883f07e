#include "scene/import/obj.h"

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <istream>
#include <optional>
#include <sstream>
#include <streambuf>
#include <tuple>
#include <unordered_map>

#include <tiny_obj_loader.h>

#include "scene/import/obj_material.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

constexpr float largest = 1e18f;  // as for glTF: the square of a larger length overflows

// Passes the file to tinyobjloader line by line, so that its callbacks know the line number. Checks
// the numbers of each line first, because tinyobjloader reads a number that it does not understand
// as 0.
class LineBuffer : public std::streambuf {
 public:
  LineBuffer(std::istream& stream, std::string path) : stream_(stream), path_(std::move(path)) {}

  int line() const { return line_; }
  bool finite() const { return finite_; }
  std::string place() const { return fmt::format("{}:{}", path_, line_); }

 protected:
  int_type underflow() override {
    if (!std::getline(stream_, text_)) return traits_type::eof();
    ++line_;
    if (!text_.empty() && text_.back() == '\r') text_.pop_back();
    // With a carriage return or NUL inside a line the parser would count other lines than we do.
    for (char& c : text_)
      if (c == '\r' || c == '\0') c = ' ';
    checkNumbers();
    text_ += '\n';
    setg(text_.data(), text_.data(), text_.data() + text_.size());
    return traits_type::to_int_type(text_[0]);
  }

 private:
  void checkNumbers() {
    finite_ = true;
    const char* at = text_.c_str() + std::min(text_.find_first_not_of(" \t"), text_.size());
    const auto space = [](char c) { return c == ' ' || c == '\t'; };
    if (at[0] != 'v') return;
    const std::string_view kind = space(at[1]) ? "v"
                                  : (at[1] == 'n' || at[1] == 't') && space(at[2])
                                      ? std::string_view(at, 2)
                                      : "";
    if (kind.empty()) return;
    at += kind.size();
    const int least = kind == "vt" ? 1 : 3;
    int count = 0;
    for (;; ++count) {
      while (space(*at)) ++at;
      if (*at == '\0' || *at == '#') break;
      char* end = nullptr;
      const float value = std::strtof(at, &end);
      if (end == at || !(space(*end) || *end == '\0'))
        fail<InputError>("{}: '{}' is not a number", place(),
                         std::string(at, std::strcspn(at, " \t")));
      if (count < 3 && !(std::abs(value) < largest)) finite_ = false;
      at = end;
    }
    if (count < least)
      fail<InputError>("{}: '{}' has {} numbers, expected at least {}", place(), kind, count,
                       least);
  }

  std::istream& stream_;
  std::string path_, text_;
  int line_ = 0;
  bool finite_ = true;
};

struct Corner {
  int position, uv, normal;  // -1 for none
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    return (std::size_t(c.position) * 73856093u) ^ (std::size_t(c.uv) * 19349663u) ^
           (std::size_t(c.normal) * 83492791u);
  }
};

class Reader {
 public:
  Reader(Scene& scene, LineBuffer& lines, SceneFolder& folder, SceneBudget& budget)
      : scene_(scene), lines_(lines), budget_(budget), materials_(scene, folder, budget) {}

  void addPosition(glm::vec3 p) {
    positions_.push_back(lines_.finite() ? p : glm::vec3(std::nanf("")));
  }
  void addNormal(glm::vec3 n) { normals_.push_back(lines_.finite() ? n : glm::vec3(0.0f)); }
  void addUv(glm::vec2 uv) {
    if (!lines_.finite()) scene_.repaired("non-finite texture coordinates set to 0");
    uvs_.push_back(lines_.finite() ? uv : glm::vec2(0.0f));
  }
  void useMaterial(std::string name) {
    while (!name.empty() && std::isspace(static_cast<unsigned char>(name.back()))) name.pop_back();
    wanted_ = std::move(name);
    material_.reset();
  }
  void readLibrary(const std::string& name) { materials_.readLibrary(name); }

  void addFace(const tinyobj::index_t* from, int count) {
    if (count < 3) return scene_.repaired("faces of fewer than three corners skipped");
    std::vector<Corner> corners;
    for (int i = 0; i < count; ++i)
      corners.push_back({index(from[i].vertex_index, positions_.size(), "position", true),
                         index(from[i].texcoord_index, uvs_.size(), "texture coordinate", false),
                         index(from[i].normal_index, normals_.size(), "normal", false)});
    for (int i = 1; i + 1 < count; ++i)
      addTriangle(corners[0], corners[std::size_t(i)], corners[std::size_t(i) + 1]);
  }

 private:
  // OBJ counts from 1, and backwards from -1. tinyobjloader gives 0 for a missing or invalid index.
  int index(int raw, std::size_t size, const char* what, bool needed) const {
    if (raw == 0 && !needed) return -1;
    const std::int64_t found = raw > 0 ? std::int64_t(raw) - 1 : std::int64_t(size) + raw;
    if (raw == 0 || found < 0 || found >= std::int64_t(size))
      fail<InputError>("{}: {} {} does not exist, {} were given before", lines_.place(), what, raw,
                       size);
    return int(found);
  }

  void addTriangle(const Corner& a, const Corner& b, const Corner& c) {
    const glm::vec3 p = at(a), q = at(b), r = at(c);
    if (!std::isfinite(p.x + q.x + r.x))
      return scene_.repaired("triangles with non-finite positions dropped");
    if (a.position == b.position || b.position == c.position || c.position == a.position)
      return scene_.repaired("triangles that repeat a corner dropped");
    if (!material_) {
      material_ = materials_.find(wanted_);
      known_.clear();  // materials do not share vertices
    }
    const glm::dvec3 cross =
        glm::cross(glm::dvec3(q) - glm::dvec3(p), glm::dvec3(r) - glm::dvec3(p));
    const double length = glm::length(cross);
    budget_.addVertices(0, 1, "this file");
    const glm::vec3 flat = length > 0.0 ? glm::vec3(cross / length) : glm::vec3(0, 1, 0);
    scene_.triangles.emplace_back(vertex(a, flat), vertex(b, flat), vertex(c, flat));
  }

  glm::vec3 at(const Corner& c) const { return positions_[std::size_t(c.position)]; }

  std::uint32_t vertex(const Corner& corner, glm::vec3 flat) {
    if (corner.normal >= 0)
      if (const auto known = known_.find(corner); known != known_.end()) return known->second;
    glm::vec3 normal = flat;
    if (corner.normal >= 0) {
      const glm::vec3 given = normals_[std::size_t(corner.normal)];
      const float length = glm::length(given);
      if (length > 0.0f && std::isfinite(length))
        normal = given / length;
      else
        scene_.repaired("zero or non-finite normals replaced by the triangle's");
    }
    const glm::vec2 uv = corner.uv >= 0 ? uvs_[std::size_t(corner.uv)] : glm::vec2(0.0f);
    const auto result = std::uint32_t(scene_.vertices.size());
    budget_.addVertices(1, 0, "this file");
    scene_.vertices.push_back(
        {at(corner), packNormal(normal), {uv.x, 1.0f - uv.y}, 0xffffffffu, *material_});
    if (corner.normal >= 0) known_.emplace(corner, result);
    return result;
  }

  Scene& scene_;
  LineBuffer& lines_;
  SceneBudget& budget_;
  ObjMaterials materials_;
  std::vector<glm::vec3> positions_, normals_;
  std::vector<glm::vec2> uvs_;
  std::string wanted_;
  std::optional<std::uint32_t> material_;
  std::unordered_map<Corner, std::uint32_t, CornerHash> known_;
};

Reader& reader(void* data) {
  return *static_cast<Reader*>(data);
}

struct Libraries : tinyobj::MaterialReader {
  explicit Libraries(Reader& to) : reader(to) {}
  bool operator()(const std::string& name, std::vector<tinyobj::material_t>*,
                  std::map<std::string, int>*, std::string*, std::string*) override {
    reader.readLibrary(name);
    return true;
  }
  Reader& reader;
};

}  // namespace

void findObjFiles(const std::filesystem::path& path, SceneFolder& folder) {
  checkRegularFile(path);
  std::ifstream stream(path, std::ios::binary);
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name;
    if (!(words >> name) || name != "mtllib") continue;
    while (words >> name) {
      const ObjLibrary library = readObjLibrary(name, folder);
      for (const tinyobj::material_t& material : library.materials)
        for (const std::string& texture : {material.diffuse_texname, material.alpha_texname})
          if (!texture.empty()) folder.find(library.beside(texture));
    }
  }
}

Scene loadObj(const std::filesystem::path& path, bool allowOutside) {
  checkRegularFile(path);
  SceneFolder folder(path, allowOutside);
  std::ifstream stream(path, std::ios::binary);
  if (!stream) fail<InputError>("{}: cannot be opened for reading", path.string());
  Scene scene;
  scene.name = path.stem().string();
  LineBuffer lines(stream, path.string());
  SceneBudget budget(path.string());
  Reader state(scene, lines, folder, budget);
  Libraries libraries(state);
  tinyobj::callback_t calls;
  calls.vertex_cb = [](void* to, float x, float y, float z, float) {
    reader(to).addPosition({x, y, z});
  };
  calls.normal_cb = [](void* to, float x, float y, float z) { reader(to).addNormal({x, y, z}); };
  calls.texcoord_cb = [](void* to, float x, float y, float) { reader(to).addUv({x, y}); };
  calls.index_cb = [](void* to, tinyobj::index_t* indices, int n) {
    reader(to).addFace(indices, n);
  };
  calls.usemtl_cb = [](void* to, const char* name, int) { reader(to).useMaterial(name); };
  std::istream input(&lines);
  // By default a stream swallows exceptions that its buffer throws.
  input.exceptions(std::ios::badbit);
  std::string warning, error;
  tinyobj::LoadObjWithCallback(input, calls, &state, &libraries, &warning, &error);
  if (scene.triangles.empty()) {
    std::string repairs;
    for (const Repair& repair : scene.repairs)
      repairs += fmt::format("; {}: {}", repair.what, repair.count);
    fail<InputError>("{}: has no triangles in its {} lines{}", path.string(), lines.line(),
                     repairs);
  }
  return scene;
}

}  // namespace oitlab
