// The order that "exact" means: by depth, ties by primitive id.
#ifndef OITLAB_ORDER_GLSL
#define OITLAB_ORDER_GLSL

// True where fragment a is in front of fragment b. Depths are reversed (larger = nearer). Fragments
// at equal depth are ordered by primitive id, the lower one in front, so that the image does not
// depend on the order in which triangles are submitted.
bool isInFront(float depthA, uint idA, float depthB, uint idB) {
  return depthA > depthB || (depthA == depthB && idA < idB);
}

// Front-to-back `over` (Porter and Duff 1984): `over` accumulates premultiplied colour in rgb and
// coverage in a. `precise`, because every exact method must round alike.
vec4 blendUnder(vec4 accumulated, vec4 straight) {
  precise vec4 result;
  precise const float weight = (1.0 - accumulated.a) * straight.a;
  result.rgb = accumulated.rgb + weight * straight.rgb;
  result.a = accumulated.a + weight;
  return result;
}

// The accumulated transparent layers over the opaque colour.
vec4 overOpaque(vec4 accumulated, vec4 opaque) {
  precise vec4 result;
  result.rgb = accumulated.rgb + (1.0 - accumulated.a) * opaque.rgb;
  result.a = 1.0;
  return result;
}

#endif
