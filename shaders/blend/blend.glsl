// Alpha blending: the fragment's straight color; the source puts it over the target.
#include "source/fragment.glsl"

layout(push_constant, scalar) uniform PushBlock { FrameBuffer frame; } push;

bool contribute(Fragment f, out vec4 c[1]) { return shadeFragment(f, c[0]); }
