// The order that the layer `reorder` runs commands in: as unlike the recorded one as barriers
// allow.
#include "faults/layer/schedule.h"

#include <gmock/gmock.h>

namespace oitlab::layer {
namespace {

using ::testing::ElementsAre;

constexpr VkPipelineStageFlags2 compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 copy = VK_PIPELINE_STAGE_2_COPY_BIT;
constexpr VkPipelineStageFlags2 fragment = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;

Node action(VkPipelineStageFlags2 stages) {
  return {false, stages, stages};
}
Node barrier(VkPipelineStageFlags2 from, VkPipelineStageFlags2 to) {
  return {true, from, to};
}

TEST(Schedule, IsTheReverseWithoutBarriers) {
  EXPECT_THAT(adversarialOrder({action(compute), action(copy), action(compute)}),
              ElementsAre(2, 1, 0));
  EXPECT_THAT(adversarialOrder({}), ElementsAre());
}

TEST(Schedule, HoldsWhatABarrierOrders) {
  EXPECT_THAT(adversarialOrder({action(compute), barrier(compute, compute), action(compute)}),
              ElementsAre(0, 1, 2));
  const auto all = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  EXPECT_THAT(adversarialOrder({action(copy), barrier(all, all), action(compute | fragment)}),
              ElementsAre(0, 1, 2));
}

TEST(Schedule, HoldsNothingOutsideOfABarriersScopes) {
  // The copy is in neither scope: it may come after all, or before all.
  EXPECT_THAT(adversarialOrder({action(copy), barrier(compute, compute), action(compute)}),
              ElementsAre(1, 2, 0));
  EXPECT_THAT(adversarialOrder({action(compute), barrier(compute, compute), action(copy)}),
              ElementsAre(2, 0, 1));
}

TEST(Schedule, ChainsBarriersWhoseScopesMeet) {
  EXPECT_THAT(adversarialOrder({action(compute), barrier(compute, copy), barrier(copy, fragment),
                                action(fragment)}),
              ElementsAre(0, 1, 2, 3));
  EXPECT_THAT(adversarialOrder({action(compute), barrier(compute, copy),
                                barrier(fragment, fragment), action(fragment)}),
              ElementsAre(2, 3, 0, 1));
}

TEST(Schedule, OrdersAcrossAnActionBetweenBarriers) {
  EXPECT_THAT(adversarialOrder({action(compute), barrier(compute, copy), action(copy),
                                barrier(copy, fragment), action(fragment)}),
              ElementsAre(0, 1, 2, 3, 4));
}

}  // namespace
}  // namespace oitlab::layer
