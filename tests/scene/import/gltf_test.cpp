#include "scene/import/gltf.h"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stb_image_write.h>

#include "support/glb.h"
#include "support/shared_scenes.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/random.h"

namespace oitlab {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

const std::vector<float> kTriangle{0, 0, 0, 1, 0, 0, 0, 1, 0};  // faces +Z
const std::vector<float> kUp{0, 0, 1, 0, 0, 1, 0, 0, 1};

std::string png(int width, int height, const std::vector<std::uint8_t>& rgba) {
  std::string bytes;
  stbi_write_png_to_func(
      [](void* to, void* data, int size) {
        static_cast<std::string*>(to)->append(static_cast<const char*>(data), std::size_t(size));
      },
      &bytes, width, height, 4, rgba.data(), 4 * width);
  return bytes;
}

class Gltf : public TemporaryFolder {
 protected:
  Scene load(GlbBuilder& glb) { return loadGltf(glb.write(folder_ / "x.glb")); }
  std::string error(GlbBuilder& glb) {
    return messageOf<InputError>([&] { load(glb); });
  }
  std::string errorOf(const std::string& bytes, const char* name = "x.glb") {
    const std::string path = GlbBuilder::writeFile(folder_ / name, bytes);
    return messageOf<InputError>([&] { loadGltf(path); });
  }

  // One triangle with a material, drawn by `node`: the start of most tests.
  Scene loadTriangle(const json& material, json node = json::object()) {
    GlbBuilder glb;
    glb.json["materials"] = {material};
    node["mesh"] =
        glb.mesh({{"POSITION", glb.positions(kTriangle)}, {"NORMAL", glb.positions(kUp)}},
                 {{"material", 0}});
    glb.node(node);
    return load(glb);
  }
};

glm::vec3 at(const Scene& scene, std::size_t triangle, int corner) {
  return scene.vertices[scene.triangles[triangle][corner]].position;
}

glm::vec3 faceNormal(const Scene& scene, std::size_t t) {
  return glm::normalize(
      glm::cross(at(scene, t, 1) - at(scene, t, 0), at(scene, t, 2) - at(scene, t, 0)));
}

std::uint64_t repairs(const Scene& scene, const std::string& part) {
  std::uint64_t count = 0;
  for (const Repair& repair : scene.repairs)
    if (repair.what.find(part) != std::string::npos) count += repair.count;
  return count;
}

TEST_F(Gltf, IndicesOfEveryWidth) {
  const auto check = [&]<typename T>(T, GlbBuilder::Type type) {
    GlbBuilder glb;
    const int indices = glb.accessor(std::vector<T>{0, 1, 2, 2, 1, 3}, type, "SCALAR");
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0})},
                                 {"NORMAL", glb.positions({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}},
                                {{"indices", indices}})}});
    const Scene scene = load(glb);
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.vertices.size(), 4u);
    EXPECT_EQ(at(scene, 1, 2), glm::vec3(1, 1, 0));
    EXPECT_TRUE(scene.repairs.empty());
    EXPECT_EQ(scene.name, "x");
  };
  check(std::uint8_t{}, GlbBuilder::ubyte);
  check(std::uint16_t{}, GlbBuilder::ushort);
  check(std::uint32_t{}, GlbBuilder::uint);
}

TEST_F(Gltf, WithoutNormalsTheyAreFlat) {
  GlbBuilder glb;
  const int indices =
      glb.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, GlbBuilder::ubyte, "SCALAR");
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1})}},
                              {{"indices", indices}})}});
  const Scene scene = load(glb);
  EXPECT_EQ(scene.vertices.size(), 6u);
  for (std::size_t t = 0; t < 2; ++t)
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(unpackNormal(scene.vertices[scene.triangles[t][i]].normal), faceNormal(scene, t));
}

TEST_F(Gltf, StripsAndFansKeepTheirWinding) {
  for (const int mode : {5, 6}) {
    GlbBuilder glb;
    const std::vector<float> strip{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    const std::vector<float> fan{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(mode == 5 ? strip : fan)}},
                                {{"mode", mode}})}});
    const Scene scene = load(glb);
    ASSERT_EQ(scene.triangles.size(), 3u);
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(faceNormal(scene, t), glm::vec3(0, 0, 1));
  }
}

