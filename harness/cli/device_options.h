#pragma once

#include <CLI/CLI.hpp>

#include "gpu/device.h"

namespace oitlab {

/// Adds --device, --validation and --shader-printf, which all verbs that open a device have.
inline void addDeviceOptions(CLI::App& verb, Device::Options& options) {
  verb.add_option("--device", options.index,
                  "Device number as `oitlab info` lists them (default: a GPU if there is one)")
      ->check(CLI::NonNegativeNumber)
      ->type_name("N");
  verb.add_flag("--validation", options.validation,
                "Vulkan validation layers, synchronization included (slow; marked in results)");
  verb.add_flag("--shader-printf", options.shaderPrintf,
                "Print what shaders say with debugPrintfEXT, through the validation layer");
}

}  // namespace oitlab
