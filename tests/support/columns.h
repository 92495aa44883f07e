#pragma once

#include "support/gpu.h"

namespace oitlab::testing {

using Settings = std::map<std::string, std::string>;

class Abuffer : public GpuTest {};

inline const std::vector<std::string> sorts = {"auto",  "insertion", "merge",
                                               "shell", "bitonic",   "register"};
inline const std::vector<std::string> masks = {"stencil", "lists", "stencil_increment"};
inline const std::vector<std::string> memories = {"bma", "max", "max_by_interval"};

/// "name=value " for each setting, for messages.
std::string nameOf(const Settings& settings);

/// One column of pixels for each of `depths`, with that number of layers in a pseudo-random order.
/// Every fourth layer has the depth of the one before it, and each has its own colour. In the view
/// a pixel is one unit, and the view is `rows` high.
Scene columns(const std::vector<int>& depths, int rows);

RenderFixture columnFixture(const std::vector<int>& depths, int rows = 2);

}  // namespace oitlab::testing
