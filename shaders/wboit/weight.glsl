// The weights of McGuire and Bavoil 2013, "Weighted Blended Order-Independent Transparency" (JCGT 2:2),
// by the number of their equation. WEIGHT is defined by the method: 7, 8, 9, 10, or 0 for none.
#ifndef OITLAB_WBOIT_WEIGHT_GLSL
#define OITLAB_WBOIT_WEIGHT_GLSL

float power2(float x) { return x * x; }
float power3(float x) { return x * x * x; }

// The equations with numerator and denominator times a power of overZ, so that one division is enough. Powers are written
// out, too: pow() and divisions run in a GPU's slow units.
//
// `overZ`: 1 / distance from the eye plane, which is scaled so that the scene lies in the range that the paper's constants
// are for (0.1 to 500). `d`: the depth buffer's value as the paper has it, 0 at the nearest and 1 at the farthest point
// of the scene. `alpha`: the fragment's.
float weight(float overZ, float d, float alpha) {
  const float n = min(overZ, 1e3);  // all weights are at their limit long before; more would overflow
#if WEIGHT == 7
  const float n2 = n * n, n6 = power3(n2);
  return alpha * clamp(10.0 * n6 / (1e-5 * n6 + power2(n2 / 5.0) + 1.0 / power3(power2(200.0))), 1e-2, 3e3);
#elif WEIGHT == 8
  const float n3 = power3(n), n6 = n3 * n3;
  return alpha * clamp(10.0 * n6 / (1e-5 * n6 + n3 / power3(10.0) + 1.0 / power3(power2(200.0))), 1e-2, 3e3);
#elif WEIGHT == 9
  const float n4 = power2(power2(n));
  return alpha * clamp(0.03 * n4 / (1e-5 * n4 + 1.0 / power2(power2(200.0))), 1e-2, 3e3);
#elif WEIGHT == 10
  return alpha * max(1e-2, 3e3 * power3(1.0 - d));
#else
  return 1.0;
#endif
}

#endif
