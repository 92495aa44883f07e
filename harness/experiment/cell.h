#pragma once

#include <nlohmann/json.hpp>

#include "frame/target.h"
#include "gpu/device.h"
#include "method/parameters.h"
#include "scene/scene.h"

namespace oitlab {

/// One configuration of a sweep: a cell of the results is this on a device.
struct CellSpec {
  SceneSpec scene;
  std::string contentHash;  ///< of a scene's files (scene/import/content_hash.h); "" when generated
  std::string view = "default";
  std::uint32_t width = 0, height = 0;
  TargetFormat format = TargetFormat::rgba16f;
  std::string method;
  Parameters parameters;

  /// "boxes reference 640x360", for people.
  std::string label() const;

  /// Everything that makes this cell another one, as JSON with a fixed order of keys.
  nlohmann::json identity() const;

  /// The identity without method and parameters: cells that agree in it are measured in turn.
  nlohmann::json groupIdentity() const;
};

/// The name of a cell's file: readable, and unique by a hash of its identity and the device.
std::string cellId(const CellSpec& cell, const DeviceInfo& device);

/// The name of the cell's group on this device, the same in every process: 16 hexadecimal digits.
std::string groupKey(const CellSpec& cell, const DeviceInfo& device);

}  // namespace oitlab
