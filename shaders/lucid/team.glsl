// A team is a subgroup that works on a half-block.
#ifndef OITLAB_LUCID_TEAM_GLSL
#define OITLAB_LUCID_TEAM_GLSL

#include "lucid/lucid_types.h"

#extension GL_KHR_memory_scope_semantics : require

// Lanes that part come together again where the control flow joins: Vulkan promises it only with this.
#if UNIFORM_CONTROL_FLOW
#extension GL_EXT_subgroup_uniform_control_flow : require
#define TEAM_MAIN [[subgroup_uniform_control_flow]]
#else
#define TEAM_MAIN
#endif

// What the team's lanes wrote to shared memory is there for the others. subgroupBarrier() would wait
// for global memory and images too, which teams do not share.
void teamBarrier() {
  controlBarrier(gl_ScopeSubgroup, gl_ScopeSubgroup, gl_StorageSemanticsShared,
                 gl_SemanticsAcquireRelease);
}

// The same for all lanes, which compilers cannot tell.
HalfBlock uniformly(HalfBlock block) {
  return HalfBlock(subgroupBroadcastFirst(block.number), subgroupBroadcastFirst(block.first),
                   subgroupBroadcastFirst(block.count));
}

#endif
