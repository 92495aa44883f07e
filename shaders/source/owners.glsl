// What the lane that owns a pixel keeps of it, by the program's access. The includer has included the fragment program.
#ifndef OITLAB_SOURCE_OWNERS_GLSL
#define OITLAB_SOURCE_OWNERS_GLSL

#if ACCESS == ACCESS_NONE
// Pixels have no owner.
struct Owner {
  uint taken;
};
void open(out Owner owner, ivec2 place) { owner.taken = 0u; }
void take(inout Owner owner, Fragment f) {
  fragment(f);
  ++owner.taken;
}
void close(Owner owner, ivec2 place) {}

#else
// The accumulated color over the opaque one.
void store(ivec2 place, vec4 color) {
  imageStore(target, place, color + (1.0 - color.a) * imageLoad(target, place));
}

#if ACCESS == ACCESS_EXCLUSIVE
struct Owner {
  uint taken;
  PixelState state;
};
void open(out Owner owner, ivec2 place) {
  owner.taken = 0u;
  openPixel(uvec2(place), owner.state);
}
void take(inout Owner owner, Fragment f) { owner.taken += uint(addFragment(owner.state, f)); }
void close(Owner owner, ivec2 place) {
  vec4 color;
  if (closePixel(owner.state, color)) store(place, color);
}

#else
struct Owner {
  uint taken;
  vec4 sums[CONTRIBUTIONS];
};

#if ON_TARGET
// A program on the target blends as the unit of a GPU, which stores every result in the target's format. If that has 8
// bits, sums are in units of 1 / 255.
#define TARGET_UNITS (TARGET_BITS == 8 ? 255.0 : 1.0)

vec4 blended(vec4 sum, vec4 c) {
#if TARGET_BITS == 8
  c = min(c, 1.0);
#endif
  precise const vec4 result = fma(vec4(1.0 - c.a), sum, c * (c.a * TARGET_UNITS));
#if TARGET_BITS == 8
  // Adding 2^23 rounds to a whole number. round() is an operation of a GPU's slow units.
  precise const vec4 shifted = result + 8388608.0;
  precise const vec4 whole = shifted - 8388608.0;
  return whole;
#elif TARGET_BITS == 16
  return vec4(unpackHalf2x16(packHalf2x16(result.rg)), unpackHalf2x16(packHalf2x16(result.ba)));
#else
  return result;
#endif
}
#endif

vec4 combined(int operation, vec4 sum, vec4 c) {
  precise const vec4 result = operation == COMBINE_ADD ? sum + c : sum * (1.0 - c);
  return result;
}

const int operations[CONTRIBUTIONS] = int[](OPERATIONS);
const vec4 initialSums[CONTRIBUTIONS] = vec4[](INITIAL_SUMS);

void open(out Owner owner, ivec2 place) {
  owner.taken = 0u;
  owner.sums = initialSums;
#if ON_TARGET
  owner.sums[0] = imageLoad(target, min(place, ivec2(push.frame.c.size) - 1)) * TARGET_UNITS;
#if TARGET_BITS == 8
  owner.sums[0] = round(owner.sums[0]);
#endif
#endif
}

struct Contributed {
  vec4 c[CONTRIBUTIONS];
  bool counts;
};

// `exists`: the fragment covers the pixel and is not hidden. contribute() is called in any case.
Contributed contributed(Fragment f, bool exists) {
  Contributed result;
  const bool there = contribute(f, result.c);
  result.counts = exists && there;
  return result;
}

void combine(inout Owner owner, Contributed with) {
  if (!with.counts) return;
  ++owner.taken;
#if ON_TARGET
  owner.sums[0] = blended(owner.sums[0], with.c[0]);
#else
  [[unroll]] for (int i = 0; i < CONTRIBUTIONS; ++i)
    owner.sums[i] = combined(operations[i], owner.sums[i], with.c[i]);
#endif
}

void take(inout Owner owner, Fragment f) { combine(owner, contributed(f, true)); }

void close(Owner owner, ivec2 place) {
#if ON_TARGET
  imageStore(target, place, owner.sums[0] / TARGET_UNITS);
#else
  vec4 color;
  if (composite(owner.sums, color)) store(place, color);
#endif
}
#endif
#endif

uint takenBy(Owner owner) { return owner.taken; }

#endif
