// The front end of compute rasterizers: what setup and binning leave for whoever makes fragments.
// LucidRaster (Jakubowski 2024), section 2, stages 1 and 2. C++ and GLSL both include this.
#ifndef OITLAB_RASTER_TYPES_H
#define OITLAB_RASTER_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab::raster {
using ivec2 = glm::ivec2;
using uvec3 = glm::uvec3;
using ivec4 = glm::ivec4;
using uvec4 = glm::uvec4;
#endif

#define BIN_SIZE 32u             // pixels on a side (section 2)
#define SMALL_QUAD_BINS 4u       // a quad over more bins than this is large (stage 1)
#define SUBPIXEL_BITS 8          // of snapped vertices: 1/256 pixel, as in hardware
#define GUARD_BAND (1 << 22)     // snapped coordinates lie within: edge functions fit into 64 bits
#define SETUP_GROUP 256u         // quads of one workgroup of setup
#define OFFSET_GROUP 64u         // bins of one workgroup of bin_offsets
#define LARGE_GROUP 128u         // invocations of a workgroup of bin_large
#define LARGE_GROUPS 1024u       // of them: enough to fill a large GPU, and quick to start for nothing
#define PART_TRIANGLES 256u      // of a bin's list that one workgroup takes; a bin of more is "high"
#define MAX_GROUPS 65535u        // workgroups along x that every device can dispatch

// Flags of a RasterTriangle.
#define TRIANGLE_VISIBLE 1u
#define TRIANGLE_IRREGULAR 2u  // a vertex nearer than the near plane or beyond the guard band
#define TRIANGLE_SNAPPED_SHIFT 2  // 3 bits: the vertex has snapped coordinates
#define TRIANGLE_CORNER_SHIFT 5   // 3 x 2 bits: which corner of the quad weighs 1 - b1 - b2, b1, b2
#define TRIANGLE_TEXTURED (1u << 11)  // QuadAttributes::uvs are there
#define TRIANGLE_COLORED (1u << 12)   // QuadAttributes::colors are there; else all are white
#define TRIANGLE_INDEX_SHIFT 13       // 19 bits: of the IrregularTriangle
#define MAX_IRREGULAR (1u << 19)

// The records below travel as whole 16-byte words (records.glsl): loads and stores of 4 bytes would
// cost a GPU four times the transactions. On an NVIDIA H200 that was two thirds of the setup.

// Coverage of one triangle, 32 bytes. Snapped vertices in 1/256 pixel, positively oriented.
struct RasterTriangle {
  ivec4 v01;  // vertices 0 and 1
  ivec2 v2;
  uint id;  // primitive id
  uint flags;
};

// Vertices in homogeneous pixels (x / w = pixels), for the few triangles that cannot be snapped:
// 3D rasterization (Davidovic 2012) needs no clipping. Positively oriented, like RasterTriangle.
struct IrregularTriangle {
  vec3 p[3];
  float b1, b2;  // at the anchor; 0 for regular triangles, whose anchor is a corner
};

// What shading needs, 64 bytes. Linear on the screen, relative to `anchor`, in pixels: 1 / w and the
// two barycentric weights over w.
struct ShadeTriangle {
  vec2 anchor;
  float invW;     // at the anchor
  float minInvW;  // farthest corner; the nearest is invW. Negative: no bounds (irregular)
  vec2 invWSlope, b1Slope;  // per pixel right, per pixel down
  vec2 b2Slope;
  uint id;        // primitive id
  uint flags;
  uint normals[3];
  uint material;
};

// Further attributes of a visible quad, 48 bytes, written and read where flags say so.
struct QuadAttributes {
  uvec4 colors;
  vec4 uvs01, uvs23;
};

// The primitives of a bin: quads (small) and single triangles (large), in the list of entries.
struct Bin {
  uint quads, triangles;              // counted first
  uint quadOffset, triangleOffset;    // into the list
  uint quadCursor, triangleCursor;    // of the writing phase
};

// PART_TRIANGLES of a bin's list, or the rest of it.
struct Part {
  uint bin;
  uint number;  // among the bin's parts
  uint first, quads, triangles;  // the bin's list: quads from `first` on, then triangles
};

// First and last bin, each x | y << 16.
struct BinBox {
  uint first, last;
};

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
  uint irregularTriangles;
  uint visibleTriangles;
  uint culledBackFacing;        // quads
  uint visibleDegenerate;       // visible quads of one triangle
  uint entries;                 // of all bins' lists
  uint emptyBins, lowBins, highBins;
  uint highParts;               // of all high bins
  uint offsetGroupsDone;        // workgroups of bin_offsets.comp
  uint ready;                   // 1: nothing overflowed, the lists are complete
  Dispatch small;               // workgroups that write the lists of small quads
  Dispatch low, high;           // one workgroup a low bin, one a part of a high bin
};

#ifndef __cplusplus
// As they lie in memory.
struct PackedRasterTriangle {
  ivec4 word[2];
};
struct PackedShadeTriangle {
  vec4 word[4];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer QuadBuffer { uvec4 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer QuadIdBuffer { uvec2 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer RasterTriangleBuffer { PackedRasterTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer IrregularBuffer { IrregularTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ShadeTriangleBuffer { PackedShadeTriangle at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer AttributeBuffer { QuadAttributes at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer BinBuffer { Bin at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PartBuffer { Part at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer RasterCounterBuffer { RasterCounters c; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer BinBoxBuffer { BinBox at[]; };
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
  ADDRESS_OF(PartBuffer) parts;     // low bins from 0 up; from the number of bins up: of high bins
  ADDRESS_OF(RasterCounterBuffer) counters;
  uint quadCount, quadCapacity, irregularCapacity, entryCapacity;
  uint backFaceCulling;
  uint countAll;       // 1: count what only the results need, too
};

#ifdef __cplusplus
static_assert(sizeof(RasterTriangle) == 32 && sizeof(ShadeTriangle) == 64 &&
              sizeof(QuadAttributes) == 48);
}  // namespace oitlab::raster
#endif

#endif
