// Which files a scene may read.
#include "scene/import/scene_folder.h"

#include <sys/stat.h>

#include <gmock/gmock.h>

#include "scene/import/obj.h"
#include "support/gltf.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A secret beside the scene's folder, and a FIFO inside it.
class SceneFiles : public TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    std::filesystem::create_directories(folder_ / "scene" / "sub");
    writeFileAtomically(folder_ / "secret.bin", std::string(36, '\0'));
    writeFileAtomically(folder_ / "scene" / "x.bin", std::string(36, '\0'));
    ASSERT_EQ(mkfifo((folder_ / "scene" / "fifo").c_str(), 0600), 0);
  }

  std::string gltf(const char* what, const std::string& uri) {
    GlbBuilder glb;
    glb.node({{"mesh", glb.mesh({{"POSITION", glb.positions(triangleCorners)}})}});
    glb.json["buffers"] = {{{"uri", "x.bin"}, {"byteLength", 36}}};
    if (std::string(what) == "buffer")
      glb.json["buffers"][0]["uri"] = uri;
    else
      glb.json["images"] = {{{"uri", uri}}};
    return GlbBuilder::writeFile(folder_ / "scene" / "x.gltf", glb.json.dump());
  }
  std::string obj(const std::string& library, const std::string& texture) {
    writeFileAtomically(folder_ / "scene" / "x.mtl", "newmtl m\nmap_Kd " + texture + "\n");
    writeFileAtomically(folder_ / "scene" / "x.obj",
                        "mtllib " + library + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    return (folder_ / "scene" / "x.obj").string();
  }
};

TEST_F(SceneFiles, OutsideTheFolderAreRefusedUnlessAllowed) {
  const std::string absolute = (folder_ / "secret.bin").string();
  for (const char* what : {"buffer", "image"})
    for (const std::string& uri :
         {absolute, std::string("../secret.bin"), std::string("sub/../../secret.bin"),
          std::string("%2e%2e/secret.bin")}) {
      SCOPED_TRACE(what + (" " + uri));
      const std::string path = gltf(what, uri);
      EXPECT_THAT(messageOf<InputError>([&] { loadGltf(path); }),
                  AllOf(HasSubstr("x.gltf"), HasSubstr("secret.bin"), HasSubstr("outside"),
                        HasSubstr("--allow-outside")));
      EXPECT_EQ(messageOf<InputError>([&] { loadGltf(path, true); }), "");
    }
  const std::vector<std::pair<std::string, std::string>> objs = {{"x.mtl", "../secret.bin"},
                                                                 {"../secret.bin", "x"},
                                                                 {absolute, "x"},
                                                                 {"x.mtl", "..\\secret.bin"}};
  for (const auto& [library, texture] : objs) {
    SCOPED_TRACE(library + " " + texture);
    const std::string path = obj(library, texture);
    EXPECT_THAT(messageOf<InputError>([&] { loadObj(path); }), HasSubstr("--allow-outside"));
    EXPECT_EQ(messageOf<InputError>([&] { loadObj(path, true); }), "");
  }
}

TEST_F(SceneFiles, InsideTheFolderAreRead) {
  for (const char* uri : {"x.bin", "./x.bin", "sub/../x.bin"})
    EXPECT_EQ(messageOf<InputError>([&] { loadGltf(gltf("buffer", uri)); }), "") << uri;
}

TEST_F(SceneFiles, OfTheWorkingFolderAreNotRead) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_);
  EXPECT_THAT(messageOf<InputError>([&] { loadGltf(gltf("buffer", "secret.bin")); }),
              HasSubstr("secret.bin"));
  std::filesystem::current_path(before);
}

TEST_F(SceneFiles, ThatAreNotRegularAreRefusedEvenIfAllowed) {
  for (const bool allowed : {false, true}) {
    for (const char* what : {"buffer", "image"})
      EXPECT_THAT(messageOf<InputError>([&] { loadGltf(gltf(what, "fifo"), allowed); }),
                  HasSubstr("not a regular file"))
          << what;
    EXPECT_THAT(messageOf<InputError>([&] { loadObj(obj("x.mtl", "fifo"), allowed); }),
                HasSubstr("not a regular file"));
  }
  EXPECT_THAT(messageOf<InputError>([&] { loadGltf(gltf("buffer", "/dev/zero"), true); }),
              HasSubstr("not a regular file"));
}

TEST_F(SceneFiles, ASceneThatIsADeviceEnds) {
  for (const char* name : {"x.obj", "x.gltf", "x.glb"}) {
    std::filesystem::remove(folder_ / name);
    std::filesystem::create_symlink("/dev/zero", folder_ / name);
    const SceneSpec spec{(folder_ / name).string()};
    EXPECT_THAT(messageOf<InputError>([&] { loadScene(spec); }), HasSubstr("not a regular file"));
  }
}

}  // namespace
}  // namespace oitlab
