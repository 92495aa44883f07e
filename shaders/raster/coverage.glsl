// Which samples (pixel centres) a triangle covers. All arithmetic on snapped edges is exact, and an
// edge that two triangles share is the same edge, negated, in both: a mesh covers each sample once.
#ifndef OITLAB_RASTER_COVERAGE_GLSL
#define OITLAB_RASTER_COVERAGE_GLSL

#include "raster/records.glsl"

// c + a * i + b * j >= 0 inside, i and j pixels from the region's first sample: the edge function in
// units of a pixel, rounded down, which keeps its sign since the steps are whole.
struct Edge {
  int c, a, b;
};

// Vulkan's rule for samples on an edge: they belong to the triangle right of or below it.
bool ownsItsSamples(ivec2 direction) {
  return direction.y < 0 || (direction.y == 0 && direction.x > 0);
}

// `region`: the pixel that i and j count from. Valid for i and j in 0..31: beyond +-2^30 the edge is
// so far away that its sign is the same over the whole bin.
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

// Narrows [low, high] to the columns of row j that lie inside, in constant time (section 2,
// "Triangle rasterization"). The float quotient is off by one at most; whole numbers decide.
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

// Bit i: the sample of column i, row j of the region is covered.
uint rowCoverage(RegionEdges r, int j) {
  int low = 0, high = 31;
  narrow(r.edge[0], r.inverseA.x, j, low, high);
  narrow(r.edge[1], r.inverseA.y, j, low, high);
  narrow(r.edge[2], r.inverseA.z, j, low, high);
  return bitsBetween(low, high);
}

// Irregular triangles: an edge between snapped vertices is that of the neighbour's, others are 3D
// edge functions. Samples exactly on these go by an order of their ends, the same for both sides.
bool comesBefore(vec3 a, vec3 b) {
  return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
}

// Vertices are read where they are needed: few triangles are irregular, and registers kept for them
// would be taken from all.
uint irregularRow(IrregularBuffer irregular, uint slot, float near, ivec2 region, int j) {
  const uint index = slot & ~IRREGULAR;
  uint row = 0xffffffffu;
  [[dont_unroll]] for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    const uint both = 1u << k | 1u << next;
    if ((irregular.at[index].snaps & both) == both) {
      const Edge e = makeEdge(irregular.at[index].snapped[k], irregular.at[index].snapped[next], region);
      int low = 0, high = 31;
      narrow(e, 1.0 / float(e.a), j, low, high);
      row &= bitsBetween(low, high);
    } else {
      const vec3 from = irregular.at[index].p[k], to = irregular.at[index].p[next];
      const vec3 n = edgePlane(from, to);
      const bool owns = comesBefore(from, to);
      const float y = float(region.y + j) + 0.5;
      [[dont_unroll]] for (int i = 0; i < 32; ++i) {
        precise const float e = n.x * (float(region.x + i) + 0.5) + n.y * y + n.z;
        if (!(e > 0.0 || (e == 0.0 && owns))) row &= ~(1u << i);
      }
    }
  }
  const ShadeTriangle planes = irregular.at[index].shading;
  // Nothing nearer than the near plane (or behind the eye) is drawn.
  const float dy = float(region.y + j) + 0.5 - planes.anchor.y;
  [[dont_unroll]] for (int i = 0; i < 32; ++i) {
    const float dx = float(region.x + i) + 0.5 - planes.anchor.x;
    precise const float invW = planes.invW + planes.invWSlope.x * dx + planes.invWSlope.y * dy;
    if (!(invW > 0.0 && invW * near <= 1.0)) row &= ~(1u << i);
  }
  return row;
}

#endif
