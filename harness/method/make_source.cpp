#include "method/make_source.h"

#include <cstdlib>

#include "source/compute_source.h"
#include "source/hardware_source.h"
#include "util/error.h"

namespace oitlab {
namespace {

int deliverOf(const std::string& name, bool dependsOnOrder) {
  if (name == "submission") return DELIVER_SUBMISSION;
  if (name == "near_to_far") return DELIVER_NEAR_TO_FAR;
  if (name == "far_to_near") return DELIVER_FAR_TO_NEAR;
  if (name == "shuffled") return DELIVER_SHUFFLED;
  return name == "auto" && dependsOnOrder ? DELIVER_SUBMISSION : DELIVER_ANY;
}

}  // namespace

std::vector<Parameter> sourceParameters(bool computeFirst) {
  std::vector<std::string> sources = {"hardware", "compute"};
  if (computeFirst) std::swap(sources[0], sources[1]);
  return {choice("source", sources,
                 "where fragments come from: fragment shaders, or the compute rasterizer"),
          choice("deliver", {"auto", "any", "submission", "near_to_far", "far_to_near", "shuffled"},
                 "source=compute: the order of a pixel's fragments; auto: submission if the image "
                 "depends on it, else any"),
          integer("deliver_seed", 0, 0, 0xffffffffll, "deliver=shuffled: another order for each")};
}

bool isHardware(const Parameters& parameters) {
  return parameters.choice("source") == "hardware";
}

std::unique_ptr<FragmentSource> makeSource(const MethodContext& context, bool dependsOnOrder) {
  const auto& [device, scene, target, memory, parameters] = context;
  const std::string& deliver = parameters.choice("deliver");
  if (isHardware(parameters)) {
    if (deliver != "auto" && deliver != "submission")
      fail<InputError>(
          "deliver={} needs source=compute: hardware blends a pixel's fragments in the order of "
          "submission",
          deliver);
    return std::make_unique<HardwareSource>(
        device, scene, target, memory,
        HardwareSource::Options{.withoutInterlock =
                                    std::getenv("OITLAB_WITHOUT_INTERLOCK") != nullptr});
  }
  // For tests: a frame must not depend on what it has not written.
  const bool poison = std::getenv("OITLAB_POISON") != nullptr;
  return std::make_unique<ComputeSource>(
      device, scene, target, memory,
      ComputeSource::Options{.deliver = deliverOf(deliver, dependsOnOrder),
                             .seed = std::uint32_t(parameters.integer("deliver_seed")),
                             .poison = poison});
}

}  // namespace oitlab
