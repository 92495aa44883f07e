// Prepared triangles: one lane prepares each, and all lanes of the team read it. The includer defines TEAMS.
#ifndef OITLAB_RASTER_PREPARED_GLSL
#define OITLAB_RASTER_PREPARED_GLSL

#include "raster/fragments/prepare.glsl"

// Number of 16-byte words per triangle. Every scene needs the first three. The number is odd, so that the accesses of
// neighboring lanes fall into different banks.
#define HAS_MORE (HAS_TEXTURES == 1 || HAS_GRADIENTS == 1)
#define PREPARED_WORDS (HAS_MORE ? 9u : INTERPOLATES ? 7u : 3u)

// Triangles per team: an even number, since they are shaded in pairs, with room for two words for each of 32 lanes
// (sampleWord). The number is small because shared memory limits how many subgroups run at the same time: an NVIDIA
// H200 gives it 48 KB per multiprocessor (docs/performance.md).
#ifndef PREPARED_FLAT
#define PREPARED_FLAT 22u
#endif
#define PREPARED_COUNT (HAS_MORE ? 8u : INTERPOLATES ? 10u : PREPARED_FLAT)
shared vec4 preparedWords[TEAMS * PREPARED_COUNT * PREPARED_WORDS];

void storePrepared(uint at, Prepared p) {
  const uint place = at * PREPARED_WORDS;
  preparedWords[place + 0u] = p.w;
  preparedWords[place + 1u] = p.color;
  preparedWords[place + 2u] = vec4(p.range.xyz, uintBitsToFloat(p.firstColor));
#if INTERPOLATES
  preparedWords[place + 3u] = p.n0;
  preparedWords[place + 4u] = vec4(p.b1.xyz, p.n1.x);
  preparedWords[place + 5u] = vec4(p.b2.xyz, p.n1.y);
  preparedWords[place + 6u] = vec4(p.n2, p.n1.z);
#endif
#if HAS_TEXTURES == 1 || HAS_GRADIENTS == 1
  preparedWords[place + 7u] = p.uvs;
  preparedWords[place + 8u] = p.more;
#endif
}

Prepared loadPrepared(uint at) {
  const uint place = at * PREPARED_WORDS;
  Prepared p;
  p.w = preparedWords[place + 0u];
  p.color = preparedWords[place + 1u];
  p.range = preparedWords[place + 2u];
#if INTERPOLATES
  p.n0 = preparedWords[place + 3u];
  p.b1 = preparedWords[place + 4u];
  p.b2 = preparedWords[place + 5u];
  const vec4 last = preparedWords[place + 6u];
  p.n1 = vec3(p.b1.w, p.b2.w, last.w);
  p.n2 = last.xyz;
#endif
#if HAS_TEXTURES == 1 || HAS_GRADIENTS == 1
  p.firstColor = floatBitsToUint(p.range.w);
  p.uvs = preparedWords[place + 7u];
  p.more = preparedWords[place + 8u];
#endif
  return p;
}

// The same memory is used where a team's lanes exchange samples instead: two words per lane.
uint sampleWord(uint lane) { return gl_SubgroupID * PREPARED_COUNT * PREPARED_WORDS + 2u * lane; }

void storeSample(uint lane, Sample f) {
  preparedWords[sampleWord(lane)] = f.color;
  preparedWords[sampleWord(lane) + 1u].xy = vec2(f.depth, uintBitsToFloat(f.id));
}

Sample loadSample(uint lane) {
  const vec2 key = preparedWords[sampleWord(lane) + 1u].xy;
  return Sample(key.x, floatBitsToUint(key.y), preparedWords[sampleWord(lane)]);
}

#endif
