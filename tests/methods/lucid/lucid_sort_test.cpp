// The sorts of lucid's lists, on separate lists. Includes the sort in registers, which frames do
// not use on devices with small subgroups.
#include <numeric>

#include <fmt/format.h>

#include "gpu/barrier.h"
#include "lucid/lucid_types.h"
#include "raster/raster_defines.h"
#include "support/gpu.h"
#include "util/random.h"

namespace oitlab::testing {
namespace {

class LucidSortGpu : public GpuTest {};

/// The order in which sort_lists.comp leaves lists with these depths, with `teams` lists per
/// workgroup.
std::vector<std::vector<std::uint32_t>> ordersOf(const std::vector<std::vector<float>>& lists,
                                                 bool high, bool registers, unsigned teams) {
  const Device& device = sharedDevice();
  Defines defines = raster::teamDefines(device);
  defines["SMALL_SUBGROUP"] = registers ? "0" : "1";
  defines["HIGH"] = high ? "1" : "0";
  defines["LIST"] = high ? "HIGH_LIST" : "MEDIUM_LIST";
  defines["TEAMS"] = fmt::format("{}u", teams);
  const Pipeline pipeline =
      Pipeline::compute(device, "lucid/sort_lists.comp", defines, {}, device.info().subgroupSize);
  std::vector<float> keys;
  std::vector<lucid::HalfBlock> blocks;
  for (const auto& list : lists) {
    blocks.push_back(
        {.number = 0, .first = std::uint32_t(keys.size()), .count = std::uint32_t(list.size())});
    keys.insert(keys.end(), list.begin(), list.end());
  }
  std::vector<lucid::PixelJob> jobs;
  jobs.reserve(blocks.size());
  for (const auto& block : blocks) jobs.push_back({block, ~0u});
  std::reverse(blocks.begin(), blocks.end());  // long lists are stored from the end downwards
  lucid::LucidCounters counters{};
  counters.lists.mediumLists = counters.lists.longLists = counters.lists.longGroups.x =
      std::uint32_t(lists.size());

  MemoryLedger memory;
  const Buffer keyBuffer = uploadBuffer(device, memory, "keys", keys);
  const Buffer jobBuffer = uploadBuffer(device, memory, "jobs", jobs);
  const Buffer blockBuffer = uploadBuffer(device, memory, "blocks", blocks);
  const Buffer counterBuffer = uploadBuffer(device, memory, "counters", std::vector{counters});
  const std::uint64_t bytes = keys.size() * sizeof(float);
  const Buffer back(device, memory, "back", bytes, BufferKind::readback);
  device.runOnce([&](const Commands& commands) {
    using Stage = vk::PipelineStageFlagBits2;
    lucid::BlendPush push{};
    push.keys = keyBuffer.address();
    push.blocks = blockBuffer.address();
    push.medium = jobBuffer.address();
    push.counters = counterBuffer.address();
    push.halfBlocks = std::uint32_t(blocks.size());
    pipeline.bind(commands, nullptr, push);
    commands.dispatch(std::uint32_t(lists.size()), 1, 1);
    memoryBarrier(commands, Stage::eComputeShader, Stage::eTransfer);
    commands.copyBuffer(keyBuffer.vk(), back.vk(), vk::BufferCopy(0, 0, bytes));
    memoryBarrier(commands, Stage::eTransfer, Stage::eHost);
  });
  std::vector<std::vector<std::uint32_t>> orders;
  std::size_t first = 0;
  for (const auto& list : lists) {
    const auto all = back.mapped<std::uint32_t>();
    orders.emplace_back(all.begin() + first, all.begin() + first + list.size());
    first += list.size();
  }
  return orders;
}

void expectFrontToBack(const std::vector<float>& depths, const std::vector<std::uint32_t>& order) {
  std::vector<std::uint32_t> places = order;
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> all(depths.size());
  std::iota(all.begin(), all.end(), 0u);
  ASSERT_EQ(places, all);
  // Depths have the bits that the places leave free (pack_key.glsl).
  const auto [low, high] = std::minmax_element(depths.begin(), depths.end());
  const float step = (*high - *low) / float(1u << 18);
  for (std::size_t i = 1; i < order.size(); ++i)
    ASSERT_GE(depths[order[i - 1]], depths[order[i]] - step) << "rank " << i;
}

// Lists of different lengths lie side by side, so that the teams of a workgroup reach different
// numbers of barriers.
TEST_F(LucidSortGpu, LeavesListsFrontToBack) {
  const std::uint32_t lanes = sharedDevice().info().subgroupSize;
  Pcg32 random(7);
  const struct {
    const char* name;
    bool high, registers;
    std::uint32_t most;
    unsigned teams;
  } sorts[] = {{"in registers", false, true, 16 * lanes, 1},
               {"in registers, side by side", false, true, 16 * lanes, 4},
               {"in shared memory", false, false, MEDIUM_LIST, 1},
               {"in shared memory, side by side", false, false, MEDIUM_LIST, 4},
               {"long lists", true, false, HIGH_LIST, 1}};
  for (const auto& sort : sorts) {
    SCOPED_TRACE(sort.name);
    std::vector<std::vector<float>> lists;
    for (const std::uint32_t length : {1u, 2u, 3u, lanes, 4 * lanes, 4 * lanes + 1, 8 * lanes,
                                       8 * lanes + 1, sort.most - 1, sort.most}) {
      std::vector<float> depths;
      for (std::uint32_t i = 0; i < length; ++i) depths.push_back(random.uniform(0.1f, 10));
      lists.push_back(depths);
    }
    lists.push_back(std::vector<float>(sort.most, 0.5f));  // all equal
    const auto orders = ordersOf(lists, sort.high, sort.registers, sort.teams);
    for (std::size_t i = 0; i < lists.size(); ++i) {
      SCOPED_TRACE(fmt::format("{} of them", lists[i].size()));
      expectFrontToBack(lists[i], orders[i]);
    }
  }
}

}  // namespace
}  // namespace oitlab::testing