TEST_F(Gltf, OtherPrimitivesAreSkippedAndCounted) {
  GlbBuilder glb;
  const int positions = glb.positions(kTriangle);
  for (int mode = 0; mode < 5; ++mode)
    glb.node({{"mesh", glb.mesh({{"POSITION", positions}}, {{"mode", mode}})}});
  glb.node({{"mesh", glb.mesh({{"NORMAL", positions}})}});
  const Scene scene = load(glb);
  EXPECT_EQ(scene.triangles.size(), 1u);
  EXPECT_EQ(repairs(scene, "points or lines"), 4u);
  EXPECT_EQ(repairs(scene, "without positions"), 1u);
}

TEST_F(Gltf, NodesAreVisitedDepthFirstWithTheirTransforms) {
  GlbBuilder glb;
  const int mesh = glb.mesh({{"POSITION", glb.positions(kTriangle)}});
  const float half = std::sqrt(0.5f);
  const int child = glb.node({{"mesh", mesh},
                              {"translation", {1, 0, 0}},
                              {"rotation", {0, 0, half, half}},  // x to y
                              {"scale", {2, 1, 1}}},
                             false);
  glb.node({{"children", {child}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 7, 1}}});
  glb.node({{"mesh", mesh}});
  const Scene scene = load(glb);
  ASSERT_EQ(scene.triangles.size(), 2u);
  EXPECT_LT(glm::distance(at(scene, 0, 0), {6, 0, 7}), 1e-6f);
  EXPECT_LT(glm::distance(at(scene, 0, 1), {6, 2, 7}), 1e-6f);
  EXPECT_LT(glm::distance(at(scene, 0, 2), {5, 0, 7}), 1e-6f);
  EXPECT_EQ(at(scene, 1, 1), glm::vec3(1, 0, 0));
}

TEST_F(Gltf, NormalsMoveByTheInverseTranspose) {
  GlbBuilder glb;  // the plane x + y = 1
  const std::vector<float> normals{1, 1, 0, 1, 1, 0, 1, 1, 0};
  glb.node({{"scale", {4, 1, 1}},
            {"mesh", glb.mesh({{"POSITION", glb.positions({1, 0, 0, 0, 1, 0, 0, 1, 1})},
                               {"NORMAL", glb.positions(normals)}})}});
  const Scene scene = load(glb);
  EXPECT_GT(glm::dot(unpackNormal(scene.vertices[0].normal), glm::normalize(glm::vec3(1, 4, 0))),
            0.99999f);
}

TEST_F(Gltf, MirrorsKeepFacesAndNormalsTogether) {
  const Scene scene = loadTriangle(json::object(), {{"scale", {-1, 1, 1}}});
  EXPECT_EQ(faceNormal(scene, 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(unpackNormal(scene.vertices[0].normal), glm::vec3(0, 0, 1));
  const Scene turned = loadTriangle(json::object(), {{"scale", {-1, -1, -1}}});
  EXPECT_EQ(faceNormal(turned, 0), glm::vec3(0, 0, -1));
  EXPECT_EQ(unpackNormal(turned.vertices[0].normal), glm::vec3(0, 0, -1));
}

TEST_F(Gltf, UselessNormalsAreReplacedAndCounted) {
  GlbBuilder glb;
  const std::vector<float> normals{0, 0, 0, std::nanf(""), 0, 0, 0, 0, 1};
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)},
                               {"NORMAL", glb.positions(normals)}})}});
  const Scene scene = load(glb);
  EXPECT_EQ(repairs(scene, "normals"), 2u);
  for (const Vertex& vertex : scene.vertices)
    EXPECT_EQ(unpackNormal(vertex.normal), glm::vec3(0, 0, 1));
}

TEST_F(Gltf, VertexColorsOfEveryKind) {
  const auto color = [&](auto data, GlbBuilder::Type type, const char* shape, bool normalized) {
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)},
                                 {"COLOR_0", glb.accessor(data, type, shape, normalized)}})}});
    return load(glb).vertices[0].color;
  };
  using V8 = std::vector<std::uint8_t>;
  using V16 = std::vector<std::uint16_t>;
  EXPECT_EQ(color(V8{1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0}, GlbBuilder::ubyte, "VEC4", true),
            0x04030201u);
  EXPECT_EQ(color(V8{1, 2, 3, 0, 0, 0, 0, 0, 0}, GlbBuilder::ubyte, "VEC3", true), 0xff030201u);
  EXPECT_EQ(color(V16{257, 514, 65535, 0, 0, 0, 0, 0, 0}, GlbBuilder::ushort, "VEC3", true),
            0xffff0201u);
  EXPECT_EQ(color(std::vector<float>{0, 0.2f, 1, 0.4f, 0, 0, 0, 0, 0, 0, 0, 0}, GlbBuilder::real,
                  "VEC4", false),
            0x66ff3300u);
}

