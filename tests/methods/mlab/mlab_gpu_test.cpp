// MLAB is what a model in double precision says, is exact for as many layers as nodes and for
// sorted fragments, and keeps every image finite.
#include <gmock/gmock.h>

#include <random>

#include "quality/compare.h"
#include "support/planted.h"
#include "support/sources.h"

namespace oitlab::testing {
namespace {

class Mlab : public GpuTest {};

Given mlab(Given given) {
  given.emplace("node_format", "rgba32f");
  return onCompute(given);
}

/// A triangle across the view axis of frontCamera(), at `distance` from the eye.
std::array<glm::vec3, 3> across(float distance) {
  const float z = frontCamera().eye.z - distance;
  return {glm::vec3{-distance, -distance, z}, {distance, -distance, z}, {0, distance, z}};
}

struct Layer {
  float distance;
  glm::vec4 color;  // straight
};

Scene sceneOf(const std::vector<Layer>& layers) {
  std::vector<std::array<glm::vec3, 3>> triangles;
  std::vector<glm::vec4> colors;
  for (const Layer& layer : layers) {
    triangles.push_back(across(layer.distance));
    colors.push_back(layer.color);
  }
  return triangleScene(triangles, colors, frontCamera());
}

glm::dvec3 centerOf(const Image& image) {
  const float* p = image.at(image.width / 2, image.height / 2);
  return {p[0], p[1], p[2]};
}

struct Node {
  double distance;
  glm::dvec3 color;  // premultiplied
  double transmittance;
};

/// Salvi and Vaidyanathan 2014, with the choice of neighbors as mlab.glsl says.
std::vector<Node> inserted(std::vector<Node> nodes, const Node& fragment, std::size_t count,
                           bool leastError) {
  const auto place = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) {
    return fragment.distance < node.distance;
  });
  nodes.insert(place, fragment);
  if (nodes.size() <= count) return nodes;
  std::size_t front = count - 1;
  if (leastError) {
    double visible = 1, least = 2;
    for (std::size_t i = 0; i < count; ++i) {
      visible *= nodes[i].transmittance;
      const double covers = visible * (1 - nodes[i + 1].transmittance);
      if (covers <= least) least = covers, front = i;
    }
  }
  nodes[front].color += nodes[front].transmittance * nodes[front + 1].color;
  nodes[front].transmittance *= nodes[front + 1].transmittance;
  nodes.erase(nodes.begin() + std::ptrdiff_t(front) + 1);
  return nodes;
}

/// Twelve layers whose places in the order of submission have nothing to do with their depths.
std::vector<Layer> randomLayers(std::mt19937& random) {
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<Layer> layers;
  layers.reserve(12);
  for (int i = 0; i < 12; ++i)
    layers.push_back({1 + 0.1f * float(i),
                      {unit(random), unit(random), unit(random), 0.1f + 0.8f * unit(random)}});
  std::shuffle(layers.begin(), layers.end(), random);
  return layers;
}

TEST_F(Mlab, EqualsAModelInDoublePrecision) {
  std::mt19937 random(7);
  for (int repeat = 0; repeat < 3; ++repeat) {
    const std::vector<Layer> layers = randomLayers(random);
    std::vector<Node> fragments;  // as shaded: from images of one layer each
    const glm::dvec3 background(backgroundColor);
    for (const Layer& layer : layers) {
      RenderFixture fixture(sceneOf({layer}), 17, 17);
      const double alpha = std::round(layer.color.a * 255) / 255;  // as stored in 8 bits
      const glm::dvec3 seen = centerOf(fixture.render("reference", onCompute()).image);
      fragments.push_back({layer.distance, seen - (1 - alpha) * background, 1 - alpha});
    }
    RenderFixture fixture(sceneOf(layers), 17, 17);
    for (const std::size_t count : {1, 2, 4})
      for (const bool leastError : {false, true}) {
        std::vector<Node> nodes;
        for (const Node& fragment : fragments) nodes = inserted(nodes, fragment, count, leastError);
        glm::dvec3 expected(0);
        double transmittance = 1;
        for (const Node& node : nodes) {
          expected += transmittance * node.color;
          transmittance *= node.transmittance;
        }
        expected += transmittance * background;
        const auto result =
            fixture.render("mlab", mlab({{"nodes", std::to_string(count)},
                                         {"merge", leastError ? "least_error" : "last"}}));
        EXPECT_LT(glm::length(centerOf(result.image) - expected), 2e-5)
            << count << " nodes, merge=" << (leastError ? "least_error" : "last");
      }
  }
}

// Nothing is merged. Sums and products of transmittances round differently from the exact method's.
TEST_F(Mlab, AsManyNodesAsLayersAreExactInAnyOrder) {
  const Scene scene = randomSoup(3, 6);
  RenderFixture fixture(scene, 120, 70);
  const auto exact = fixture.render("reference", onCompute());
  for (const char* merge : {"last", "least_error"})
    for (const char* seed : {"0", "1"}) {
      const auto result = fixture.render(
          "mlab",
          mlab(
              {{"nodes", "6"}, {"merge", merge}, {"deliver", "shuffled"}, {"deliver_seed", seed}}));
      EXPECT_LT(compareImages(result.image, exact.image).maxError, 1e-5) << merge;
      EXPECT_EQ(result.frame.counters.at("fragments"), exact.frame.counters.at("fragments"));
    }
}

// From front to back nothing comes between merged fragments; from back to front the two farthest
// are merged, behind all that are still to come.
TEST_F(Mlab, BothSortedOrdersAreExact) {
  RenderFixture fixture(stack(40, 0.2f), 33, 21);
  const auto exact = fixture.render("reference", onCompute());
  for (const char* order : {"near_to_far", "far_to_near"})
    for (const char* nodes : {"1", "4"}) {
      const auto result = fixture.render("mlab", mlab({{"nodes", nodes}, {"deliver", order}}));
      EXPECT_LT(compareImages(result.image, exact.image).maxError, 1e-5) << order << " " << nodes;
    }
  const auto shuffled = fixture.render("mlab", mlab({{"nodes", "2"}, {"deliver", "shuffled"}}));
  EXPECT_GT(compareImages(shuffled.image, exact.image).maxError, 1e-2)
      << "without an order, two nodes are not enough";
}

// Opaque, invisible and nearly so, equal depths, many more layers than nodes.
TEST_F(Mlab, NoImageHasANanOrInfinity) {
  std::vector<Layer> layers;
  for (int i = 0; i < 64; ++i)
    for (const float alpha : {0.0f, 1.0f, 1 / 255.0f, 254 / 255.0f})
      layers.push_back({1 + 0.01f * float(i * 37 % 64), {1, 1, 1, alpha}});
  RenderFixture fixture(sceneOf(layers), 17, 17);
  for (const char* format : {"rgba8", "rgba16f", "rgba32f"})
    for (const char* merge : {"last", "least_error"}) {
      const auto result =
          fixture.render("mlab", onCompute({{"node_format", format}, {"merge", merge}}));
      for (int i = 0; i < 3; ++i) {
        EXPECT_GE(centerOf(result.image)[i], 0) << format << " " << merge;
        EXPECT_LE(centerOf(result.image)[i], 1) << format << " " << merge;
      }
    }
}

}  // namespace
}  // namespace oitlab::testing
