// The front end of compute rasterizers: what setup and binning leave for whoever makes fragments.
// LucidRaster (Jakubowski 2024), section 2, stages 1 and 2. C++ and GLSL both include this.
#ifndef OITLAB_RASTER_TYPES_H
#define OITLAB_RASTER_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::raster {
using ivec2 = glm::ivec2;
using uvec3 = glm::uvec3;
using uvec4 = glm::uvec4;
#endif

#define BIN_SIZE 32u             // pixels on a side (section 2)
#define SMALL_QUAD_BINS 4u       // a quad over more bins than this is large (stage 1)
#define SUBPIXEL_BITS 8          // of snapped vertices: 1/256 pixel, as in hardware
#define GUARD_BAND (1 << 22)     // snapped coordinates lie within: edge functions fit into 64 bits
#define SETUP_GROUP 256u         // quads of one workgroup of setup
#define LARGE_GROUP 64u          // invocations that share one large triangle in binning
#define MAX_GROUPS 65535u        // workgroups along x that every device can dispatch

// Flags of a RasterTriangle.
#define TRIANGLE_VISIBLE 1u
#define TRIANGLE_IRREGULAR 2u  // a vertex nearer than the near plane or beyond the guard band
#define TRIANGLE_SNAPPED_SHIFT 2  // 3 bits: the vertex has snapped coordinates
#define TRIANGLE_CORNER_SHIFT 5   // 3 x 2 bits: which corner of the quad weighs 1 - b1 - b2, b1, b2
#define TRIANGLE_INDEX_SHIFT 12   // 20 bits: of the IrregularTriangle
#define MAX_IRREGULAR (1u << 20)

// Coverage of one triangle, 32 bytes. Snapped vertices in 1/256 pixel, positively oriented.
struct RasterTriangle {
  ivec2 v[3];
  uint id;  // primitive id
  uint flags;
};

// Vertices in homogeneous pixels (x / w = pixels), for the few triangles that cannot be snapped:
// 3D rasterization (Davidovic 2012) needs no clipping. Positively oriented, like RasterTriangle::v.
struct IrregularTriangle {
  vec3 p[3];
};

// What is linear on the screen, relative to `anchor`, in pixels: 1 / w and the two barycentric
// weights over w. 48 bytes.
struct ShadeTriangle {
  vec2 anchor;
  vec3 invW;    // at the anchor, per pixel right, per pixel down
  float minInvW;  // farthest vertex; the nearest is invW.x. Negative: no bounds (irregular)
  vec3 b1, b2;
};

// Vertex attributes of a visible quad, 68 bytes, together for the sake of the cache.
struct QuadAttributes {
  uint normals[4];
  uint colors[4];
  vec2 uvs[4];
  uint material;
};

// The primitives of a bin: quads (small) and single triangles (large), in the list of entries.
struct Bin {
  uint quads, triangles;              // counted first
  uint quadOffset, triangleOffset;    // into the list
  uint quadCursor, triangleCursor;    // of the writing phase
};

// First and last bin, each x | y << 16.
struct BinBox {
  uint first, last;
};

struct Dispatch {
  uint x, y, z;
};

// Counted on the device; the host reads it after the frame.
struct RasterCounters {
  uint smallQuads, largeQuads;  // visible; what exceeds the capacity is counted all the same
  uint irregularTriangles;
  uint visibleTriangles;
  uint culledBackFacing;        // quads
  uint visibleDegenerate;       // visible quads of one triangle
  uint entries;                 // of all bins' lists
  uint emptyBins, lowBins, highBins;
  uint ready;                   // 1: nothing overflowed, the lists are complete
  Dispatch small;               // workgroups that write the lists of small quads
  Dispatch low, high;           // one workgroup a bin
};

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadBuffer { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer QuadIdBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RasterTriangleBuffer { RasterTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer IrregularBuffer { IrregularTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ShadeTriangleBuffer { ShadeTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer AttributeBuffer { QuadAttributes at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBuffer { Bin at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RasterCounterBuffer { RasterCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBoxBuffer { BinBox at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer WordBuffer { uint at[]; };
#endif

// Visible quad i has the triangles 2 * i and 2 * i + 1. Small quads are numbered from 0 up, large
// ones from capacity - 1 down.
struct RasterPush {
  ADDRESS_OF(FrameBuffer) frame;
  ADDRESS_OF(QuadBuffer) quads;
  ADDRESS_OF(QuadIdBuffer) quadIds;
  ADDRESS_OF(RasterTriangleBuffer) triangles;
  ADDRESS_OF(IrregularBuffer) irregular;
  ADDRESS_OF(ShadeTriangleBuffer) shading;
  ADDRESS_OF(AttributeBuffer) attributes;
  ADDRESS_OF(BinBoxBuffer) quadBins;  // per visible quad: bins overlapped
  ADDRESS_OF(BinBuffer) bins;
  ADDRESS_OF(WordBuffer) entries;   // per bin: quads, then triangles
  ADDRESS_OF(WordBuffer) binLists;  // low bins from 0 up, high bins from the end down
  ADDRESS_OF(RasterCounterBuffer) counters;
  uint quadCount, quadCapacity, irregularCapacity, entryCapacity;
  uint backFaceCulling;
  uint highTriangles;  // a bin with as many triangles is "high"
  uint countAll;       // 1: count what only the results need, too
};

#ifdef __cplusplus
static_assert(sizeof(RasterTriangle) == 32 && sizeof(ShadeTriangle) == 48 &&
              sizeof(QuadAttributes) == 68);
}  // namespace oitlab::raster
#endif

#endif
