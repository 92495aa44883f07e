#include "scene/atlas.h"

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/error.h"

namespace oitlab {
namespace {

using Rgba = std::array<int, 4>;
using Paint = std::function<Rgba(int x, int y)>;

Texture texture(int width, int height, const Paint& paint) {
  Texture result{.width = width, .height = height, .rgba = {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (const int c : paint(x, y)) result.rgba.push_back(std::uint8_t(c));
  return result;
}

Paint solid(Rgba color) {
  return [=](int, int) { return color; };
}

const Rgba red{255, 0, 0, 255}, green{0, 255, 0, 255}, blue{0, 0, 255, 255};

// One BLEND material per texture.
Scene sceneOf(std::vector<Texture> textures) {
  Scene scene;
  for (int i = 0; i < int(textures.size()); ++i)
    scene.materials.push_back({.texture = i, .alphaMode = AlphaMode::blend});
  scene.textures = std::move(textures);
  return scene;
}

// A decoded level. Texels are counted from a texture's corner, so (-1, 0) is in its border.
struct Decoded {
  Decoded(const Atlas& atlas, const AtlasPlacement& place, std::size_t index)
      : rgba(decodeAtlasLevel(atlas, index)),
        width(atlas.levels[index].width),
        x0(int(std::lround(place.rect.x * float(atlas.width))) >> index),
        y0(int(std::lround(place.rect.y * float(atlas.height))) >> index) {}

  Rgba at(int x, int y) const {
    const auto* texel = &rgba[4 * std::size_t((y0 + y) * width + x0 + x)];
    return {texel[0], texel[1], texel[2], texel[3]};
  }

  std::vector<std::uint8_t> rgba;
  int width, x0, y0;
};

int difference(const Rgba& a, const Rgba& b) {
  int most = 0;
  for (std::size_t c = 0; c < 4; ++c) most = std::max(most, std::abs(a[c] - b[c]));
  return most;
}

TEST(Atlas, NoTexturesNoAtlas) {
  Scene scene;
  scene.materials.resize(2);
  const SceneAtlases atlases = buildAtlases(scene);
  EXPECT_EQ(atlases.opaque.width, 0);
  EXPECT_EQ(atlases.transparent.width, 0);
  ASSERT_EQ(atlases.ofMaterial.size(), 2u);
  EXPECT_EQ(atlases.ofMaterial[1].atlas, 0u);
}

TEST(Atlas, OnlyAlphaThatCountsGoesToTheTransparentOne) {
  Scene scene = sceneOf({texture(8, 8, solid(red)), texture(8, 8, solid({0, 255, 0, 128}))});
  scene.materials.push_back({.texture = 1, .ignoreTextureAlpha = true});
  scene.materials.push_back({.texture = 1, .alphaMode = AlphaMode::mask});
  const SceneAtlases atlases = buildAtlases(scene);
  EXPECT_EQ(atlases.ofMaterial[0].atlas, 1u);
  EXPECT_EQ(atlases.ofMaterial[1].atlas, 2u);
  EXPECT_EQ(atlases.ofMaterial[2].atlas, 1u);
  EXPECT_EQ(atlases.ofMaterial[3].rect, atlases.ofMaterial[1].rect) << "one copy";
  EXPECT_FALSE(atlases.opaque.alpha);
  EXPECT_TRUE(atlases.transparent.alpha);
  EXPECT_LT(
      difference(Decoded(atlases.transparent, atlases.ofMaterial[1], 0).at(0, 0), {0, 255, 0, 128}),
      2);
  EXPECT_EQ(Decoded(atlases.opaque, atlases.ofMaterial[2], 0).at(0, 0), green);
}

TEST(Atlas, LevelsHalveAndHoldWholeBlocks) {
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(300, 10, solid(red))}));
  const auto& levels = atlases.opaque.levels;
  ASSERT_FALSE(levels.empty());
  for (std::size_t i = 0; i < levels.size(); ++i) {
    EXPECT_EQ(levels[i].width, atlases.opaque.width >> i);
    EXPECT_EQ(levels[i].height, atlases.opaque.height >> i);
    EXPECT_EQ(levels[i].width % 4, 0);
    EXPECT_EQ(levels[i].height % 4, 0);
    EXPECT_EQ(levels[i].blocks.size(), std::size_t(levels[i].width * levels[i].height / 2));
  }
}

TEST(Atlas, NeighboursNeverBleedAtAnyLevel) {
  std::vector<Texture> textures;
  const std::vector<Rgba> colors{red, green, blue};
  const std::vector<std::pair<int, int>> sizes{{64, 64},  {1, 1},  {100, 37},
                                               {64, 200}, {33, 5}, {128, 128}};
  for (std::size_t i = 0; i < sizes.size(); ++i)
    textures.push_back(texture(sizes[i].first, sizes[i].second, solid(colors[i % 3])));
  const SceneAtlases atlases = buildAtlases(sceneOf(std::move(textures)));
  for (std::size_t level = 0; level < atlases.opaque.levels.size(); ++level)
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const Decoded decoded(atlases.opaque, atlases.ofMaterial[i], level);
      // All texels that bilinear filtering inside the texture may read.
      const auto last = [&](int size) {
        return int(std::floor(float(size) / float(1 << level) - 0.5f)) + 1;
      };
      const int width = last(sizes[i].first), height = last(sizes[i].second);
      for (int y = -1; y <= height; ++y)
        for (int x = -1; x <= width; ++x)
          ASSERT_EQ(decoded.at(x, y), colors[i % 3]) << level << ": " << i << " " << x << " " << y;
    }
}

