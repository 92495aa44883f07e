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
// As the blending unit of a GPU rounds, which stores every result.
vec4 rounded(vec4 color) {
#if TARGET_BITS == 8
  return round(clamp(color, 0.0, 1.0) * 255.0) / 255.0;
#elif TARGET_BITS == 16
  return vec4(unpackHalf2x16(packHalf2x16(color.rg)), unpackHalf2x16(packHalf2x16(color.ba)));
#else
  return color;
#endif
}
#endif

vec4 combined(int operation, vec4 sum, vec4 c) {
  precise vec4 result;
  if (operation == COMBINE_ADD) result = sum + c;
  else if (operation == COMBINE_ATTENUATE) result = sum * (1.0 - c);
  else result = c.a * c + (1.0 - c.a) * sum;
  return result;
}

const int operations[CONTRIBUTIONS] = int[](OPERATIONS);
const vec4 initialSums[CONTRIBUTIONS] = vec4[](INITIAL_SUMS);

void open(out Owner owner, ivec2 place) {
  owner.taken = 0u;
  owner.sums = initialSums;
#if ON_TARGET
  owner.sums[0] = imageLoad(target, min(place, ivec2(push.frame.c.size) - 1));
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
  [[unroll]] for (int i = 0; i < CONTRIBUTIONS; ++i)
    owner.sums[i] = combined(operations[i], owner.sums[i], with.c[i]);
#if ON_TARGET
  owner.sums[0] = rounded(owner.sums[0]);
#endif
}

void take(inout Owner owner, Fragment f) { combine(owner, contributed(f, true)); }

void close(Owner owner, ivec2 place) {
#if ON_TARGET
  imageStore(target, place, owner.sums[0]);
#else
  vec4 color;
  if (composite(owner.sums, color)) store(place, color);
#endif
}
#endif
#endif

uint takenBy(Owner owner) { return owner.taken; }

#endif
