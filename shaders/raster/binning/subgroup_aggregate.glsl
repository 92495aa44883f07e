// Combines the additions of a subgroup's lanes to the same counter into one atomic. Neighboring quads are mostly in
// the same bins, and atomics on one address wait for each other.
#ifndef OITLAB_RASTER_SUBGROUP_AGGREGATE_GLSL
#define OITLAB_RASTER_SUBGROUP_AGGREGATE_GLSL

#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require

// Number of groups of lanes that are combined; other lanes add one by one. More groups do not pay if the order of
// submission is random, and small subgroups (CPUs) have little to combine.
#define AGGREGATE_ITERATIONS (gl_SubgroupSize >= 32u ? 4u : 0u)

struct Aggregate {
  uint leader;  // lane that adds for the whole group
  uint rank;    // index in the group
  uint count;   // what the lane adds: the size of the group for the leader, 0 for others
};

// Groups the lanes that are `valid` and have the same counter. All lanes of the subgroup must call this.
Aggregate aggregate(uint counter, bool valid) {
  Aggregate t = Aggregate(gl_SubgroupInvocationID, 0u, uint(valid));
  bool pending = valid;
  for (uint iteration = 0u; iteration < AGGREGATE_ITERATIONS && subgroupAny(pending); ++iteration) {
    const uint first = subgroupBallotFindLSB(subgroupBallot(pending));
    const bool same = pending && counter == subgroupShuffle(counter, first);
    const uvec4 lanes = subgroupBallot(same);
    if (same) {
      t.leader = first;
      t.rank = subgroupBallotExclusiveBitCount(lanes);
      t.count = t.rank == 0u ? subgroupBallotBitCount(lanes) : 0u;
      pending = false;
    }
  }
  return t;
}

#endif
