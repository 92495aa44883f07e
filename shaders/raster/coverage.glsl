// The samples (pixel centers) that a triangle covers. All arithmetic on snapped edges is exact, and two triangles that
// share an edge compute the same edge function with opposite signs. Therefore a mesh covers each sample once.
#ifndef OITLAB_RASTER_COVERAGE_GLSL
#define OITLAB_RASTER_COVERAGE_GLSL

#include "raster/triangles.glsl"

// Inside: c + a * i + b * j >= 0, where i and j count pixels from the region's first sample. c is the edge function
// divided by the subpixel steps and rounded down, which keeps the sign since a and b are whole numbers.
struct Edge {
  int c, a, b;
};

// Vulkan's rule for samples on an edge: they belong to the triangle to the right of the edge or below it.
bool ownsItsSamples(ivec2 direction) {
  return direction.y < 0 || (direction.y == 0 && direction.x > 0);
}

// `region`: the pixel from which i and j count. Valid for i and j in 0..31: an edge beyond +-2^30 is so far away that
// the sign is the same in the whole bin.
Edge makeEdge(ivec2 from, ivec2 to, ivec2 region) {
  const ivec2 d = to - from;
  const ivec2 s = (region << SUBPIXEL_BITS) + (1 << (SUBPIXEL_BITS - 1)) - from;
  const int64_t value = int64_t(d.x) * s.y - int64_t(d.y) * s.x - (ownsItsSamples(d) ? 0 : 1);
  const int64_t limit = int64_t(1) << 30;
  return Edge(int(clamp(value >> SUBPIXEL_BITS, -limit, limit)), -d.y, d.x);
}

bool rejectsBin(Edge e) {
  const int last = int(BIN_SIZE) - 1;
  return e.c + max(e.a, 0) * last + max(e.b, 0) * last < 0;
}

// Narrows [low, high] to the columns of row j that lie inside, in constant time (section 2, "Triangle
// rasterization"). The float quotient is wrong by at most one; integer arithmetic decides.
void narrow(Edge e, float inverseA, int j, inout int low, inout int high) {
  const int r = e.c + e.b * j;
  if (e.a == 0) {
    if (r < 0) high = -1;
    return;
  }
  const float quotient = clamp(-float(r) * inverseA, -1.0, 33.0);
  if (e.a > 0) {
    int i = int(ceil(quotient));
    if (r + e.a * (i - 1) >= 0) --i;
    if (r + e.a * i < 0) ++i;
    low = max(low, i);
  } else {
    int i = int(floor(quotient));
    if (r + e.a * (i + 1) >= 0) ++i;
    if (r + e.a * i < 0) --i;
    high = min(high, i);
  }
}

uint bitsBetween(int low, int high) {
  return low > high ? 0u : (0xffffffffu << low) & (0xffffffffu >> (31 - high));
}

// A triangle's edges within a region of at most 32 x 32 pixels.
struct RegionEdges {
  Edge edge[3];
  vec3 inverseA;
};

RegionEdges regionEdges(RasterTriangle t, ivec2 region) {
  RegionEdges r;
  r.edge[0] = makeEdge(t.v[0], t.v[1], region);
  r.edge[1] = makeEdge(t.v[1], t.v[2], region);
  r.edge[2] = makeEdge(t.v[2], t.v[0], region);
  r.inverseA = 1.0 / vec3(r.edge[0].a, r.edge[1].a, r.edge[2].a);
  return r;
}

// Bit i is set if the sample in column i, row j of the region is covered.
uint rowCoverage(RegionEdges r, int j) {
  int low = 0, high = 31;
  narrow(r.edge[0], r.inverseA.x, j, low, high);
  narrow(r.edge[1], r.inverseA.y, j, low, high);
  narrow(r.edge[2], r.inverseA.z, j, low, high);
  return bitsBetween(low, high);
}

// Unsnapped triangles: an edge between two snapped vertices is computed like that of a snapped neighbor. Other edges
// are 3D edge functions. The order of the edge's ends decides about samples exactly on it, on both sides in the same
// way.
bool comesBefore(vec3 a, vec3 b) {
  return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
}

// Vertices are read again wherever they are needed: few triangles are unsnapped, and registers for them would be
// taken from all triangles.
uint unsnappedRow(UnsnappedBuffer unsnapped, uint slot, float near, ivec2 region, int j) {
  const uint index = slot & ~UNSNAPPED;
  uint row = 0xffffffffu;
  [[dont_unroll]] for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    const uint both = 1u << k | 1u << next;
    if ((unsnapped.at[index].snaps & both) == both) {
      const Edge e = makeEdge(unsnapped.at[index].snapped[k], unsnapped.at[index].snapped[next], region);
      int low = 0, high = 31;
      narrow(e, 1.0 / float(e.a), j, low, high);
      row &= bitsBetween(low, high);
    } else {
      const vec3 from = unsnapped.at[index].p[k], to = unsnapped.at[index].p[next];
      const vec3 n = edgePlane(from, to);
      const bool owns = comesBefore(from, to);
      const float y = float(region.y + j) + 0.5;
      [[dont_unroll]] for (int i = 0; i < 32; ++i) {
        precise const float e = n.x * (float(region.x + i) + 0.5) + n.y * y + n.z;
        if (!(e > 0.0 || (e == 0.0 && owns))) row &= ~(1u << i);
      }
    }
  }
  const ShadeTriangle planes = unsnapped.at[index].shading;
  // Samples nearer than the near plane (or behind the eye) are not drawn.
  const float dy = float(region.y + j) + 0.5 - planes.anchor.y;
  [[dont_unroll]] for (int i = 0; i < 32; ++i) {
    const float dx = float(region.x + i) + 0.5 - planes.anchor.x;
    precise const float invW = planes.invW + planes.invWSlope.x * dx + planes.invWSlope.y * dy;
    if (!(invW > 0.0 && invW * near <= 1.0)) row &= ~(1u << i);
  }
  return row;
}

#endif
