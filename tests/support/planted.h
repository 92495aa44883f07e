#pragma once

#include "support/gpu.h"

namespace oitlab::testing {

/// Scenes in which the order of tri-half-blocks is often wrong.
std::vector<Scene> disorderlyScenes();

/// 60 rectangles around one vertical axis, each of which intersects all others.
Scene fans();

/// `count` triangles that each cover the whole frame of frontCamera(). Their depths are spread over
/// `depthSpread`, and each is tilted by up to `tilt`; if both are 0 they are in one plane. Colours
/// are random, and alpha is `alpha`.
Scene layers(int count, float depthSpread, float tilt, float alpha);

/// Sheets behind each other in a known order: triangle i is at z = -0.001 i.
Scene stack(int count, float alpha);

/// Makes triangles [first, end) of the scene opaque.
void makeOpaque(Scene& scene, std::size_t first);

/// A sheet of `cells` x `cells` quads over [-size, size] in the plane z = 0.
Scene sheet(int cells, float size);

/// The number of pixels whose red is `red`.
std::uint64_t pixelsOf(const Image& image, float red);

/// The number of pixels that differ between `a` and `b`, bit for bit.
std::uint64_t pixelsThatDiffer(const Image& a, const Image& b);

}  // namespace oitlab::testing
