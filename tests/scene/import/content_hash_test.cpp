#include "scene/import/content_hash.h"

#include <fstream>

#include <gtest/gtest.h>

#include "support/gltf.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

class ContentHash : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    writeGltf(folder_ / "x.gltf");
    write("x.bin", std::string(36, '\0'));
    write("a b.png", png(1, 1, {1, 2, 3, 255}));
    write("y.obj", "mtllib y.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write("y.mtl", "newmtl m\nmap_Kd tex/y.png\n");
    write("tex/y.png", png(1, 1, {1, 2, 3, 255}));
  }

  static void writeGltf(const std::filesystem::path& path) {
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)}})}});
    glb.json["images"] = {{{"uri", "a%20b.png"}}};
    glb.json["buffers"] = {{{"uri", "x.bin"}, {"byteLength", 36}}};
    GlbBuilder::writeFile(path, glb.json.dump());
  }

  void write(const char* name, const std::string& bytes) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    writeFileAtomically(folder_ / name, bytes);
    age(name);
  }
  /// Written long ago, or the hash is not kept.
  void age(const char* name) {
    std::filesystem::last_write_time(
        folder_ / name, std::filesystem::file_time_type::clock::now() - std::chrono::hours(1));
  }
  std::optional<std::string> hash(const char* name) const {
    return sceneContentHash(folder_ / name, false, folder_ / "cache");
  }
  std::size_t kept() const {
    std::error_code none;
    return std::size_t(
        std::distance(std::filesystem::directory_iterator(folder_ / "cache", none), {}));
  }
};

TEST_F(ContentHash, ChangesWithEveryFileThatTheSceneNames) {
  for (const auto& [scene, files] : std::map<const char*, std::vector<const char*>>{
           {"x.gltf", {"x.gltf", "x.bin", "a b.png"}}, {"y.obj", {"y.obj", "y.mtl", "tex/y.png"}}})
    for (const char* file : files) {
      SCOPED_TRACE(file);
      const auto before = hash(scene);
      ASSERT_TRUE(before);
      std::string bytes = readTextFile(folder_ / file);
      bytes.back() = char(bytes.back() ^ 1);  // of the same size
      write(file, bytes);
      EXPECT_NE(hash(scene), before);
      bytes.back() = char(bytes.back() ^ 1);
      write(file, bytes);
      EXPECT_EQ(hash(scene), before);
    }
}

TEST_F(ContentHash, ChangesWithAFileWhoseTimeWasSetBack) {
  const auto before = hash("y.obj");
  ASSERT_GT(kept(), 0u);
  const auto path = folder_ / "y.mtl";
  const auto time = std::filesystem::last_write_time(path);
  // The same file, as an editor that writes in place leaves it, and of the same size.
  std::ofstream(path) << "newmtl m\nmap_Ks tex/y.png\n";
  std::filesystem::last_write_time(path, time);
  EXPECT_NE(hash("y.obj"), before);
}

TEST_F(ContentHash, IsThatOfTheContentsWhereverTheyAre) {
  age("x.gltf");
  const auto here = hash("x.gltf");
  std::filesystem::create_directories(folder_ / "copy");
  for (const char* name : {"x.gltf", "x.bin", "a b.png"})
    std::filesystem::copy_file(folder_ / name, folder_ / "copy" / name);
  EXPECT_EQ(hash("copy/x.gltf"), here);
}

TEST_F(ContentHash, NoticesThatAMissingFileAppears) {
  std::filesystem::remove(folder_ / "tex/y.png");
  const auto without = hash("y.obj");
  write("tex/y.png", png(1, 1, {1, 2, 3, 255}));
  EXPECT_NE(hash("y.obj"), without);
}

TEST_F(ContentHash, IsKeptForOldFilesAndFoundAgain) {
  const auto first = hash("y.obj");
  EXPECT_EQ(kept(), 1u);
  // Proof that it is not computed again: then it would be written again.
  const auto kept = std::filesystem::directory_iterator(folder_ / "cache")->path();
  const auto old = std::filesystem::last_write_time(kept) - std::chrono::hours(1);
  std::filesystem::last_write_time(kept, old);
  EXPECT_EQ(hash("y.obj"), first);
  EXPECT_EQ(std::filesystem::last_write_time(kept), old);
}

TEST_F(ContentHash, IsNotKeptForFilesThatMayChangeWithinTheStepOfTheirTime) {
  writeFileAtomically(folder_ / "y.mtl", "newmtl m\n");
  EXPECT_TRUE(hash("y.obj"));
  EXPECT_EQ(kept(), 0u);
}

TEST_F(ContentHash, IsThatOfTheFileAloneWhereItCannotBeLoaded) {
  write("z.gltf", "{");
  const auto before = hash("z.gltf");
  EXPECT_TRUE(before);
  write("z.gltf", "[");
  EXPECT_NE(hash("z.gltf"), before);
}

TEST_F(ContentHash, IsEmptyWhereThereIsNoFile) {
  EXPECT_EQ(hash("boxes"), std::nullopt);
  std::filesystem::create_directories(folder_ / "folder.glb");
  EXPECT_EQ(hash("folder.glb"), std::nullopt);
}

}  // namespace
}  // namespace oitlab
