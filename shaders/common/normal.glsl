// Octahedral unit normals (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent
// Unit Vectors"); the packing side is packNormal() in harness/scene.
#ifndef OITLAB_NORMAL_GLSL
#define OITLAB_NORMAL_GLSL

vec3 unpackNormal(uint packed) {
  const vec2 e = unpackSnorm2x16(packed);
  vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
  precise const vec3 unit = n * inversesqrt(fma(n.x, n.x, fma(n.y, n.y, n.z * n.z)));
  return unit;
}

#endif