TEST(Atlas, BordersRepeatTheTexture) {
  const int size = 64;
  const auto paint = [](int x, int y) { return Rgba{x * 4, y * 4, 128, 255}; };
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(size, size, paint)}));
  for (std::size_t level = 0; level < 4; ++level) {
    const Decoded decoded(atlases.opaque, atlases.ofMaterial[0], level);
    const int n = size >> level;
    for (int i = 0; i < n; ++i) {
      // The same texels in a block with other neighbours: equal except for the compression.
      EXPECT_LT(difference(decoded.at(-1, i), decoded.at(n - 1, i)), 24);
      EXPECT_LT(difference(decoded.at(i, n), decoded.at(i, 0)), 24);
    }
    EXPECT_GT(decoded.at(-1, 0)[0], 180) << "the left border is the right edge";
    EXPECT_LT(decoded.at(n, 0)[0], 75);
  }
}

TEST(Atlas, CompressionKeepsAGradientWithAlpha) {
  const auto paint = [](int x, int y) { return Rgba{2 * x, 2 * x, 2 * x, 2 * y}; };
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(128, 128, paint)}));
  const Decoded decoded(atlases.transparent, atlases.ofMaterial[0], 0);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      ASSERT_LE(difference(decoded.at(x, y), paint(x, y)), 5) << x << " " << y;
      ASSERT_LE(std::abs(decoded.at(x, y)[3] - 2 * y), 1);
    }
}

TEST(Atlas, CompressionKeepsAnOpaqueGradient) {
  const auto paint = [](int x, int y) { return Rgba{2 * x, x + y, 2 * x, 255}; };
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(128, 128, paint)}));
  const Decoded decoded(atlases.opaque, atlases.ofMaterial[0], 0);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      ASSERT_LE(difference(decoded.at(x, y), paint(x, y)), 8) << x << " " << y;
}

TEST(Atlas, MipsAverageInLinearLight) {
  const auto chess = [](int x, int y) {
    return (x + y) % 2 ? Rgba{255, 255, 255, 255} : Rgba{0, 0, 0, 255};
  };
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(64, 64, chess)}));
  // Half the light is code 188, not 128.
  EXPECT_LE(
      difference(Decoded(atlases.opaque, atlases.ofMaterial[0], 1).at(3, 3), {188, 188, 188, 255}),
      3);
}

TEST(Atlas, MipsDoNotTakeColorFromWhatIsInvisible) {
  const auto chess = [](int x, int y) { return (x + y) % 2 ? red : Rgba{0, 255, 0, 0}; };
  const SceneAtlases atlases = buildAtlases(sceneOf({texture(64, 64, chess)}));
  EXPECT_LE(
      difference(Decoded(atlases.transparent, atlases.ofMaterial[0], 1).at(3, 3), {255, 0, 0, 128}),
      2);
  const SceneAtlases clear = buildAtlases(sceneOf({texture(64, 64, solid({0, 0, 255, 0}))}));
  EXPECT_EQ(Decoded(clear.transparent, clear.ofMaterial[0], 2).at(0, 0), (Rgba{0, 0, 255, 0}));
}

TEST(Atlas, WhatDoesNotFitIsHalvedLargestFirst) {
  const Scene scene = sceneOf({texture(400, 200, solid(red)), texture(30, 30, solid(green))});
  const SceneAtlases atlases = buildAtlases(scene, 256);
  EXPECT_LE(atlases.opaque.width, 256);
  EXPECT_LE(atlases.opaque.height, 256);
  EXPECT_EQ(atlases.texturesHalved, 1u);
  const auto texels = [&](int i) {
    const glm::vec4 rect = atlases.ofMaterial[std::size_t(i)].rect;
    return glm::vec2(rect.z, rect.w) * glm::vec2(atlases.opaque.width, atlases.opaque.height);
  };
  EXPECT_EQ(texels(0), glm::vec2(100, 50));
  EXPECT_EQ(texels(1), glm::vec2(30, 30));
  EXPECT_EQ(Decoded(atlases.opaque, atlases.ofMaterial[0], 0).at(99, 49), red);
  EXPECT_EQ(Decoded(atlases.opaque, atlases.ofMaterial[1], 0).at(29, 29), green);
  EXPECT_EQ(buildAtlases(scene).texturesHalved, 0u);
}

TEST(Atlas, TooManyTexturesAreRefused) {
  EXPECT_NE(messageOf<InputError>([] {
              buildAtlases(sceneOf(std::vector<Texture>(5, texture(2, 2, solid(red)))), 256);
            }),
            "");
}

TEST(Atlas, IsTheSameEveryTime) {
  const auto paint = [](int x, int y) { return Rgba{(x * 37) % 256, (y * 91) % 256, x ^ y, 255}; };
  const Scene scene = sceneOf({texture(200, 100, paint), texture(50, 250, paint)});
  const Atlas a = buildAtlases(scene).opaque, b = buildAtlases(scene).opaque;
  for (std::size_t i = 0; i < a.levels.size(); ++i)
    EXPECT_EQ(a.levels[i].blocks, b.levels[i].blocks);
}

}  // namespace
}  // namespace oitlab
