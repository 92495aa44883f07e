#include <filesystem>

#include <gtest/gtest.h>

#include "scene/quads.h"
#include "support/temporary_folder.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

Scene gridScene(std::uint32_t columns, std::uint32_t rows) {
  Scene scene;
  scene.materials.resize(1);
  for (std::uint32_t y = 0; y <= rows; ++y)
    for (std::uint32_t x = 0; x <= columns; ++x)
      scene.vertices.push_back({{float(x), float(y), 0.0f}, 0, {0, 0}, ~0u, 0});
  for (std::uint32_t y = 0; y < rows; ++y)
    for (std::uint32_t x = 0; x < columns; ++x) {
      const std::uint32_t a = y * (columns + 1) + x, d = a + columns + 1;
      scene.triangles.emplace_back(a, a + 1, d + 1);
      scene.triangles.emplace_back(a, d + 1, d);
    }
  return scene;
}

class QuadCache : public TemporaryFolder {
 protected:
  std::filesystem::path file() const { return folder_ / filesInFolder().at(0); }

  // After damage to the file the quads are right, and the file is replaced.
  template <typename Damage>
  void expectRebuiltAfter(const std::string& what, Damage&& damage) {
    const std::string good = readTextFile(file());
    std::string bad = good;
    damage(bad);
    ASSERT_NE(bad, good) << what;
    writeFileAtomically(file(), bad);
    EXPECT_EQ(cachedQuads(scene_, folder_).quads, mesh_.quads) << what;
    EXPECT_EQ(readTextFile(file()), good) << what;
  }

  Scene scene_ = gridScene(9, 7);
  QuadMesh mesh_ = pairTriangles(scene_);
};

TEST_F(QuadCache, HoldsWhatPairingMakes) {
  for (int i = 0; i < 2; ++i) {
    const QuadMesh mesh = cachedQuads(scene_, folder_);
    EXPECT_EQ(mesh.quads, mesh_.quads);
    EXPECT_EQ(mesh.triangles, mesh_.triangles);
    EXPECT_EQ(mesh.degenerate, mesh_.degenerate);
    EXPECT_EQ(filesInFolder().size(), 1u);
  }
  EXPECT_EQ(cachedQuads(Scene(), folder_).quads.size(), 0u);
  EXPECT_EQ(cachedQuads(Scene(), folder_).quads.size(), 0u);
}

TEST_F(QuadCache, IsReadAndNotMadeAgain) {
  cachedQuads(scene_, folder_);
  const auto written = std::filesystem::last_write_time(file());
  std::filesystem::last_write_time(file(), written - std::chrono::hours(1));
  cachedQuads(scene_, folder_);
  EXPECT_EQ(std::filesystem::last_write_time(file()), written - std::chrono::hours(1));
}

TEST_F(QuadCache, IsRebuiltWhenDamaged) {
  cachedQuads(scene_, folder_);
  const std::size_t size = readTextFile(file()).size();
  for (const std::size_t length : {std::size_t(0), std::size_t(5), size - 24, size - 1})
    expectRebuiltAfter("cut to " + std::to_string(length),
                       [&](std::string& s) { s.resize(length); });
  expectRebuiltAfter("24 bytes more", [](std::string& s) { s.append(24, '\0'); });
  for (std::size_t at = 0; at < size; at += at < 80 ? 1 : 97)
    expectRebuiltAfter("byte " + std::to_string(at), [&](std::string& s) { s[at] ^= 0x40; });
}

TEST_F(QuadCache, IsNotTakenForAnotherScene) {
  cachedQuads(scene_, folder_);
  const std::filesystem::path first = file();
  Scene other = gridScene(7, 9);  // as many triangles
  cachedQuads(other, folder_);
  ASSERT_EQ(filesInFolder().size(), 2u);
  std::filesystem::path second;
  for (const std::string& name : filesInFolder())
    if (folder_ / name != first) second = folder_ / name;
  std::filesystem::copy_file(first, second, std::filesystem::copy_options::overwrite_existing);
  EXPECT_EQ(cachedQuads(other, folder_).quads, pairTriangles(other).quads);
}

TEST_F(QuadCache, IsDoneWithoutWhereItCannotBeWritten) {
  const auto blocked = folder_ / "file";
  writeFileAtomically(blocked, "not a folder");
  EXPECT_EQ(cachedQuads(scene_, blocked).quads, mesh_.quads);
}

}  // namespace
}  // namespace oitlab
