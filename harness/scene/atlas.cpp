#include "scene/atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <stb_dxt.h>
#include <stb_rect_pack.h>

#include "scene/linear_image.h"
#include "util/check.h"
#include "util/error.h"
#include "util/parallel.h"

namespace oitlab {
namespace {

// Six levels reduce a texture of 1024 texels to 32. Each further level doubles the width of the
// borders, which at six levels are an eighth of that texture's side.
constexpr int levelCount = 6;

// One texel at the last level: bilinear filtering needs it.
constexpr int border = 1 << (levelCount - 1);

// Cells start and end at multiples of this, so that each 4x4 block of the last level belongs to one
// cell.
constexpr int cellSize = 4 << (levelCount - 1);

struct Placed {
  int texture = 0;  // index into Scene::textures
  int halvings = 0;
  int width = 0, height = 0;  // texels, after halving
  int cellX = 0, cellY = 0;   // in units of cellSize
  int cellColumns = 0, cellRows = 0;

  void halve() {
    width = (width + 1) / 2;
    height = (height + 1) / 2;
    ++halvings;
  }
};

int cellsFor(int texels) {
  return (texels + 2 * border + cellSize - 1) / cellSize;
}

// Packs into a square of `side` cells. Returns the height used, or 0 when they do not fit.
int pack(std::vector<Placed>& textures, int side) {
  std::vector<stbrp_rect> rects;
  for (const Placed& t : textures) rects.push_back({.id = 0, .w = t.cellColumns, .h = t.cellRows});
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(side));
  stbrp_context context;
  stbrp_init_target(&context, side, side, nodes.data(), side);
  if (!stbrp_pack_rects(&context, rects.data(), int(rects.size()))) return 0;
  int height = 0;
  for (std::size_t i = 0; i < rects.size(); ++i) {
    textures[i].cellX = rects[i].x;
    textures[i].cellY = rects[i].y;
    height = std::max(height, rects[i].y + rects[i].h);
  }
  return height;
}

// Places all textures and halves the largest until they fit. Returns the size in cells.
std::pair<int, int> place(std::vector<Placed>& textures, int maxCells) {
  const auto size = [](const Placed& t) { return std::max(t.width, t.height); };
  for (;;) {
    int area = 0, side = 1;
    for (Placed& t : textures) {
      t.cellColumns = cellsFor(t.width);
      t.cellRows = cellsFor(t.height);
      area += t.cellColumns * t.cellRows;
      side = std::max({side, t.cellColumns, t.cellRows});
    }
    for (side = std::max(side, int(std::ceil(std::sqrt(area)))); side <= maxCells; ++side)
      if (const int height = pack(textures, side)) return {side, height};

    const int largest = size(*std::ranges::max_element(textures, {}, size));
    if (largest == 1)
      fail<InputError>("the scene's {} textures do not fit into an atlas of {} x {} texels",
                       textures.size(), maxCells * cellSize, maxCells * cellSize);
    for (Placed& t : textures)
      if (size(t) == largest) t.halve();
  }
}

// Compresses `image` into the level's blocks from block (x, y).
void compress(const LinearImage& image, bool alpha, int x, int y, Atlas::Level& level) {
  const std::size_t blockBytes = alpha ? 16 : 8;
  const auto blocksPerRow = std::size_t(level.width / 4);
  for (int row = 0; row < image.height / 4; ++row)
    for (int column = 0; column < image.width / 4; ++column) {
      std::uint8_t texels[16][4];
      for (int i = 0; i < 16; ++i) {
        const auto texel = encodeTexel(image.at(4 * column + i % 4, 4 * row + i / 4));
        std::copy(texel.begin(), texel.end(), texels[i]);
      }
      const std::size_t block = std::size_t(y + row) * blocksPerRow + std::size_t(x + column);
      stb_compress_dxt_block(&level.blocks[block * blockBytes], texels[0], alpha, STB_DXT_HIGHQUAL);
    }
}

void fill(const Texture& texture, const Placed& placed, Atlas& atlas) {
  LinearImage image = linearImage(texture, atlas.alpha);
  for (int i = 0; i < placed.halvings; ++i) image = halved(image);
  image = repeated(image, border, placed.cellColumns * cellSize, placed.cellRows * cellSize);
  for (int i = 0; i < levelCount; ++i) {
    if (i > 0) image = halved(image);
    const int cellBlocks = (cellSize / 4) >> i;
    compress(image, atlas.alpha, placed.cellX * cellBlocks, placed.cellY * cellBlocks,
             atlas.levels[std::size_t(i)]);
  }
}

// `textures` are indices into Scene::textures, without duplicates.
Atlas buildAtlas(const Scene& scene, std::vector<Placed>& textures, bool alpha, int maxSide) {
  Atlas atlas{.alpha = alpha};
  if (textures.empty()) return atlas;
  const auto [columns, rows] = place(textures, maxSide / cellSize);
  atlas.width = columns * cellSize;
  atlas.height = rows * cellSize;
  for (int i = 0; i < levelCount; ++i) {
    Atlas::Level& level = atlas.levels.emplace_back();
    level.width = atlas.width >> i;
    level.height = atlas.height >> i;
    level.blocks.resize(std::size_t(level.width / 4) * std::size_t(level.height / 4) *
                        (alpha ? 16 : 8));
  }
  parallelFor(textures.size(), [&](std::size_t i) {
    fill(scene.textures[std::size_t(textures[i].texture)], textures[i], atlas);
  });
  return atlas;
}

}  // namespace

SceneAtlases buildAtlases(const Scene& scene, int maxSide) {
  OITLAB_CHECK_OP(maxSide % cellSize, ==, 0);
  OITLAB_CHECK_OP(maxSide, >, 0);
  std::vector<bool> hasAlpha;
  for (const Texture& texture : scene.textures) hasAlpha.push_back(texture.hasAlpha());
  const auto wantsAlpha = [&](const Material& material) {
    return !material.ignoreTextureAlpha && hasAlpha[std::size_t(material.texture)];
  };

  SceneAtlases result;
  result.ofMaterial.resize(scene.materials.size());
  for (const bool alpha : {false, true}) {
    std::vector<Placed> textures;
    std::vector<int> slot(scene.textures.size(), -1);
    for (const Material& material : scene.materials)
      if (material.texture >= 0 && wantsAlpha(material) == alpha)
        if (int& mine = slot[std::size_t(material.texture)]; mine == -1) {
          const Texture& texture = scene.textures[std::size_t(material.texture)];
          mine = int(textures.size());
          textures.push_back(
              {.texture = material.texture, .width = texture.width, .height = texture.height});
        }
    Atlas& atlas = alpha ? result.transparent : result.opaque;
    atlas = buildAtlas(scene, textures, alpha, maxSide);
    for (const Placed& t : textures) result.texturesHalved += t.halvings > 0;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
      const Material& material = scene.materials[i];
      if (material.texture < 0 || wantsAlpha(material) != alpha) continue;
      const Placed& t = textures[std::size_t(slot[std::size_t(material.texture)])];
      const glm::vec2 size(atlas.width, atlas.height);
      const glm::vec2 offset =
          glm::vec2(t.cellX * cellSize + border, t.cellY * cellSize + border) / size;
      result.ofMaterial[i] = {alpha ? 2u : 1u,
                              glm::vec4(offset, glm::vec2(t.width, t.height) / size)};
    }
  }
  return result;
}

}  // namespace oitlab
