// How lanes hand the fragments of prepared triangles to the pixels that they own. The includer defines
// fragmentAt() and the owners.
#ifndef OITLAB_SOURCE_DELIVER_PREPARED_GLSL
#define OITLAB_SOURCE_DELIVER_PREPARED_GLSL

shared uint masks[TEAMS * PREPARED_COUNT];  // of the prepared triangles

// The fragment of a prepared triangle at a pixel.
Fragment fragmentOf(Prepared t, ivec2 corner, uint bit) {
  const float invW = invWOf(t, vec2(pixelOf(bit)));
  Fragment f = fragmentAt(corner, bit, depthOf(push.frame, invW), t.id);
  f.source.triangle = t;
  f.source.invW = invW;
  return f;
}

void deliver(inout Owner owner, Prepared t, ivec2 corner, uint bit, float opaque) {
  const Fragment f = fragmentOf(t, corner, bit);
  if (!isHidden(f.depth, opaque)) take(owner, f);
}

#if ACCESS == ACCESS_BLENDED && HAS_TEXTURES == 0
// Without branches, so that the latency of one fragment hides behind the work of another.
#define WITHOUT_BRANCHES 1

Contributed contributionOf(Prepared t, ivec2 corner, uint bit, float opaque, bool covers) {
  const Fragment f = fragmentOf(t, corner, bit);
  return contributed(f, covers && !isHidden(f.depth, opaque));
}
#else
#define WITHOUT_BRANCHES 0
#endif

#if SMALL_SUBGROUP == 0
// The team's first `count` prepared triangles. Each lane has one pixel.
void deliverBatch(inout Owner owner, ivec2 corner, uint bit, float opaque, uint count) {
  const uint first = gl_SubgroupID * PREPARED_COUNT;
  const uint pixelBit = gl_SubgroupInvocationID < OWNERS ? 1u << bit : 0u;
#if WITHOUT_BRANCHES
  for (uint k = 0u; k < count; k += 2u) {
    const uint next = min(k + 1u, count - 1u);
    const bool covers = (masks[first + k] & pixelBit) != 0u;
    const bool nextCovers = (masks[first + next] & pixelBit) != 0u && next > k;
    const Contributed c0 = contributionOf(loadPrepared(first + k), corner, bit, opaque, covers);
    const Contributed c1 = contributionOf(loadPrepared(first + next), corner, bit, opaque, nextCovers);
    combine(owner, c0);
    combine(owner, c1);
  }
#else
  for (uint k = first; k < first + count; ++k)
    if ((masks[k] & pixelBit) != 0u) deliver(owner, loadPrepared(k), corner, bit, opaque);
#endif
}

#else
// The bits of group g in the coverage masks.
uint groupMask(uint g) { return (0xffffffffu >> (32u - OWNERS)) << (OWNERS * g); }

// The team's first `count` prepared triangles. The lane's pixel is one of several: only the triangles that reach this
// group of pixels.
void deliverBatch(inout Owner owner, ivec2 corner, uint bit, float opaque, uint count) {
  const uint lane = gl_SubgroupInvocationID, first = gl_SubgroupID * PREPARED_COUNT;
  const bool reaches = lane < count && (masks[first + min(lane, count - 1u)] & groupMask(bit / OWNERS)) != 0u;
  for (uint rest = subgroupBallot(reaches).x; rest != 0u; rest &= rest - 1u) {
    const uint k = first + findLSB(rest);
    if ((masks[k] & 1u << bit) != 0u) deliver(owner, loadPrepared(k), corner, bit, opaque);
  }
}
#endif

#endif
