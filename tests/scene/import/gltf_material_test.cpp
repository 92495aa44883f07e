// glTF: materials and textures.
#include <gmock/gmock.h>

#include "support/gltf.h"

namespace oitlab {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

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

class GltfTexture : public Gltf {
 protected:
  GlbBuilder textured(int materials = 1) {
    GlbBuilder glb;
    for (int i = 0; i < materials; ++i)
      glb.json["materials"].push_back(
          {{"alphaMode", "BLEND"},
           {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
    glb.node(
        {{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)}}, {{"material", 0}})}});
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
                        std::string(reinterpret_cast<const char*>(triangleCorners.data()), 36));
  GlbBuilder glb = textured();
  glb.json["images"] = {{{"uri", "a%20b.png"}}};
  glb.json["buffers"] = {{{"uri", "x.bin"}, {"byteLength", 36}}};
  const Scene scene = loadGltf(GlbBuilder::writeFile(folder_ / "x.gltf", glb.json.dump()));
  EXPECT_EQ(scene.textures.at(0).rgba, rgba);
  EXPECT_EQ(at(scene, 0, 1), glm::vec3(1, 0, 0));
  std::filesystem::remove(folder_ / "x.bin");
  EXPECT_THAT(errorOf(glb.json.dump(), "x.gltf"), HasSubstr("x.gltf"));
}

}  // namespace
}  // namespace oitlab
