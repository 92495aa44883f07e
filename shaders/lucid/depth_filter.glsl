// Sample blending (section 2): the fragments of a pixel pass through a queue of DEPTH_FILTER places, which corrects
// the small disorder that the sort of tri-half-blocks leaves, and are blended front to back. HAS_THRESHOLD:
// push.alphaThreshold is used.
#ifndef OITLAB_LUCID_DEPTH_FILTER_GLSL
#define OITLAB_LUCID_DEPTH_FILTER_GLSL

#include "common/order.glsl"
#include "raster/fragments/prepare.glsl"

struct Pixel {
  vec4 accumulated;  // premultiplied
  float lastDepth;   // of the fragment blended last
  uint lastId;
  bool invalid;      // a fragment came after one that it is in front of
  uint samples;      // blended
  Sample queue[DEPTH_FILTER];  // front to back
};

#define NEAREST uintBitsToFloat(0x7f800000u)  // infinity

bool isInFront(Sample a, Sample b) { return isInFront(a.depth, a.id, b.depth, b.id); }

// An empty place holds a transparent fragment in front of all others. It leaves first and changes nothing.
void clearPixel(out Pixel p) {
  p.accumulated = vec4(0.0);
  p.lastDepth = NEAREST;
  p.lastId = 0u;
  p.invalid = false;
  p.samples = 0u;
  [[unroll]] for (int i = 0; i < DEPTH_FILTER; ++i) p.queue[i] = Sample(NEAREST, 0u, vec4(0.0));
}

bool isFull(Pixel p) { return HAS_THRESHOLD == 1 && p.accumulated.a >= push.alphaThreshold; }

// The order is right if and only if no fragment is in front of the one before it, so every wrong pixel is found.
// Fragments behind the alpha threshold are not blended, but their order is still checked.
void blendFragment(inout Pixel p, Sample f) {
  p.invalid = p.invalid || isInFront(f.depth, f.id, p.lastDepth, p.lastId);
  if (!isFull(p)) {
    p.lastDepth = f.depth;
    p.lastId = f.id;
    p.accumulated = blendUnder(p.accumulated, f.color);
  }
}

// Inserts `f`, and blends the nearest fragment of the queue. A pixel that has reached the alpha threshold blends
// nothing more, so that its fragments need no color.
void pushFragment(inout Pixel p, Sample f) {
  if (isFull(p)) {
    p.invalid = p.invalid || isInFront(f.depth, f.id, p.lastDepth, p.lastId);
  } else {
    Sample leaving = p.queue[0], carried = f;
    if (isInFront(f, leaving)) {
      carried = leaving;
      leaving = f;
    }
    [[unroll]] for (int i = 1; i < DEPTH_FILTER; ++i) {
      if (isInFront(p.queue[i], carried)) {
        p.queue[i - 1] = p.queue[i];
      } else {
        p.queue[i - 1] = carried;
        carried = p.queue[i];
      }
    }
    p.queue[DEPTH_FILTER - 1] = carried;
    blendFragment(p, leaving);
  }
}

void drainPixel(inout Pixel p) {
  [[unroll]] for (int i = 0; i < DEPTH_FILTER; ++i) blendFragment(p, p.queue[i]);
}

#endif
