#include "scene/generators.h"

namespace oitlab {

std::span<const GeneratedScene* const> generatedScenes() {
#define OITLAB_ADDRESS(name) &generated::name,
  static constexpr const GeneratedScene* kScenes[] = {OITLAB_GENERATED_SCENES(OITLAB_ADDRESS)};
#undef OITLAB_ADDRESS
  return kScenes;
}

std::vector<SceneInfo> sceneCatalogue() {
  std::vector<SceneInfo> catalogue;
  for (const GeneratedScene* scene : generatedScenes())
    catalogue.push_back({scene->name, scene->summary});
  return catalogue;
}

}  // namespace oitlab
