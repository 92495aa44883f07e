// Additions of many lanes to counters, gathered: neighbouring quads mostly lie in the same bins, and
// additions to one address wait for each other.
#ifndef OITLAB_RASTER_TOGETHER_GLSL
#define OITLAB_RASTER_TOGETHER_GLSL

#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require

// Groups of lanes that are looked for; the rest add one by one. More do not pay where the order of
// submission is random, and small subgroups (CPUs) have little to gather.
#define TOGETHER_TURNS (gl_SubgroupSize >= 32u ? 4u : 0u)

struct Together {
  uint leader;  // lane that adds for all of them
  uint rank;    // among them
  uint count;   // what the lane has to add: nothing unless it leads
};

// Lanes that are `valid` and name the same counter. All lanes of the subgroup take part.
Together gather(uint counter, bool valid) {
  Together t = Together(gl_SubgroupInvocationID, 0u, uint(valid));
  bool pending = valid;
  for (uint turn = 0u; turn < TOGETHER_TURNS && subgroupAny(pending); ++turn) {
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
