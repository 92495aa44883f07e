// The front end's records, as words in memory and as structs to work with.
#ifndef OITLAB_RASTER_RECORDS_GLSL
#define OITLAB_RASTER_RECORDS_GLSL

#include "raster/raster_types.h"

RasterTriangle loadTriangle(RasterTriangleBuffer triangles, uint slot) {
  const ivec4 a = triangles.at[slot].word[0], b = triangles.at[slot].word[1];
  return RasterTriangle(a, b.xy, uint(b.z), uint(b.w));
}

uvec4[2] wordsOf(RasterTriangle t) { return uvec4[2](uvec4(t.v01), uvec4(uvec2(t.v2), t.id, t.flags)); }

uint idOfTriangle(RasterTriangleBuffer triangles, uint slot) { return uint(triangles.at[slot].word[1].z); }

ShadeTriangle loadShading(ShadeTriangleBuffer shading, uint slot) {
  const vec4 a = shading.at[slot].word[0], b = shading.at[slot].word[1];
  const uvec4 c = floatBitsToUint(shading.at[slot].word[2]);
  const uvec4 d = floatBitsToUint(shading.at[slot].word[3]);
  return ShadeTriangle(a.xy, a.z, a.w, b.xy, b.zw, uintBitsToFloat(c.xy), c.z, c.w,
                       uint[3](d.x, d.y, d.z), d.w);
}

uvec4[4] wordsOf(ShadeTriangle s) {
  return uvec4[4](floatBitsToUint(vec4(s.anchor, s.invW, s.minInvW)),
                  floatBitsToUint(vec4(s.invWSlope, s.b1Slope)),
                  uvec4(floatBitsToUint(s.b2Slope), s.id, s.flags),
                  uvec4(s.normals[0], s.normals[1], s.normals[2], s.material));
}

#endif
