#include "scene/camera.h"

#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "util/error.h"

namespace oitlab {
namespace {

using ::testing::HasSubstr;

constexpr float pi = std::numbers::pi_v<float>;

glm::vec3 project(const Camera& camera, glm::vec3 point, float aspect = 1.0f) {
  const glm::vec4 clip =
      camera.projectionMatrix(aspect) * camera.viewMatrix() * glm::vec4(point, 1);
  return glm::vec3(clip) / clip.w;
}

void expectNear(glm::vec3 found, glm::vec3 wanted, float tolerance = 1e-5f) {
  EXPECT_LT(glm::distance(found, wanted), tolerance)
      << found.x << " " << found.y << " " << found.z << " against " << wanted.x << " " << wanted.y
      << " " << wanted.z;
}

const Bounds testBounds{{-1, -2, -3}, {3, 2, 1}};  // centre (1, 0, -1), radius 2 sqrt(3)

TEST(Camera, DepthIsReversedAndInfinite) {
  const Camera camera{.eye = {0, 0, 5}, .near = 0.5f};
  EXPECT_FLOAT_EQ(project(camera, {0, 0, 4.5f}).z, 1.0f);
  EXPECT_FLOAT_EQ(project(camera, {0, 0, 0}).z, 0.1f);
  EXPECT_GT(project(camera, {0, 0, -1e6f}).z, 0.0f);
  EXPECT_LT(project(camera, {0, 0, -1e6f}).z, 1e-6f);
}

TEST(Camera, ScreenHasXRightAndYDown) {
  const Camera camera{.eye = {0, 0, 5}, .fovY = 0.5f * pi};  // the edge is at 45 degrees
  const glm::vec3 corner = project(camera, {5, 5, 0});
  EXPECT_NEAR(corner.x, 1.0f, 1e-5f);
  EXPECT_NEAR(corner.y, -1.0f, 1e-5f);
  EXPECT_NEAR(project(camera, {5, 5, 0}, 2.0f).x, 0.5f, 1e-5f);
  EXPECT_NEAR(project(camera, {5, 5, 0}, 2.0f).y, -1.0f, 1e-5f);
}

TEST(Camera, OrbitTurnsFromPlusZTowardsPlusX) {
  expectNear(orbitCamera({1, 2, 3}, 2, 0, 0, 1).eye, {1, 2, 5});
  expectNear(orbitCamera({1, 2, 3}, 2, 0.5f * pi, 0, 1).eye, {3, 2, 3});
  expectNear(orbitCamera({1, 2, 3}, 2, 0, 0.5f * pi, 1).eye, {1, 4, 3});
}

TEST(Camera, StraightDownIsAPictureToo) {
  for (const float pitch : {-0.5f * pi, 0.5f * pi}) {
    const glm::mat4 view = orbitCamera({0, 0, 0}, 2, 0.3f, pitch, 1).viewMatrix();
    EXPECT_NEAR(glm::determinant(view), 1.0f, 1e-4f);
  }
  const Camera down{.eye = {0, 5, 0}};  // up along the view
  EXPECT_NEAR(glm::determinant(down.viewMatrix()), 1.0f, 1e-4f);
  expectNear(project(down, {0, 0, 0}), {0, 0, 0.002f});
}

TEST(Camera, OrbitShowsWhatPlusYWouldShow) {
  Camera camera = orbitCamera({0, 0, 0}, 3, 0.7f, 0.4f, 1);
  const glm::vec3 point(0.3f, 0.4f, -0.2f);
  const glm::vec3 orbit = project(camera, point);
  camera.up = {0, 1, 0};
  expectNear(orbit, project(camera, point));
}

TEST(Camera, DepthRangeIsThatOfTheCornersBeyondTheNearPlane) {
  Camera camera;
  camera.eye = {0, 0, 10};
  camera.target = {0, 0, 0};
  camera.near = 0.5f;
  const Bounds bounds{{-1, -2, -3}, {1, 2, 3}};
  const DepthRange outside = depthRange(camera, bounds);
  EXPECT_FLOAT_EQ(outside.nearest, 7);
  EXPECT_FLOAT_EQ(outside.farthest, 13);
  camera.eye = {0, 0, 1};  // within the bounds: the near plane is the nearest
  const DepthRange within = depthRange(camera, bounds);
  EXPECT_FLOAT_EQ(within.nearest, 0.5f);
  EXPECT_FLOAT_EQ(within.farthest, 4);
  camera.target = {0, 0, 20};  // looks away: the range still has a length
  camera.eye = {0, 0, 10};
  const DepthRange behind = depthRange(camera, bounds);
  EXPECT_FLOAT_EQ(behind.nearest, 0.5f);
  EXPECT_GT(behind.farthest, behind.nearest);
}

TEST(Camera, OverviewLooksAtTheCentreFromTwiceTheRadius) {
  const Camera camera = overviewCamera(testBounds);
  expectNear(camera.target, {1, 0, -1});
  EXPECT_NEAR(glm::distance(camera.eye, camera.target), 2 * testBounds.radius(), 1e-4f);
  EXPECT_GT(camera.near, 0.0f);
  EXPECT_GT(overviewCamera({}).near, 0.0f) << "a scene that is one point";
}

TEST(ParseCamera, Orbit) {
  const Camera camera = parseCamera("orbit:0, 0.5,10", testBounds);
  expectNear(camera.target, testBounds.center());
  EXPECT_NEAR(glm::distance(camera.eye, camera.target), 10, 1e-5f);
  EXPECT_NEAR(camera.eye.y, 10 * std::sin(0.5f), 1e-5f);
  EXPECT_NEAR(camera.fovY, pi / 3, 1e-6f);
  EXPECT_NEAR(parseCamera("orbit:0,0,10,90", testBounds).fovY, pi / 2, 1e-6f);
}

TEST(ParseCamera, Look) {
  const Camera camera = parseCamera("look:1,2,3,-4.5,5,1e1,70", testBounds);
  expectNear(camera.eye, {1, 2, 3});
  expectNear(camera.target, {-4.5f, 5, 10});
  EXPECT_NEAR(camera.fovY, 70 * pi / 180, 1e-6f);
  EXPECT_NEAR(parseCamera("look:0,0,0,1,0,0", testBounds).fovY, pi / 3, 1e-6f);
}

TEST(ParseCamera, RefusesWhatItCannotMean) {
  for (const char* text :
       {"", "orbit", "orbit:", "orbit:1,2", "orbit:1,2,3,4,5", "orbit:1,2,x", "orbit:1,2,3,",
        "orbit:1,2,nan", "orbit:inf,0,1", "orbit:1 2 3", "look:1,2,3,4,5", "look:1,2,3,4,5,6,7,8",
        "orbit:1,2,1e60", "Look:1,2,3,4,5,6"})
    EXPECT_THAT(messageOf<InputError>([&] { parseCamera(text, testBounds); }),
                HasSubstr("orbit:YAW,PITCH,DISTANCE"))
        << text;
  const auto refused = [](const char* text, const char* why) {
    EXPECT_THAT(messageOf<InputError>([&] { parseCamera(text, testBounds); }), HasSubstr(why))
        << text;
  };
  refused("orbit:0,0,0", "distance is 0");
  refused("orbit:0,0,-1", "distance is -1");
  refused("orbit:0,0,1,180", "field of view is 180");
  refused("look:0,0,0,1,1,1,0", "field of view is 0");
  refused("look:1,2,3,1,2,3", "same point");
}

}  // namespace
}  // namespace oitlab
