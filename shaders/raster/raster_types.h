// The front end of compute rasterizers: what setup and binning leave for whoever makes fragments.
// LucidRaster (Jakubowski 2024), section 2, stages 1 and 2. C++ and GLSL both include this.
#ifndef OITLAB_RASTER_TYPES_H
#define OITLAB_RASTER_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::raster {
using ivec2 = glm::ivec2;
using uvec4 = glm::uvec4;
#endif

#define BIN_SIZE 32u             // pixels on a side (section 2)
#define SMALL_QUAD_BINS 4u       // a quad over more bins than this is large (stage 1)
#define SUBPIXEL_BITS 8          // of snapped vertices: 1/256 pixel, as in hardware
#define GUARD_BAND (1 << 22)     // snapped coordinates lie within: edge functions fit into 64 bits
#define SETUP_GROUP 256u         // quads of one workgroup of setup
#define OFFSET_GROUP 64u         // bins of one workgroup of bin_offsets
#define LARGE_GROUP 128u         // invocations of a workgroup of bin_large
#define SEGMENT_TRIANGLES 256u   // triangles of a bin's list per workgroup; a bin with more is "high"
#define MAX_GROUPS 65535u        // workgroups along x that every device can dispatch

// A triangle is identified by its slot: quad * 2 + half. Half 0 has the corners 0 1 2, half 1 has 0 2 3. The few
// triangles that cannot be snapped, because a vertex is nearer than the near plane or outside the guard band, have the
// slot UNSNAPPED | index of an UnsnappedTriangle.
#define UNSNAPPED 0x80000000u

// Flags of a ShadeTriangle.
#define TRIANGLE_COLORED 1u      // some corner is not white
#define TRIANGLE_CORNER_SHIFT 1  // 3 x 2 bits: which corner of the quad weighs 1 - b1 - b2, b1, b2

// Two triangles of the scene that share an edge, 32 bytes. Like everything that is read often, it is loaded in words
// of 16 bytes (triangles.glsl): loads of 4 bytes would cost a GPU four times the transactions.
struct RasterQuad {
  uvec4 corners;  // vertices; the last two are equal if there is only one triangle
  uint ids[2];    // primitive ids of its halves
  uint material;
  uint flags;     // TRIANGLE_COLORED
};

// A vertex on the screen, 16 bytes. Shaders compute everything else about a triangle from three of these wherever they
// need it. Since triangles share vertices, that is less to read than one record per triangle, and much less to store.
struct ScreenVertex {
  vec2 pixel;   // where it is
  float invW;   // 1 / distance; if it cannot be snapped: 0 nearer than the near plane, else negative
  uint normal;  // packed
};

#ifndef __cplusplus
// Coverage of one triangle: snapped vertices in 1/256 pixel.
struct RasterTriangle {
  ivec2 v[3];
};
#endif

// What shading needs of one triangle. Linear on the screen, relative to `anchor`, in pixels: 1 / w and
// the two barycentric weights over w.
struct ShadeTriangle {
  vec2 anchor;
  float invW;     // at the anchor
  float minInvW;  // farthest corner; the nearest is invW. Negative: no bounds (unsnapped)
  vec2 invWSlope, b1Slope, b2Slope;  // per pixel right, per pixel down
  vec2 weights;   // b1 and b2 over w at the anchor: 0 for snapped triangles, whose anchor is a corner
  uint normals[3];
  uint quad;
  uint id;        // primitive id
  uint material;
  uint flags;
};

// Vertices in homogeneous pixels (x / w = pixels), for the few triangles that cannot be snapped:
// 3D rasterization (Davidovic 2012) needs no clipping. Positively oriented.
struct UnsnappedTriangle {
  vec3 p[3];
  ivec2 snapped[3];  // where `snaps` has a bit
  uint snaps;
  uint firstBin, lastBin;  // of those that it may overlap, x | y << 16
  ShadeTriangle shading;
};

// The primitives of a bin: quads (small) and single triangles (large), in the list of entries.
struct Bin {
  uint quads, triangles;              // counted first
  uint quadOffset, triangleOffset;    // into the list
  uint quadCursor, triangleCursor;    // of the writing phase
};

// SEGMENT_TRIANGLES of a bin's list, or the rest of it.
struct Segment {
  uint bin;
  uint number;  // index among the bin's segments
  uint first, quads, triangles;  // the bin's list: quads from `first` on, then triangles
};

