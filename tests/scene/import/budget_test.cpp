// What a scene file may ask for, before it gets it.
#include "scene/import/budget.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "scene/import/gltf.h"
#include "scene/import/obj.h"
#include "support/glb.h"
#include "support/temporary_folder.h"
#include "util/error.h"

namespace oitlab {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A variable of the environment for one test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
  ~Variable() { ::unsetenv(name_); }

 private:
  const char* name_;
};

/// The head of a PNG of this size, without its texels: what tells its size.
std::string pngHead(std::uint32_t width, std::uint32_t height) {
  const auto word = [](std::uint32_t value) {
    std::string text;
    for (const int shift : {24, 16, 8, 0}) text += char(value >> shift & 255u);
    return text;
  };
  return std::string("\x89PNG\r\n\x1a\n", 8) + word(13) + "IHDR" + word(width) + word(height) +
         std::string("\x08\x06\0\0\0", 5) + word(0) + word(0) + "IDAT" + word(0);
}

GlbBuilder oneTriangle() {
  GlbBuilder glb;
  const int mesh =
      glb.mesh({{"POSITION", glb.positions({0, 0, 0, 1, 0, 0, 0, 1, 0})}}, {{"material", 0}});
  glb.node({{"mesh", mesh}});
  glb.json["materials"] = nlohmann::json::array({nlohmann::json::object()});
  return glb;
}

class Budgets : public TemporaryFolder {};

TEST_F(Budgets, ManyLargeImagesInASmallFile) {
  GlbBuilder glb = oneTriangle();
  constexpr int count = 20;
  const std::string head = pngHead(16384, 16384);
  for (int i = 0; i < count; ++i) {
    const int view = glb.bufferView(head.data(), head.size());
    glb.json["images"].push_back({{"bufferView", view}, {"mimeType", "image/png"}});
    glb.json["textures"].push_back({{"source", i}});
    glb.json["materials"][std::size_t(i)] = {
        {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}};
  }
  const std::string path = glb.write(folder_ / "greedy.glb");
  EXPECT_LT(std::filesystem::file_size(path), 40'000u);
  // 268 M texels each: the fourth reaches the limit of 1 G, the fifth is beyond it.
  EXPECT_THAT(messageOf<InputError>([&] { loadGltf(path); }),
              AllOf(HasSubstr("greedy.glb: image 4"), HasSubstr("1342177280 texels"),
                    HasSubstr("it may have 1073741824"), HasSubstr("OITLAB_SCENE_TEXELS")));
}

TEST_F(Budgets, AMeshThatIsUsedOverAndOver) {
  GlbBuilder glb = oneTriangle();
  for (int i = 0; i < 99; ++i) glb.node({{"mesh", 0}});
  const std::string path = glb.write(folder_ / "many.glb");
  EXPECT_EQ(loadGltf(path).triangles.size(), 100u);
  const Variable limit("OITLAB_SCENE_VERTICES", "299");
  EXPECT_THAT(
      messageOf<InputError>([&] { loadGltf(path); }),
      AllOf(HasSubstr("many.glb"), HasSubstr("300 vertices"), HasSubstr("it may have 299")));
}

TEST_F(Budgets, ObjFilesHaveOneToo) {
  GlbBuilder::writeFile(folder_ / "x.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 3\n");
  EXPECT_EQ(loadObj(folder_ / "x.obj").triangles.size(), 2u);
  const Variable limit("OITLAB_SCENE_BYTES", "200");  // 2 triangles are 6 * 32 + 2 * 12 bytes
  EXPECT_THAT(messageOf<InputError>([&] { loadObj(folder_ / "x.obj"); }),
              AllOf(HasSubstr("x.obj"), HasSubstr("bytes"), HasSubstr("OITLAB_SCENE_BYTES")));
}

TEST_F(Budgets, ALimitIsANumber) {
  for (const char* wrong : {"", "0", "-1", "1e9", "many"}) {
    const Variable limit("OITLAB_SCENE_TEXELS", wrong);
    EXPECT_THAT(messageOf<InputError>([] { SceneLimits::fromEnvironment(); }),
                HasSubstr("expected a whole number"))
        << wrong;
  }
}

}  // namespace
}  // namespace oitlab
