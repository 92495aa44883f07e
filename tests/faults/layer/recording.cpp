#include "recording.h"

#include <cstdlib>
#include <map>
#include <mutex>
#include <string_view>

namespace oitlab::layer {
namespace {

Reorder initialReorder() {
  const char* mode = std::getenv("OITLAB_REORDER");
  const char* drop = std::getenv("OITLAB_REORDER_DROP");
  Reorder reorder;
  reorder.shuffle = mode != nullptr && std::string_view(mode) == "shuffle";
  reorder.drop = drop != nullptr ? std::atoi(drop) : 0;
  return reorder;
}

}  // namespace

Reorder& reorder() {
  static Reorder reorder = initialReorder();
  return reorder;
}

Recording& recordingOf(VkCommandBuffer commands) {
  static std::mutex mutex;
  static std::map<VkCommandBuffer, Recording> recordings;
  const std::lock_guard lock(mutex);
  return recordings[commands];
}

void setState(VkCommandBuffer commands, const std::string& what, Step step) {
  Recording& recording = recordingOf(commands);
  std::erase_if(recording.state, [&](const auto& entry) { return entry.first == what; });
  if (recording.inRendering) recording.steps.back().push_back(step);
  recording.state.emplace_back(what, std::move(step));
}

void addAction(VkCommandBuffer commands, VkPipelineStageFlags2 stages, Step step) {
  Recording& recording = recordingOf(commands);
  if (recording.inRendering) {
    Node& pass = recording.nodes.back();
    pass.from = pass.to = pass.from | stages;
    recording.steps.back().push_back(std::move(step));
    return;
  }
  recording.nodes.push_back({false, stages, stages});
  auto& steps = recording.steps.emplace_back();
  for (const auto& entry : recording.state) steps.push_back(entry.second);
  steps.push_back(std::move(step));
}

}  // namespace oitlab::layer
