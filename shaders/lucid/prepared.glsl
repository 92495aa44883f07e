// Triangles made ready once, by one lane each, for all lanes of their team to read. The including
// shader defines PREPARED_COUNT: places in all.
#ifndef OITLAB_LUCID_PREPARED_GLSL
#define OITLAB_LUCID_PREPARED_GLSL

#include "lucid/fragment.glsl"

// 9 words of 16 bytes, so that the accesses of neighbouring lanes fall into different banks.
#define PREPARED_WORDS 9u
shared vec4 preparedWords[PREPARED_COUNT * PREPARED_WORDS];

// The last two words are rarely needed.
bool hasAttributes(Prepared p) {
  return (floatBitsToUint(p.n1.w) & (PREPARED_ATLAS | PREPARED_COLORED)) != 0u;
}

void storePrepared(uint at, Prepared p) {
  const uint place = at * PREPARED_WORDS;
  preparedWords[place + 0u] = p.w;
  preparedWords[place + 1u] = p.b1;
  preparedWords[place + 2u] = p.b2;
  preparedWords[place + 3u] = p.n0;
  preparedWords[place + 4u] = p.n1;
  preparedWords[place + 5u] = p.n2;
  preparedWords[place + 6u] = p.color;
  if (!hasAttributes(p)) return;
  preparedWords[place + 7u] = p.uvs;
  preparedWords[place + 8u] = p.more;
}

Prepared loadPrepared(uint at) {
  const uint place = at * PREPARED_WORDS;
  Prepared p;
  p.w = preparedWords[place + 0u];
  p.b1 = preparedWords[place + 1u];
  p.b2 = preparedWords[place + 2u];
  p.n0 = preparedWords[place + 3u];
  p.n1 = preparedWords[place + 4u];
  p.n2 = preparedWords[place + 5u];
  p.color = preparedWords[place + 6u];
  if (hasAttributes(p)) {
    p.uvs = preparedWords[place + 7u];
    p.more = preparedWords[place + 8u];
  }
  return p;
}

#endif
