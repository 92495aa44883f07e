// glTF: geometry, nodes and cameras.
#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "support/gltf.h"

namespace oitlab {
namespace {

using nlohmann::json;

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
  const int positions = glb.positions(triangleCorners);
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
  const int mesh = glb.mesh({{"POSITION", glb.positions(triangleCorners)}});
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
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)},
                               {"NORMAL", glb.positions(normals)}})}});
  const Scene scene = load(glb);
  EXPECT_EQ(repairs(scene, "normals"), 2u);
  for (const Vertex& vertex : scene.vertices)
    EXPECT_EQ(unpackNormal(vertex.normal), glm::vec3(0, 0, 1));
}

TEST_F(Gltf, VertexColorsOfEveryKind) {
  const auto color = [&](auto data, GlbBuilder::Type type, const char* shape, bool normalized) {
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)},
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
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)},
                               {"TEXCOORD_0",
                                glb.accessor(std::vector<float>(6), GlbBuilder::real, "VEC2")},
                               {"TEXCOORD_1", glb.accessor(set1, GlbBuilder::ubyte, "VEC2", true)}},
                              {{"material", 0}})}});
  const Scene scene = load(glb);
  EXPECT_LT(glm::distance(scene.vertices[0].uv, {0.5f, 3}), 1e-6f);
  EXPECT_LT(glm::distance(scene.vertices[1].uv, {0.9f, 1.2f}), 1e-6f);
}

TEST_F(Gltf, CamerasBecomeViews) {
  GlbBuilder glb;
  glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)}})}});
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

}  // namespace
}  // namespace oitlab
