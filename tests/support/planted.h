#pragma once

#include "support/gpu.h"

namespace oitlab::testing {

/// Scenes in which the order of tri-half-blocks is often wrong.
std::vector<Scene> disorderlyScenes();

/// 60 rectangles turned about one upright axis, each through all others.
Scene fans();

/// `count` triangles that cover the whole frame from frontCamera(), `depthSpread` deep and each
/// tilted by up to `tilt`; 0, 0: all in one plane. Colours are random, alpha is `alpha`.
Scene layers(int count, float depthSpread, float tilt, float alpha);

/// Sheets in front of each other, all of whose order is known: triangle i is at z = -0.001 i.
Scene stack(int count, float alpha);

/// Makes triangles [first, end) of the scene opaque.
void makeOpaque(Scene& scene, std::size_t first);

/// A sheet of `cells` x `cells` quads over [-size, size] in the plane z = 0.
Scene sheet(int cells, float size);

/// Pixels whose red is `red`.
std::uint64_t pixelsOf(const Image& image, float red);

/// Pixels of `a` that are not those of `b`, bit for bit.
std::uint64_t pixelsThatDiffer(const Image& a, const Image& b);

}  // namespace oitlab::testing
