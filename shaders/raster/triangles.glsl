// Triangles, computed from the mesh and its projected vertices.
#ifndef OITLAB_RASTER_TRIANGLES_GLSL
#define OITLAB_RASTER_TRIANGLES_GLSL

#include "raster/planes.glsl"

// The includer defines it as 0 if no triangle is unsnapped: llvmpipe executes branches that no lane takes.
#ifndef HAS_UNSNAPPED
#define HAS_UNSNAPPED 1
#endif

bool isUnsnapped(uint slot) { return (slot & UNSNAPPED) != 0u; }

ScreenVertex loadVertex(Mesh mesh, uint vertex) {
  const vec4 word = mesh.onScreen.at[vertex];
  return ScreenVertex(word.xy, word.z, floatBitsToUint(word.w));
}

// Of one half of a quad.
uvec3 cornersOf(uint slot) { return (slot & 1u) == 0u ? uvec3(0u, 1u, 2u) : uvec3(0u, 2u, 3u); }
uvec3 verticesOf(uvec4 quad, uint slot) { return (slot & 1u) == 0u ? quad.xyz : quad.xzw; }

// The triangle of a slot that is snapped, with the orientation that it has in the scene.
RasterTriangle loadTriangle(Mesh mesh, uint slot) {
  const uvec3 vertices = verticesOf(mesh.quads.at[slot / 2u].corners, slot);
  return RasterTriangle(ivec2[3](snapped(mesh.onScreen.at[vertices.x].xy), snapped(mesh.onScreen.at[vertices.y].xy),
                                 snapped(mesh.onScreen.at[vertices.z].xy)));
}

RasterTriangle flip(RasterTriangle t) { return RasterTriangle(ivec2[3](t.v[0], t.v[2], t.v[1])); }

RasterTriangle positive(RasterTriangle t) {
  return signedArea(t.v[0], t.v[1], t.v[2]) < 0 ? flip(t) : t;
}

uint idOfTriangle(Mesh mesh, uint slot) {
  if (isUnsnapped(slot)) return mesh.unsnapped.at[slot & ~UNSNAPPED].shading.id;
  const uvec4 rest = mesh.quads.at[slot / 2u].rest;
  return (slot & 1u) == 0u ? rest.x : rest.y;
}

// Fills in what the planes do not determine.
void fillAttributes(inout ShadeTriangle s, uint slot, PackedQuad quad, uvec3 corners, uvec3 normals) {
  s.normals = uint[3](normals.x, normals.y, normals.z);
  s.quad = slot / 2u;
  s.id = (slot & 1u) == 0u ? quad.rest.x : quad.rest.y;
  s.material = quad.rest.z;
  s.flags = quad.rest.w | (corners.x | corners.y << 2 | corners.z << 4) << TRIANGLE_CORNER_SHIFT;
}

// Everything is `precise`: every shader gets the same bits.
ShadeTriangle loadShading(Mesh mesh, uint slot) {
#if HAS_UNSNAPPED
  if (isUnsnapped(slot)) return mesh.unsnapped.at[slot & ~UNSNAPPED].shading;
#endif
  const PackedQuad quad = mesh.quads.at[slot / 2u];
  const uvec3 vertices = verticesOf(quad.corners, slot);
  PlaneCorner a = PlaneCorner(mesh.onScreen.at[vertices.x], cornersOf(slot).x);
  PlaneCorner b = PlaneCorner(mesh.onScreen.at[vertices.y], cornersOf(slot).y);
  PlaneCorner c = PlaneCorner(mesh.onScreen.at[vertices.z], cornersOf(slot).z);
  ShadeTriangle s = snappedPlanes(a, b, c);
  fillAttributes(s, slot, quad, uvec3(a.number, b.number, c.number),
           floatBitsToUint(vec3(a.vertex.w, b.vertex.w, c.vertex.w)));
  return s;
}

#endif
