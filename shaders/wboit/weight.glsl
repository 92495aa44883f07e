// The weights of McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency" (JCGT 2:2),
// by the number of their equation. WEIGHT is defined by the method: 7, 8, 9, 10, or 0 for none.
#ifndef OITLAB_WBOIT_WEIGHT_GLSL
#define OITLAB_WBOIT_WEIGHT_GLSL

// `z`: distance from the eye plane, scaled so that the scene lies in the range that the paper's
// constants are for (0.1 to 500). `d`: the depth buffer's value as the paper has it, 0 at the nearest
// and 1 at the farthest point of the scene. `alpha`: the fragment's.
float weight(float z, float d, float alpha) {
#if WEIGHT == 7
  return alpha * clamp(10.0 / (1e-5 + pow(z / 5.0, 2.0) + pow(z / 200.0, 6.0)), 1e-2, 3e3);
#elif WEIGHT == 8
  return alpha * clamp(10.0 / (1e-5 + pow(z / 10.0, 3.0) + pow(z / 200.0, 6.0)), 1e-2, 3e3);
#elif WEIGHT == 9
  return alpha * clamp(0.03 / (1e-5 + pow(z / 200.0, 4.0)), 1e-2, 3e3);
#elif WEIGHT == 10
  return alpha * max(1e-2, 3e3 * pow(1.0 - d, 3.0));
#else
  return 1.0;
#endif
}

#endif
