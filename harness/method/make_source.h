#pragma once

#include "method/method.h"
#include "source/fragment_source.h"

namespace oitlab {

/// The parameters that every method has that takes fragments from a source: source, deliver, seed.
/// `computeFirst`: the default source is compute.
std::vector<Parameter> sourceParameters(bool computeFirst = false);

/// The source that the parameters choose. `dependsOnOrder`: the method's image depends on the order
/// of a pixel's fragments, so that deliver=auto means submission. Throws InputError where
/// parameters contradict each other, DeviceError when the device lacks what the source needs.
std::unique_ptr<FragmentSource> makeSource(const MethodContext& context,
                                           bool dependsOnOrder = false);

/// Whether the parameters choose the hardware source.
bool isHardware(const Parameters& parameters);

}  // namespace oitlab
