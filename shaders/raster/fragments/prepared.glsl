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
  preparedWords[place + 0u] = vec4(p.invW, p.invWSlope, uintBitsToFloat(p.bits));
  preparedWords[place + 1u] = p.color;
  preparedWords[place + 2u] = vec4(p.minInvW, p.maxInvW, uintBitsToFloat(uvec2(p.id, p.vertexColors.x)));
#if INTERPOLATES
  preparedWords[place + 3u] = vec4(p.normal, p.alphaCutoff);
  preparedWords[place + 4u] = vec4(p.b1, p.b1Slope, p.normal1.x);
  preparedWords[place + 5u] = vec4(p.b2, p.b2Slope, p.normal1.y);
  preparedWords[place + 6u] = vec4(p.normal2, p.normal1.z);
#endif
#if HAS_MORE
  preparedWords[place + 7u] = vec4(p.uv, p.uv1);
  preparedWords[place + 8u] = vec4(p.uv2, uintBitsToFloat(p.vertexColors.yz));
#endif
}

Prepared loadPrepared(uint at) {
  const uint place = at * PREPARED_WORDS;
  Prepared p;
  const vec4 word0 = preparedWords[place + 0u], word2 = preparedWords[place + 2u];
  p.invW = word0.x;
  p.invWSlope = word0.yz;
  p.bits = floatBitsToUint(word0.w);
  p.color = preparedWords[place + 1u];
  p.minInvW = word2.x;
  p.maxInvW = word2.y;
  p.id = floatBitsToUint(word2.z);
#if INTERPOLATES
  const vec4 word3 = preparedWords[place + 3u], word4 = preparedWords[place + 4u];
  const vec4 word5 = preparedWords[place + 5u], word6 = preparedWords[place + 6u];
  p.normal = word3.xyz;
  p.alphaCutoff = word3.w;
  p.b1 = word4.x;
  p.b1Slope = word4.yz;
  p.b2 = word5.x;
  p.b2Slope = word5.yz;
  p.normal1 = vec3(word4.w, word5.w, word6.w);
  p.normal2 = word6.xyz;
#endif
#if HAS_MORE
  const vec4 word7 = preparedWords[place + 7u], word8 = preparedWords[place + 8u];
  p.uv = word7.xy;
  p.uv1 = word7.zw;
  p.uv2 = word8.xy;
  p.vertexColors = floatBitsToUint(vec3(word2.w, word8.zw));
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
