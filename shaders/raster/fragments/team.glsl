// A team is a subgroup that works on a half-block.
#ifndef OITLAB_RASTER_TEAM_GLSL
#define OITLAB_RASTER_TEAM_GLSL

#include "raster/blocks/block_types.h"

#extension GL_KHR_memory_scope_semantics : require

// With this, lanes that diverge converge again where the control flow joins. Without it Vulkan does not promise that.
#if UNIFORM_CONTROL_FLOW
#extension GL_EXT_subgroup_uniform_control_flow : require
#define TEAM_MAIN [[subgroup_uniform_control_flow]]
#else
#define TEAM_MAIN
#endif

// Makes what the team's lanes wrote to shared memory visible to the whole team. subgroupBarrier() would also wait
// for global memory and images, which teams do not share.
//
// SUBGROUP_BARRIER 0 is for llvmpipe, where a subgroup is one vector that runs in program order, so that its lanes
// never wait for each other. There, a control barrier with subgroup scope acts as one with workgroup scope (Mesa
// 25.0.7): the subgroups wait for each other, and when one of them ends, the others stop at their next barrier.
// Teams reach different numbers of barriers, since their lists differ in length.
void teamBarrier() {
#if SUBGROUP_BARRIER
  controlBarrier(gl_ScopeSubgroup, gl_ScopeSubgroup, gl_StorageSemanticsShared,
                 gl_SemanticsAcquireRelease);
#else
  memoryBarrier(gl_ScopeSubgroup, gl_StorageSemanticsShared, gl_SemanticsAcquireRelease);
#endif
}

// The value is the same for all lanes. This tells the compiler.
HalfBlock uniformly(HalfBlock block) {
  return HalfBlock(subgroupBroadcastFirst(block.number), subgroupBroadcastFirst(block.first),
                   subgroupBroadcastFirst(block.count));
}

#endif