// A visible quad in few bins. Both halves are snapped.
struct SmallQuad {
  uint quad;
  uint bins;  // first column 12 bits, first row 12 bits, columns 4 bits, rows 4 bits
};
#define BINS_BITS 12
#define BINS_EXTENT_BITS 4

// Arguments of an indirect dispatch. Shaders take the number of their workgroups from here and not from
// gl_NumWorkGroups. On an NVIDIA H200 (driver 580.159.04) frames hung now and then, always where a loop
// stepped by gl_NumWorkGroups in a dispatch whose arguments the one before had changed: a step that is
// read too early, as 0, never ends. A suspicion, not proved; docs/performance.md.
struct Dispatch {
  uint x, y, z;
};

// Counted on the device; the host reads it after the frame.
struct RasterCounters {
  uint smallQuads, largeQuads;  // visible; what exceeds the capacity is counted all the same
  uint largeTriangles;          // of large quads, visible
  uint unsnappedSeen;           // 1: some quad may be unsnapped, and setup.comp passed it by
  uint unsnappedTriangles;      // visible
  uint visibleTriangles;
  uint culledBackFacing;        // quads
  uint visibleDegenerate;       // visible quads of one triangle
  uint entries;                 // of all bins' lists
  uint emptyBins, lowBins, highBins;
  uint highSegments;               // of all high bins
  uint offsetGroupsDone;        // workgroups of bin_offsets.comp
  uint ready;                   // 1: nothing overflowed, the lists are complete
  Dispatch small;               // workgroups that write the lists of small quads
  Dispatch low, high;           // one workgroup per low bin, per segment of a high bin
};

#ifndef __cplusplus
// As they lie in memory.
struct PackedQuad {
  uvec4 corners;
  uvec4 rest;
};
struct PackedVertex {
  vec4 positionNormal;
  vec4 uvColorMaterial;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer QuadBuffer { PackedQuad at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer PackedVertexBuffer { PackedVertex at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ScreenVertexBuffer { vec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer UnsnappedBuffer { UnsnappedTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer SmallQuadBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBuffer { Bin at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer SegmentBuffer { Segment at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RasterCounterBuffer { RasterCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WordBuffer { uint at[]; };

uint packBins(uvec2 first, uvec2 extent) {
  return first.x | first.y << BINS_BITS | extent.x << 2 * BINS_BITS | extent.y << (2 * BINS_BITS + BINS_EXTENT_BITS);
}

void unpackBins(uint bins, out uvec2 first, out uvec2 extent) {
  first = uvec2(bitfieldExtract(bins, 0, BINS_BITS), bitfieldExtract(bins, BINS_BITS, BINS_BITS));
  extent = uvec2(bitfieldExtract(bins, 2 * BINS_BITS, BINS_EXTENT_BITS), bins >> (2 * BINS_BITS + BINS_EXTENT_BITS));
}
#endif

// Where the triangles are. Vertices are numbered from the first that a transparent triangle has.
struct Mesh {
  ADDRESS_OF(QuadBuffer) quads;
  ADDRESS_OF(PackedVertexBuffer) vertices;  // of the scene
  ADDRESS_OF(ScreenVertexBuffer) onScreen;
  ADDRESS_OF(UnsnappedBuffer) unsnapped;
};

struct RasterPush {
  Mesh mesh;
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(SmallQuadBuffer) smallQuads;
  ADDRESS_OF(WordBuffer) large;     // slots of triangles in many bins
  ADDRESS_OF(BinBuffer) bins;
  ADDRESS_OF(WordBuffer) entries;   // per bin: quads, then slots of triangles
  ADDRESS_OF(SegmentBuffer) segments;     // low bins from 0 up; from the number of bins up: of high bins
  ADDRESS_OF(RasterCounterBuffer) counters;
  uint quadCount, vertexCount;
  uint smallCapacity, largeCapacity;
  uint unsnappedCapacity, entryCapacity;
  uint largeGroups;    // workgroups of bin_large
  uint backFaceCulling;
  uint countAll;       // 1: count what only the results need, too
};

#ifdef __cplusplus
static_assert(sizeof(RasterQuad) == 32 && sizeof(ScreenVertex) == 16);
static_assert(sizeof(RasterPush) <= 128);
}  // namespace oitlab::raster
#endif

#endif
