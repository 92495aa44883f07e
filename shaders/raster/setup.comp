#version 460
// Stage 1, quad setup (section 2): one invocation a quad. Culls what covers no sample, and stores for
// the rest what binning, rasterization and shading read. Small quads are counted into their bins.
//
// The paper compacts quads between two phases of a workgroup of 1024; here only the places that
// visible quads are written to are compact.
#include "raster/planes.glsl"
#include "raster/records.glsl"
#include "raster/together.glsl"

layout(local_size_x = SETUP_GROUP) in;
layout(push_constant, scalar) uniform Push { RasterPush push; };

shared uint groupSmall, groupLarge, firstSmall, firstLarge;
shared uint groupTriangles, groupDegenerate, groupBackFacing;

// Records as they lie in memory.
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer RecordWordBuffer { uvec4 at[]; };

// A Vertex as it lies in memory: whole words, like the records (raster_types.h).
struct PackedVertex {
  vec4 positionNormal;
  vec4 uvColorMaterial;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PackedVertexBuffer { PackedVertex at[]; };

// What the two halves of a quad share.
struct Quad {
  uvec4 normals;
  uint material;
  uint flags;  // TRIANGLE_TEXTURED, TRIANGLE_COLORED
};

uint component(uvec4 v, uint i) { return i == 0u ? v.x : i == 1u ? v.y : i == 2u ? v.z : v.w; }

struct Records {
  RasterTriangle raster;
  ShadeTriangle shading;
  bool visible;  // `shading` is to be stored
};

Records makeRecords(Corner a, Corner b, Corner c, uvec3 corners, uint id, ivec4 box, Quad quad) {
  Records r;
  r.visible = !isEmpty(box);
  uint flags = 0u;
  ivec2 v1 = b.snapped, v2 = c.snapped;
  if (r.visible) {
    const bool regular = a.snaps && b.snaps && c.snaps;
    const bool positive = regular ? signedArea(a.snapped, b.snapped, c.snapped) > 0
                                  : dot(edgePlane(a.p, b.p), c.p) > 0.0;
    flags = TRIANGLE_VISIBLE | quad.flags;
    v1 = positive ? b.snapped : c.snapped;
    v2 = positive ? c.snapped : b.snapped;
    if (regular) {
      r.shading = regularPlanes(a, b, c, corners);
    } else {
      const uint index = atomicAdd(push.counters.c.irregularTriangles, 1u);
      const uint last = uint(positive ? c.snaps : b.snaps), middle = uint(positive ? b.snaps : c.snaps);
      flags |= TRIANGLE_IRREGULAR | min(index, MAX_IRREGULAR - 1u) << TRIANGLE_INDEX_SHIFT |
               (uint(a.snaps) | middle << 1 | last << 2) << TRIANGLE_SNAPPED_SHIFT;
      // The anchor lies amid the visible part: farther away it would cost precision.
      vec2 weights;
      r.shading = irregularPlanes(a.p, b.p, c.p, vec2((box.xy + box.zw) / 2) + 0.5, weights);
      if (index < push.irregularCapacity) {
        push.irregular.at[index].p[0] = a.p;
        push.irregular.at[index].p[1] = positive ? b.p : c.p;
        push.irregular.at[index].p[2] = positive ? c.p : b.p;
        push.irregular.at[index].b1 = weights.x;
        push.irregular.at[index].b2 = weights.y;
      }
    }
    flags |= (corners.x | corners.y << 2 | corners.z << 4) << TRIANGLE_CORNER_SHIFT;
    r.shading.id = id;
    r.shading.flags = flags;
    r.shading.normals = uint[3](component(quad.normals, corners.x), component(quad.normals, corners.y),
                                component(quad.normals, corners.z));
    r.shading.material = quad.material;
  }
  r.raster = RasterTriangle(ivec4(a.snapped, v1), v2, id, flags);
  return r;
}

// Stores two words, `place` and the next, of each lane that is `live`. Lanes go about it in pairs: each
// store then fills whole sectors of 32 bytes. All lanes of the subgroup take part.
void storeInPairs(RecordWordBuffer to, uint place, bool live, uvec4 first, uvec4 second) {
  const uint odd = gl_SubgroupInvocationID & 1u;
  const uvec4 theirs = subgroupShuffleXor(odd != 0u ? first : second, 1u);
  const uvec2 other = subgroupShuffleXor(uvec2(place, uint(live)), 1u);
  // The even lane's, then the odd lane's.
  if (odd != 0u ? other.y != 0u : live) to.at[(odd != 0u ? other.x : place) + odd] = odd != 0u ? theirs : first;
  if (odd != 0u ? live : other.y != 0u) to.at[(odd != 0u ? place : other.x) + odd] = odd != 0u ? second : theirs;
}

void storeRecords(uint slot, bool live, Records r) {
  const uvec4 raster[2] = wordsOf(r.raster), shading[4] = wordsOf(r.shading);
  RecordWordBuffer triangles = RecordWordBuffer(uint64_t(push.triangles));
  RecordWordBuffer planes = RecordWordBuffer(uint64_t(push.shading));
  storeInPairs(triangles, 2u * slot, live, raster[0], raster[1]);
  const bool shaded = live && r.visible;
  storeInPairs(planes, 4u * slot, shaded, shading[0], shading[1]);
  storeInPairs(planes, 4u * slot + 2u, shaded, shading[2], shading[3]);
}

// In world space, as the paper has it: the eye is where the planes x, y and w of the clip space meet.
bool facesAway(vec3 a, vec3 b, vec3 c) { return dot(edgePlane(a, b), c) > 0.0; }

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    groupSmall = groupLarge = 0u;
    groupTriangles = groupDegenerate = groupBackFacing = 0u;
  }
  barrier();

  const uint quad = gl_WorkGroupID.y * MAX_GROUPS * SETUP_GROUP + gl_GlobalInvocationID.x;
  const mat4 viewProjection = push.frame.c.viewProjection;
  const uvec2 size = push.frame.c.size;
  const float near = nearPlane(viewProjection);
  bool visible = false, small = false;
  uint rank = 0u;
  uvec4 indices;
  uvec2 ids;
  Corner corner[4];
  ivec4 box[2] = ivec4[2](emptyBox, emptyBox);
  BinBox bins;
  uvec2 firstBin = uvec2(0u), lastBin = uvec2(0u);
  Quad quadShading;
  PackedVertexBuffer vertices = PackedVertexBuffer(push.frame.c.vertices);
  if (quad < push.quadCount) {
    indices = push.quads.at[quad];
    ids = push.quadIds.at[quad];
    [[unroll]] for (int i = 0; i < 4; ++i)
    {
      const vec4 word = vertices.at[indices[i]].positionNormal;
      corner[i] = project(viewProjection, size, word.xyz);
      quadShading.normals[i] = floatBitsToUint(word.w);
    }
    box[0] = triangleBox(corner[0], corner[1], corner[2], near, size);
    const bool single = indices.z == indices.w;
    if (!single) box[1] = triangleBox(corner[0], corner[2], corner[3], near, size);
    if (push.backFaceCulling != 0u) {
      const bool away0 = facesAway(corner[0].p, corner[1].p, corner[2].p);
      const bool away1 = single || facesAway(corner[0].p, corner[2].p, corner[3].p);
      if (away0 && away1) {
        box[0] = box[1] = emptyBox;
        atomicAdd(groupBackFacing, 1u);
      }
    }
    visible = !isEmpty(box[0]) || !isEmpty(box[1]);
    if (visible) {
      const ivec4 first = isEmpty(box[0]) ? box[1] : box[0], second = isEmpty(box[1]) ? box[0] : box[1];
      firstBin = uvec2(min(first.xy, second.xy)) / BIN_SIZE;
      lastBin = uvec2(max(first.zw, second.zw)) / BIN_SIZE;
      const uvec2 extent = lastBin - firstBin + 1u;
      small = extent.x * extent.y <= SMALL_QUAD_BINS;
      rank = small ? atomicAdd(groupSmall, 1u) : atomicAdd(groupLarge, 1u);
      if (push.countAll != 0u) {
        atomicAdd(groupTriangles, uint(!isEmpty(box[0])) + uint(!isEmpty(box[1])));
        if (single) atomicAdd(groupDegenerate, 1u);
      }
    }
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) {
    if (groupSmall > 0u) firstSmall = atomicAdd(push.counters.c.smallQuads, groupSmall);
    if (groupLarge > 0u) firstLarge = atomicAdd(push.counters.c.largeQuads, groupLarge);
    if (groupTriangles > 0u) atomicAdd(push.counters.c.visibleTriangles, groupTriangles);
    if (groupDegenerate > 0u) atomicAdd(push.counters.c.visibleDegenerate, groupDegenerate);
    if (groupBackFacing > 0u) atomicAdd(push.counters.c.culledBackFacing, groupBackFacing);
  }
  barrier();
  const uvec2 extent = small ? lastBin - firstBin + 1u : uvec2(0u, 1u);
  const uint columns = (size.x + BIN_SIZE - 1u) / BIN_SIZE;
  for (uint k = 0u; k < SMALL_QUAD_BINS; ++k) {
    const bool valid = k < extent.x * extent.y;
    if (!subgroupAny(valid)) break;
    const uint bin = (firstBin.y + k / max(extent.x, 1u)) * columns + firstBin.x + k % max(extent.x, 1u);
    const Together t = gather(bin, valid);
    if (t.count > 0u) atomicAdd(push.bins.at[bin].quads, t.count);
  }
  const uint place = rank + (small ? firstSmall : firstLarge);
  const bool stored = visible && place < push.quadCapacity;  // else counted all the same: the host makes room
  const uint slot = small ? place : push.quadCapacity - 1u - place;
  Records records[2];
  if (stored) {
    push.quadBins.at[slot] =
        BinBox(firstBin.x | firstBin.y << 16, lastBin.x | lastBin.y << 16);
    vec4 words[4];
    QuadAttributes attributes;
    [[unroll]] for (int i = 0; i < 4; ++i) {
      words[i] = vertices.at[indices[i]].uvColorMaterial;
      attributes.colors[i] = floatBitsToUint(words[i].z);
    }
    quadShading.material = floatBitsToUint(words[0].w);
    quadShading.flags = 0u;
    if (push.frame.c.materials.at[quadShading.material].atlas != 0u) quadShading.flags |= TRIANGLE_TEXTURED;
    if (any(notEqual(attributes.colors, uvec4(0xffffffffu)))) quadShading.flags |= TRIANGLE_COLORED;
    if (quadShading.flags != 0u) {
      attributes.uvs01 = vec4(words[0].xy, words[1].xy);
      attributes.uvs23 = vec4(words[2].xy, words[3].xy);
      push.attributes.at[slot] = attributes;
    }
    records[0] = makeRecords(corner[0], corner[1], corner[2], uvec3(0, 1, 2), ids.x, box[0], quadShading);
    records[1] = makeRecords(corner[0], corner[2], corner[3], uvec3(0, 2, 3), ids.y, box[1], quadShading);
  }
  storeRecords(2u * slot, stored, records[0]);
  storeRecords(2u * slot + 1u, stored, records[1]);
}
