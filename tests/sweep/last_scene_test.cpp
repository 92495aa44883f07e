// A sweep over sizes and views loads its scene once.
#include "sweep/last_scene.h"

#include "support/gpu.h"
#include "util/error.h"

namespace oitlab::testing {
namespace {

class LastSceneGpu : public GpuTest {};

TEST_F(LastSceneGpu, IsKeptUntilAnotherIsWanted) {
  LastScene last(sharedDevice());
  const SceneSpec boxes{"boxes", {}, 0.01f};
  const GpuScene* first = &last.get(boxes);
  const Vertex* vertices = first->scene().vertices.data();
  EXPECT_EQ(&last.get(boxes), first);
  EXPECT_EQ(last.get(boxes).scene().vertices.data(), vertices);
  EXPECT_EQ(last.get({"boxes", 0.25f, 0.01f}).scene().materials[0].baseColor.a, 0.25f);
  const auto triangles = last.get(boxes).scene().triangles.size();
  EXPECT_GT(last.get({"boxes", {}, 0.02f}).scene().triangles.size(), triangles);
  EXPECT_EQ(last.get({"planes", {}, 0.01f}).scene().name, "planes");
}

// After a scene that cannot be loaded there is none, and the next one is loaded as usual.
TEST_F(LastSceneGpu, SurvivesASceneThatIsNotThere) {
  LastScene last(sharedDevice());
  const SceneSpec boxes{"boxes", {}, 0.01f};
  const auto triangles = last.get(boxes).scene().triangles.size();
  EXPECT_THROW(last.get({"not_there.glb", {}, 1.0f}), InputError);
  EXPECT_EQ(last.get(boxes).scene().triangles.size(), triangles);
}

}  // namespace
}  // namespace oitlab::testing
