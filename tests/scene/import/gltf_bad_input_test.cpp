// glTF files that are damaged or wrong.
#include <limits>

#include <gmock/gmock.h>

#include "support/gltf.h"
#include "util/random.h"

namespace oitlab {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST_F(Gltf, BrokenFilesAreNamedWithThePlace) {
  const auto check = [&](const char* wanted, auto&& change) {
    SCOPED_TRACE(wanted);
    GlbBuilder glb;
    const int positions = glb.positions(triangleCorners);
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
  const int mesh = glb.mesh({{"POSITION", glb.positions(triangleCorners)}});
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
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)},
                               {"NORMAL", glb.positions(upNormals)},
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

}  // namespace
}  // namespace oitlab
