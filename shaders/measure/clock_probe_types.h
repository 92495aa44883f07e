// Arguments of clock_probe.comp. C++ and GLSL both include this.
#ifndef OITLAB_CLOCK_PROBE_TYPES_H
#define OITLAB_CLOCK_PROBE_TYPES_H

#include "common/frame_types.h"

#ifdef __cplusplus
namespace oitlab {
#endif

#define CLOCK_PROBE_GROUP 128u
#define CLOCK_PROBE_UNROLL 32u  // fma a iteration of the loop: its own work hardly counts

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ClockProbeResult { float value; };
#endif

struct ClockProbePush {
  ADDRESS_OF(ClockProbeResult) result;
  uint iterations;       // of CLOCK_PROBE_UNROLL fma, one after another
  float factor;     // x = x * factor + summand
  float summand;
  float threshold;  // what exceeds it is stored
};

#ifdef __cplusplus
}  // namespace oitlab
#endif

#endif