TEST_F(Gltf, TextureCoordinatesAreScaledChosenAndMoved) {
  GlbBuilder glb;
  const std::vector<std::uint8_t> set1{0, 255, 51, 102, 0, 0};
  glb.json["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform",
              {{"texCoord", 1}, {"offset", {0.5, 0}}, {"scale", {2, 3}}}}}}}}}}}};
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)},
                               {"TEXCOORD_0",
                                glb.accessor(std::vector<float>(6), GlbBuilder::real, "VEC2")},
                               {"TEXCOORD_1", glb.accessor(set1, GlbBuilder::ubyte, "VEC2", true)}},
                              {{"material", 0}})}});
  const Scene scene = load(glb);
  EXPECT_LT(glm::distance(scene.vertices[0].uv, {0.5f, 3}), 1e-6f);
  EXPECT_LT(glm::distance(scene.vertices[1].uv, {0.9f, 1.2f}), 1e-6f);
}

TEST_F(Gltf, MaterialsSayWhichAlphaCounts) {
  const json half{{"baseColorFactor", {0.1, 0.2, 0.3, 0.5}}};
  const Material opaque = loadTriangle({{"pbrMetallicRoughness", half}}).materials.at(0);
  EXPECT_EQ(opaque.alphaMode, AlphaMode::opaque);
  EXPECT_EQ(opaque.baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 1));
  EXPECT_TRUE(opaque.ignoreVertexAlpha && opaque.ignoreTextureAlpha);
  EXPECT_EQ(opaque.alphaCutoff, 0.0f);
  EXPECT_FALSE(opaque.doubleSided);

  const Material blend =
      loadTriangle({{"pbrMetallicRoughness", half}, {"alphaMode", "BLEND"}, {"doubleSided", true}})
          .materials.at(0);
  EXPECT_EQ(blend.alphaMode, AlphaMode::blend);
  EXPECT_EQ(blend.baseColor.a, 0.5f);
  EXPECT_FALSE(blend.ignoreVertexAlpha || blend.ignoreTextureAlpha);
  EXPECT_EQ(blend.alphaCutoff, 0.0f);
  EXPECT_TRUE(blend.doubleSided);

  EXPECT_EQ(loadTriangle({{"alphaMode", "MASK"}}).materials.at(0).alphaCutoff, 0.5f);
  const Material mask =
      loadTriangle({{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}}).materials.at(0);
  EXPECT_EQ(mask.alphaMode, AlphaMode::mask);
  EXPECT_EQ(mask.alphaCutoff, 0.25f);
}

TEST_F(Gltf, TransmissionBecomesOpacity) {
  const auto glass = [&](double transmission, const char* mode) {
    return loadTriangle(
               {{"alphaMode", mode},
                {"extensions",
                 {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}}}}})
        .materials.at(0);
  };
  EXPECT_EQ(glass(0, "OPAQUE").alphaMode, AlphaMode::opaque);
  EXPECT_EQ(glass(0.75, "OPAQUE").alphaMode, AlphaMode::blend);
  EXPECT_EQ(glass(0.75, "OPAQUE").baseColor.a, 0.25f);
  EXPECT_TRUE(glass(0.75, "OPAQUE").ignoreTextureAlpha);
  EXPECT_EQ(glass(1, "OPAQUE").baseColor.a, 0.0f);
  EXPECT_EQ(glass(0.95, "OPAQUE").baseColor.a, 1.0f - 0.95f) << "no floor";
  EXPECT_EQ(glass(0.5, "MASK").alphaMode, AlphaMode::blend);
  EXPECT_EQ(glass(0.5, "MASK").alphaCutoff, 0.25f) << "cuts out the same texels";
}

