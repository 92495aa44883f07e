#include "method/method.h"

#include "method/make_source.h"
#include "util/check.h"
#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

/// A static variable of a function, so that it exists before the first registration, whatever the
/// link order is.
std::map<std::string, MethodInfo>& registry() {
  static std::map<std::string, MethodInfo> methods;
  return methods;
}

}  // namespace

std::vector<std::string> MethodInfo::missing(const DeviceInfo& device) const {
  std::vector<std::string> missing = Device::missingBaseline(device);
  for (const std::string& feature : features)
    if (!device.has(feature)) missing.push_back(feature);
  return missing;
}

std::unique_ptr<Method> MethodInfo::makeFor(const Device& device, const GpuScene& scene,
                                            const Target& target,
                                            const Parameters& parameters) const {
  if (const auto lacking = missing(device.info()); !lacking.empty())
    fail<DeviceError>("method {} cannot run on {}: it lacks {}", name, device.info().name,
                      fmt::join(lacking, ", "));
  auto ledger = std::make_unique<MemoryLedger>();
  try {
    auto method = make({device, scene, target, *ledger, parameters});
    method->ledger_ = std::move(ledger);
    return method;
  } catch (const vk::SystemError& error) {
    fail<DeviceError>("method {} could not be made on {}: {}", name, device.info().name,
                      error.what());
  }
}

const std::map<std::string, MethodInfo>& methods() {
  return registry();
}

const MethodInfo& findMethod(const std::string& name) {
  const auto it = registry().find(name);
  if (it != registry().end()) return it->second;
  std::vector<std::string> names;
  for (const auto& [known, info] : registry()) names.push_back(known);
  fail<InputError>("unknown method '{}'{}; there are: {}", name, didYouMean(name, names),
                   joinNames(names));
}

RegisterMethod::RegisterMethod(MethodInfo info) {
  if (info.takesFragments)
    for (Parameter& parameter : sourceParameters(info.computeFirst))
      info.parameters.push_back(std::move(parameter));
  const bool isNew = registry().emplace(info.name, info).second;
  OITLAB_CHECK(isNew);
}

}  // namespace oitlab
