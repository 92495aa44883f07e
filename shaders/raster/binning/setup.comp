#version 460
// Stage 1, quad setup (section 2): one invocation per quad. Culls quads that cover no sample, counts small quads in
// their bins, and lists the remaining quads for binning.
//
// The paper compacts quads between two phases of a workgroup of 1024. Here only the lists are compact.
//
// HAS_UNSNAPPED 0: quads that may be unsnapped are only counted, and the frame must be recorded again.
#include "raster/project.glsl"
#include "raster/binning/subgroup_aggregate.glsl"

layout(local_size_x = SETUP_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

#if HAS_UNSNAPPED
#include "raster/unsnapped.glsl"
#endif

shared uint groupSmall, groupLarge, groupLargeTriangles, firstSmall, firstLarge;
shared uint groupTriangles, groupDegenerate, groupBackFacing;

// Whether this half of a quad has a vertex that cannot be snapped and may be visible (see unsnapped.glsl).
bool mayBeUnsnapped(vec4 a, vec4 b, vec4 c, uvec2 size) {
  const vec3 invW = vec3(a.z, b.z, c.z);
  if (all(greaterThan(invW, vec3(0.0)))) return false;
  if (all(equal(invW, vec3(0.0)))) return false;  // entirely nearer than the near plane
  if (any(equal(invW, vec3(0.0)))) return true;
  const vec2 low = min(min(a.xy, b.xy), c.xy), high = max(max(a.xy, b.xy), c.xy);
  return all(greaterThan(high, vec2(-2.0))) && all(lessThan(low, vec2(size) + 2.0));
}

ivec4 boxOf(vec4 a, vec4 b, vec4 c, uvec2 size) {
  const bool snaps = min(min(a.z, b.z), c.z) > 0.0;
  return snaps ? screenBox(snapped(a.xy), snapped(b.xy), snapped(c.xy), size) : emptyBox;
}

bool isCulled(uvec4 corners, bool single) {
  const mat4 viewProjection = push.frame.c.viewProjection;
  vec3 p[4];
  [[unroll]] for (int i = 0; i < 4; ++i)
    p[i] = homogeneous(viewProjection, push.frame.c.size, push.mesh.vertices.at[corners[i]].positionNormal.xyz);
  return facesAway(p[0], p[1], p[2]) && (single || facesAway(p[0], p[2], p[3]));
}

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupSmall = groupLarge = groupLargeTriangles = 0u;
    groupTriangles = groupDegenerate = groupBackFacing = 0u;
  }
  barrier();

  const uint quad = gl_WorkGroupID.y * MAX_GROUPS * SETUP_GROUP + gl_GlobalInvocationID.x;
  const uvec2 size = push.frame.c.size;
  bool small = false, large = false;
  bvec2 visible = bvec2(false);  // the halves
  uint rank = 0u;
  uvec2 firstBin = uvec2(0u), extent = uvec2(0u, 1u);  // in bins
  if (quad < push.quadCount) {
    const uvec4 corners = push.mesh.quads.at[quad].corners;
    vec4 v[4];
    [[unroll]] for (int i = 0; i < 4; ++i) v[i] = push.mesh.onScreen.at[corners[i]];
    const bool single = corners.z == corners.w;
    const bool culled = push.backFaceCulling != 0u && isCulled(corners, single);
    if (culled) {
      atomicAdd(groupBackFacing, 1u);
    } else if (mayBeUnsnapped(v[0], v[1], v[2], size) || mayBeUnsnapped(v[0], v[2], v[3], size)) {
#if HAS_UNSNAPPED
      setUpUnsnapped(quad);
#else
      atomicMax(push.counters.c.unsnappedSeen, 1u);
#endif
    } else {
      const ivec4 box0 = boxOf(v[0], v[1], v[2], size), box1 = boxOf(v[0], v[2], v[3], size);
      visible = bvec2(!isEmpty(box0), !isEmpty(box1));
      if (any(visible)) {
        const ivec4 first = visible.x ? box0 : box1, second = visible.y ? box1 : box0;
        firstBin = uvec2(min(first.xy, second.xy)) / BIN_SIZE;
        extent = uvec2(max(first.zw, second.zw)) / BIN_SIZE - firstBin + 1u;
        small = extent.x * extent.y <= SMALL_QUAD_BINS;
        large = !small;
        const uint halves = uint(visible.x) + uint(visible.y);
        if (small) {
          rank = atomicAdd(groupSmall, 1u);
        } else {
          atomicAdd(groupLarge, 1u);
          rank = atomicAdd(groupLargeTriangles, halves);
        }
        if (push.countAll != 0u) {
          atomicAdd(groupTriangles, halves);
          if (single) atomicAdd(groupDegenerate, 1u);
        }
      }
    }
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    if (groupSmall > 0u) firstSmall = atomicAdd(push.counters.c.smallQuads, groupSmall);
    if (groupLarge > 0u) {
      atomicAdd(push.counters.c.largeQuads, groupLarge);
      firstLarge = atomicAdd(push.counters.c.largeTriangles, groupLargeTriangles);
    }
    if (groupTriangles > 0u) atomicAdd(push.counters.c.visibleTriangles, groupTriangles);
    if (groupDegenerate > 0u) atomicAdd(push.counters.c.visibleDegenerate, groupDegenerate);
    if (groupBackFacing > 0u) atomicAdd(push.counters.c.culledBackFacing, groupBackFacing);
  }
  barrier();
  const uint columns = (size.x + BIN_SIZE - 1u) / BIN_SIZE;
  for (uint k = 0u; k < SMALL_QUAD_BINS; ++k) {
    const bool valid = small && k < extent.x * extent.y;
    if (!subgroupAny(valid)) break;
    const uint bin = (firstBin.y + k / max(extent.x, 1u)) * columns + firstBin.x + k % max(extent.x, 1u);
    const Aggregate t = aggregate(bin, valid);
    if (t.count > 0u) atomicAdd(push.bins.at[bin].quads, t.count);
  }
  // What does not fit is counted anyway: the host allocates more.
  if (small && firstSmall + rank < push.smallCapacity)
    push.smallQuads.at[firstSmall + rank] = uvec2(quad, packBins(firstBin, extent));
  if (large) {
    uint place = firstLarge + rank;
    [[unroll]] for (uint half_ = 0u; half_ < 2u; ++half_) {
      if (!visible[half_]) continue;
      if (place < push.largeCapacity) push.large.at[place] = 2u * quad + half_;
      ++place;
    }
  }
}