TEST_F(Gltf, CamerasBecomeViews) {
  GlbBuilder glb;
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)}})}});
  glb.json["cameras"] = {{{"type", "perspective"},
                          {"name", "front"},
                          {"perspective", {{"yfov", 0.7}, {"znear", 0.2}}}},
                         {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}};
  glb.node({{"camera", 0}, {"translation", {1, 2, 3}}});
  glb.node({{"camera", 0}, {"rotation", {0, 1, 0, 0}}});  // half a turn about y
  glb.node({{"camera", 1}});
  const Scene scene = load(glb);
  ASSERT_TRUE(scene.views.contains("front"));
  const Camera& front = scene.views.at("front");
  EXPECT_EQ(front.eye, glm::vec3(1, 2, 3));
  EXPECT_EQ(front.target, glm::vec3(1, 2, 2));
  EXPECT_EQ(front.up, glm::vec3(0, 1, 0));
  EXPECT_FLOAT_EQ(front.fovY, 0.7f);
  EXPECT_FLOAT_EQ(front.near, 0.2f);
  ASSERT_TRUE(scene.views.contains("front-2"));
  EXPECT_EQ(scene.views.at("front-2").target, glm::vec3(0, 0, 1));
  EXPECT_EQ(repairs(scene, "orthographic"), 1u);
}

TEST_F(Gltf, NonFinitePositionsCostTheirTrianglesOnly) {
  const float inf = std::numeric_limits<float>::infinity();
  GlbBuilder glb;
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions({0, 0, 0,   1,
                                                           0, 0, 0,   1,
                                                           0,  // good
                                                           0, 0, 0,   std::nanf(""),
                                                           0, 0, 0,   1,
                                                           0,  // dropped
                                                           0, 0, inf, 1,
                                                           0, 0, 0,   1,
                                                           0,  // dropped
                                                           0, 0, 0,   1,
                                                           0, 0, 2,   0,
                                                           0})}})}});  // no area
  const Scene scene = load(glb);
  EXPECT_EQ(scene.triangles.size(), 2u) << "triangles without area stay";
  EXPECT_EQ(repairs(scene, "non-finite positions"), 2u);
  for (const Vertex& vertex : scene.vertices)
    EXPECT_TRUE(std::isfinite(glm::length(vertex.position)));
}

class GltfTexture : public Gltf {
 protected:
  GlbBuilder textured(int materials = 1) {
    GlbBuilder glb;
    for (int i = 0; i < materials; ++i)
      glb.json["materials"].push_back(
          {{"alphaMode", "BLEND"},
           {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)}}, {{"material", 0}})}});
    glb.json["textures"] = {{{"source", 0}}};
    return glb;
  }
};

TEST_F(GltfTexture, EachImageIsDecodedOnce) {
  GlbBuilder glb = textured(2);
  const std::vector<std::uint8_t> rgba{255, 0, 0, 255, 0, 255, 0, 128};
  const std::string bytes = png(2, 1, rgba);
  glb.json["images"] = {
      {{"bufferView", glb.bufferView(bytes.data(), bytes.size())}, {"mimeType", "image/png"}},
      {{"uri", "unused_and_not_there.png"}}};
  const Scene scene = load(glb);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_EQ(scene.textures[0].rgba, rgba);
  EXPECT_TRUE(scene.textures[0].hasAlpha());
  EXPECT_EQ(scene.materials[0].texture, 0);
  EXPECT_EQ(scene.materials[1].texture, 0);
  EXPECT_TRUE(scene.repairs.empty());
}

TEST_F(GltfTexture, MissingOnesAreCountedAndDrawnWithout) {
  const auto check = [&](const char* what, auto&& change) {
    SCOPED_TRACE(what);
    GlbBuilder glb = textured();
    change(glb);
    const Scene scene = load(glb);
    EXPECT_EQ(scene.materials[0].texture, -1);
    EXPECT_EQ(repairs(scene, "without their texture"), 1u);
  };
  check("no such file", [](auto& glb) { glb.json["images"] = {{{"uri", "nowhere.png"}}}; });
  check("no image", [](auto&) {});
  check("no source", [](auto& glb) { glb.json["textures"] = {json::object()}; });
  check("no texture", [](auto& glb) { glb.json.erase("textures"); });
  check("garbage", [](auto& glb) {
    glb.json["images"] = {{{"bufferView", glb.bufferView("garbage", 7)}}};
  });
  check("cut short", [](auto& glb) {
    const std::string bytes = png(2, 1, std::vector<std::uint8_t>(8));
    glb.json["images"] = {{{"bufferView", glb.bufferView(bytes.data(), bytes.size() / 2)}}};
  });
}

