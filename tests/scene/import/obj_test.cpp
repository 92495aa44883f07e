#include "scene/import/obj.h"

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/random.h"

namespace oitlab {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string triangleCorners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class Obj : public TemporaryFolder {
 protected:
  Scene load(const std::string& text) {
    write("x.obj", text);
    return loadObj(folder_ / "x.obj");
  }
  std::string failure(const std::string& text) {
    return messageOf<InputError>([&] { load(text); });
  }
  void write(const char* name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  // A grey image of 2x1 pixels in the simplest format of stb_image.
  void picture(const char* name, unsigned char left, unsigned char right) {
    write(name, std::string("P5\n2 1\n255\n") + char(left) + char(right));
  }
};

std::uint64_t repairsLike(const Scene& scene, const std::string& part) {
  std::uint64_t count = 0;
  for (const Repair& repair : scene.repairs)
    if (repair.what.find(part) != std::string::npos) count += repair.count;
  return count;
}

TEST_F(Obj, PolygonsBecomeFans) {
  const Scene scene =
      load(triangleCorners + "v 1 1 0\ng a b\no thing\ns 1\nf 1 2 4 3\nf -4 -3 -2\n");
  EXPECT_EQ(scene.name, "x");
  ASSERT_EQ(scene.triangles.size(), 3u);
  EXPECT_EQ(scene.vertices[scene.triangles[1].z].position, glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.vertices[scene.triangles[2].y].position, glm::vec3(1, 0, 0));
  EXPECT_EQ(unpackNormal(scene.vertices[0].normal), glm::vec3(0, 0, 1));
  EXPECT_TRUE(scene.repairs.empty());
}

TEST_F(Obj, CornersWithTheSameNormalAreShared) {
  const Scene scene =
      load(triangleCorners +
           "v 1 1 0\nvn 0 0 2\nvt 0.25 0.25\nf 1/1/1 2/1/1 3/1/1\nf 2/1/1 4//1 3/1/1\n");
  EXPECT_EQ(scene.vertices.size(), 4u);
  EXPECT_EQ(scene.vertices[0].uv, glm::vec2(0.25f, 0.75f)) << "v runs down";
  EXPECT_EQ(unpackNormal(scene.vertices[0].normal), glm::vec3(0, 0, 1));
}

TEST_F(Obj, WindowsLinesAndAMissingLastOne) {
  const Scene scene = load("v 0 0 0\r\nv 1 0 0\r\n\r\n# a\r\nv 0 1 0\r\nf 1 2 3");
  EXPECT_EQ(scene.triangles.size(), 1u);
}

TEST_F(Obj, MaterialsAndTheirOpacity) {
  write("x.mtl",
        "newmtl glass\nKd 0.1 0.2 0.3\nd 0.25\nnewmtl pane\nTr 0.25\nnewmtl wall\nKd 1 0 0\n");
  const Scene scene = load("mtllib x.mtl\n" + triangleCorners +
                           "usemtl glass\nf 1 2 3\nusemtl wall\nf 1 2 3\nusemtl pane\nf 1 2 3\n");
  const auto of = [&](int i) {
    return scene.materials[scene.vertices[scene.triangles[std::size_t(i)].x].material];
  };
  EXPECT_EQ(of(0).name, "glass");
  EXPECT_EQ(of(0).baseColor, glm::vec4(0.1f, 0.2f, 0.3f, 0.25f));
  EXPECT_EQ(of(0).alphaMode, AlphaMode::blend);
  EXPECT_EQ(of(1).alphaMode, AlphaMode::opaque);
  EXPECT_EQ(of(1).baseColor, glm::vec4(1, 0, 0, 1));
  EXPECT_FLOAT_EQ(of(2).baseColor.a, 0.75f);
}

TEST_F(Obj, MasksBecomeTheTexturesAlpha) {
  picture("color.pgm", 10, 20);
  picture("mask.pgm", 0, 255);
  write("x.mtl",
        "newmtl leaf\nKd 0 0 0\nmap_Kd color.pgm\nmap_d mask.pgm\nnewmtl hole\nKd 1 1 1\nmap_d "
        "mask.pgm\n");
  const Scene scene =
      load("mtllib x.mtl\n" + triangleCorners + "usemtl leaf\nf 1 2 3\nusemtl hole\nf 1 2 3\n");
  ASSERT_EQ(scene.textures.size(), 2u);
  const auto texture = [&](const char* name) {
    for (const Material& material : scene.materials)
      if (material.name == name) return scene.textures.at(std::size_t(material.texture)).rgba;
    return std::vector<std::uint8_t>();
  };
  EXPECT_EQ(texture("leaf"), (std::vector<std::uint8_t>{10, 10, 10, 0, 20, 20, 20, 255}));
  EXPECT_EQ(texture("hole"), (std::vector<std::uint8_t>{255, 255, 255, 0, 255, 255, 255, 255}));
  for (const Material& material : scene.materials) {
    EXPECT_EQ(material.alphaMode, AlphaMode::blend);
    EXPECT_GT(material.baseColor.r, 0.0f) << "a black Kd beside a texture means the texture";
  }
}

TEST_F(Obj, WhatIsMissingIsCounted) {
  write("x.mtl", "newmtl a\nmap_Kd nowhere.png\nmap_d neither.png\n");
  const Scene scene = load("mtllib gone.mtl\nmtllib x.mtl\n" + triangleCorners +
                           "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(scene.triangles.size(), 3u);
  EXPECT_EQ(repairsLike(scene, "libraries"), 1u);
  EXPECT_EQ(repairsLike(scene, "textures"), 2u);
  EXPECT_EQ(repairsLike(scene, "materials that do not exist"), 1u);
  EXPECT_EQ(
      repairsLike(load("mtllib\nmtllib .\nusemtl\n" + triangleCorners + "f 1 2 3\n"), "libraries"),
      1u);
}

TEST_F(Obj, NonFiniteAndDegenerateIsDroppedAndCounted) {
  const Scene scene =
      load(triangleCorners + "v nan 0 0\nv 0 1e999 0\nvn 0 0 0\nvt inf 0\n" +
           "f 1 2 3\nf 1 2 4\nf 5 2 3\nf 1 1 2\nf 1 2\nf 1//1 2//1 3//1\nf 1/1 2/1 3/1\n");
  EXPECT_EQ(scene.triangles.size(), 3u);
  EXPECT_EQ(repairsLike(scene, "non-finite positions"), 2u);
  EXPECT_EQ(repairsLike(scene, "repeat a corner"), 1u);
  EXPECT_EQ(repairsLike(scene, "fewer than three"), 1u);
  EXPECT_EQ(repairsLike(scene, "normals replaced"), 3u);
  EXPECT_EQ(repairsLike(scene, "texture coordinates"), 1u);
}

TEST_F(Obj, BadIndicesNameTheirLine) {
  for (const char* face : {"f 1 2 4", "f 0 1 2", "f -4 1 2", "f a b c", "f 1 2 99999999999",
                           "f 1 2 -2147483648", "f / / /"})
    EXPECT_THAT(failure(triangleCorners + "\n# comment\n" + face + "\n"),
                AllOf(HasSubstr("x.obj:6:"), HasSubstr("position")))
        << face;
  EXPECT_THAT(failure(triangleCorners + "f 1/1 2/1 3/1\n"), HasSubstr("texture coordinate 1"));
  EXPECT_THAT(failure(triangleCorners + "vn 0 0 1\nf 1//1 2//2 3//1\n"),
              HasSubstr("x.obj:5: normal 2"));
  EXPECT_THAT(failure("f 1 2 3\n" + triangleCorners), HasSubstr("x.obj:1:"));
}

TEST_F(Obj, BadNumbersNameTheirLine) {
  EXPECT_THAT(failure("v 0 0 0\nv 1 zero 0\n"), AllOf(HasSubstr("x.obj:2"), HasSubstr("'zero'")));
  EXPECT_THAT(failure("v 0 0 0\nv 1 0"), AllOf(HasSubstr("x.obj:2"), HasSubstr("2 numbers")));
  EXPECT_THAT(failure("vn 1,0,0\n"), HasSubstr("'1,0,0'"));
}

TEST_F(Obj, NothingToSeeIsAnError) {
  EXPECT_THAT(failure(""), HasSubstr("no triangles"));
  EXPECT_THAT(failure(triangleCorners), HasSubstr("3 lines"));
  EXPECT_THAT(failure(triangleCorners + "f 1 2\n"),
              HasSubstr("fewer than three corners skipped: 1"));
  EXPECT_THAT(messageOf<InputError>([&] { loadObj(folder_ / "gone.obj"); }), HasSubstr("gone.obj"));
  std::string polygon = triangleCorners + "f";
  for (int i = 0; i < 1000; ++i) polygon += " " + std::to_string(1 + i % 3);
  EXPECT_GT(load(polygon).triangles.size(), 300u) << "more corners than a byte can count";
}

TEST_F(Obj, RubbishNeverCrashes) {
  write("x.mtl", "newmtl a\nmap_Kd x.mtl\nd\nKd\nTr x\n\nnewmtl\nd 0.5");
  const std::string good = "mtllib x.mtl\n" + triangleCorners +
                           "vn 0 0 1\nvt 0 0\nusemtl a\ng x y\nf 1/1/1 2/1/1 3/1/1\nf -1 -2 -3\n";
  Pcg32 random(6);
  const std::string characters = "vnft0123456789-/.e \n\r\t#glmo\0\xff\x80";
  for (int i = 0; i < 600; ++i) {
    std::string text = good.substr(0, i < 100 ? std::size_t(i) : std::string::npos);
    for (std::uint32_t k = random.next() % 8; k > 0 && !text.empty(); --k)
      text[random.next() % text.size()] = characters[random.next() % characters.size()];
    try {
      const Scene scene = load(text);
      for (const glm::uvec3& t : scene.triangles)
        for (int c = 0; c < 3; ++c) {
          ASSERT_LT(t[c], scene.vertices.size());
          ASSERT_LT(scene.vertices[t[c]].material, scene.materials.size());
        }
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("x.obj"));
    }
  }
}

}  // namespace
}  // namespace oitlab