TEST_F(GltfTexture, ReadsImagesAndBuffersBesideTheFile) {
  const std::vector<std::uint8_t> rgba{1, 2, 3, 255};
  GlbBuilder::writeFile(folder_ / "a b.png", png(1, 1, rgba));
  GlbBuilder::writeFile(folder_ / "x.bin",
                        std::string(reinterpret_cast<const char*>(kTriangle.data()), 36));
  GlbBuilder glb = textured();
  glb.json["images"] = {{{"uri", "a%20b.png"}}};
  glb.json["buffers"] = {{{"uri", "x.bin"}, {"byteLength", 36}}};
  const Scene scene = loadGltf(GlbBuilder::writeFile(folder_ / "x.gltf", glb.json.dump()));
  EXPECT_EQ(scene.textures.at(0).rgba, rgba);
  EXPECT_EQ(at(scene, 0, 1), glm::vec3(1, 0, 0));
  std::filesystem::remove(folder_ / "x.bin");
  EXPECT_THAT(errorOf(glb.json.dump(), "x.gltf"), HasSubstr("x.gltf"));
}

TEST_F(Gltf, BrokenFilesAreNamedWithThePlace) {
  const auto check = [&](const char* wanted, auto&& change) {
    SCOPED_TRACE(wanted);
    GlbBuilder glb;
    const int positions = glb.positions(kTriangle);
    const int indices =
        glb.accessor(std::vector<std::uint16_t>{0, 1, 2}, GlbBuilder::ushort, "SCALAR");
    glb.node({{"mesh", glb.mesh({{"POSITION", positions}}, {{"indices", indices}})}});
    change(glb);
    EXPECT_THAT(error(glb), AllOf(HasSubstr("x.glb: "), HasSubstr(wanted)));
  };
  json none;
  const auto primitive = [](GlbBuilder& glb) -> json& {
    return glb.json["meshes"][0]["primitives"][0];
  };
  check("index 1 is 7, but there are 3 vertices", [&](auto& glb) {
    primitive(glb)["indices"] =
        glb.accessor(std::vector<std::uint8_t>{0, 7, 2}, GlbBuilder::ubyte, "SCALAR");
  });
  check("mesh 0 'm', primitive 0, indices", [&](auto& glb) { primitive(glb)["indices"] = 0; });
  check("material 3 does not exist", [&](auto& glb) { primitive(glb)["material"] = 3; });
  check("POSITION: accessor 9 does not exist",
        [&](auto& glb) { primitive(glb)["attributes"]["POSITION"] = 9; });
  check("NORMAL: 1 components, expected 3",
        [&](auto& glb) { primitive(glb)["attributes"]["NORMAL"] = 1; });
  check("NORMAL: 2 elements, but POSITION has 3", [&](auto& glb) {
    primitive(glb)["attributes"]["NORMAL"] = glb.positions({0, 0, 1, 0, 0, 1});
  });
  check("needs 4000000000 elements of 12 bytes",
        [](auto& glb) { glb.json["accessors"][0]["count"] = 4000000000u; });
  check("expected less than 2^32",
        [](auto& glb) { glb.json["accessors"][0]["count"] = 1ull << 62; });
  check("needs 3 elements", [](auto& glb) { glb.json["accessors"][0]["byteOffset"] = 1; });
  check("needs 3 elements", [](auto& glb) { glb.json["bufferViews"][0]["byteStride"] = 252; });
  check("bytes from offset 4000",
        [](auto& glb) { glb.json["bufferViews"][0]["byteOffset"] = 4000; });
  check("buffer 5 does not exist", [](auto& glb) { glb.json["bufferViews"][0]["buffer"] = 5; });
  check("buffer view 8 does not exist",
        [](auto& glb) { glb.json["accessors"][0]["bufferView"] = 8; });
  check("sparse", [](auto& glb) {
    glb.json["accessors"][0]["sparse"] = {{"count", 1},
                                          {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                                          {"values", {{"bufferView", 0}}}};
  });
  check("mesh 4 does not exist", [](auto& glb) { glb.json["nodes"][0]["mesh"] = 4; });
  check("node 6 does not exist", [](auto& glb) { glb.json["scenes"][0]["nodes"] = {6}; });
  check("node 0 is reached twice", [](auto& glb) { glb.json["nodes"][0]["children"] = {0}; });
  check("no triangles", [](auto& glb) { glb.json["scenes"][0]["nodes"] = json::array(); });
  check("points or lines skipped: 1", [&](auto& glb) { primitive(glb)["mode"] = 0; });
  check("KHR_draco_mesh_compression",
        [](auto& glb) { glb.json["extensionsRequired"] = {"KHR_draco_mesh_compression"}; });
  check("byteLength", [](auto& glb) { glb.json["buffers"] = {{{"byteLength", 1u << 30}}}; });
  check("x.glb", [](auto& glb) { glb.json["buffers"] = {{{"byteLength", 0}}}; });
  check("x.glb", [](auto& glb) { glb.json["buffers"] = json::array(); });
}

TEST_F(Gltf, WhatIsNoGltfAtAll) {
  EXPECT_THAT(errorOf(""), HasSubstr("x.glb"));
  EXPECT_THAT(errorOf("glTF"), HasSubstr("x.glb"));
  EXPECT_THAT(errorOf("{}"), HasSubstr("x.glb"));
  EXPECT_THAT(errorOf("no such thing", "x.gltf"), HasSubstr("x.gltf"));
  EXPECT_THAT(messageOf<InputError>([&] { loadGltf(folder_ / "y.glb"); }), HasSubstr("y.glb"));
  EXPECT_EQ(errorOf("garbage").find('\n'), std::string::npos);
}

TEST_F(Gltf, DeepNodesDoNotExhaustTheStack) {
  GlbBuilder glb;
  const int mesh = glb.mesh({{"POSITION", glb.positions(kTriangle)}});
  const int depth = 20000;
  for (int i = 0; i < depth; ++i) glb.node({{"children", {i + 1}}}, i == 0);
  glb.node({{"mesh", mesh}}, false);
  EXPECT_EQ(load(glb).triangles.size(), 1u);
}

// A small file that uses every feature, cut at every length and with a thousand random changes.
// Each file is loaded or rejected with one line, and none crashes (run this under the sanitizers).
TEST_F(Gltf, DamageNeverCrashes) {
  GlbBuilder glb;
  const std::string image = png(2, 2, std::vector<std::uint8_t>(16, 99));
  glb.json["images"] = {{{"bufferView", glb.bufferView(image.data(), image.size())}}};
  glb.json["textures"] = {{{"source", 0}}};
  glb.json["materials"] = {
      {{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  glb.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  const int indices =
      glb.accessor(std::vector<std::uint16_t>{0, 1, 2}, GlbBuilder::ushort, "SCALAR");
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(kTriangle)},
                               {"NORMAL", glb.positions(kUp)},
                               {"TEXCOORD_0",
                                glb.accessor(std::vector<float>(6), GlbBuilder::real, "VEC2")}},
                              {{"indices", indices}, {"material", 0}})},
            {"camera", 0},
            {"rotation", {0, 0, 0, 1}}});
  const std::string good = glb.bytes();
  EXPECT_EQ(errorOf(good), "");
  for (std::size_t length = 0; length < good.size(); length += 7)
    EXPECT_NE(errorOf(good.substr(0, length)), "") << length;
  Pcg32 random(7);
  for (int i = 0; i < 1000; ++i) {
    std::string bad = good;
    for (std::uint32_t changes = 1 + random.next() % 3; changes > 0; --changes) {
      const char* digits = "0123456789-e{}[]\",:";
      bad[12 + random.next() % (bad.size() - 12)] =
          random.next() % 4 ? digits[random.next() % 19] : char(random.next());
    }
    EXPECT_EQ(errorOf(bad).find('\n'), std::string::npos);
  }
}

TEST(SharedScenes, AllLoadWithTheTrianglesOfTheirManifest) {
  OITLAB_NEEDS_SHARED_SCENES();
  const json manifest = json::parse(std::ifstream(sharedScenes() / "manifest.json"));
  ASSERT_EQ(manifest["scenes"].size(), 24u);
  for (const json& entry : manifest["scenes"]) {
    const auto file = entry["file"].get<std::string>();
    SCOPED_TRACE(file);
    const Scene scene = loadScene({(sharedScenes() / file).string()});
    EXPECT_EQ(scene.triangles.size(), entry["triangles"].get<std::size_t>());
    EXPECT_EQ(scene.textures.size(), entry["textures"].get<std::size_t>());
    EXPECT_EQ(scene.materials.size(), entry["materials"].get<std::size_t>());
    EXPECT_TRUE(scene.repairs.empty());
    for (int i = 0; i < 3; ++i) {
      const float size = scene.bounds.max[i] - scene.bounds.min[i];
      EXPECT_NEAR(scene.bounds.min[i], entry["bboxMin"][std::size_t(i)].get<float>(), 1e-3f * size);
      EXPECT_NEAR(scene.bounds.max[i], entry["bboxMax"][std::size_t(i)].get<float>(), 1e-3f * size);
    }
  }
}

}  // namespace
}  // namespace oitlab
